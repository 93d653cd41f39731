// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_ELASTIC_UNSOLVABLE_H
#define OSGSKINBIND_ELASTIC_UNSOLVABLE_H

#include <stdexcept>

namespace osgSkin::elastic {

/// A joint whose surroundings make no elastic solid; what() says why. Ends in
/// ElasticShapes::reason, so it never leaves solveElasticJoint().
struct Unsolvable : std::runtime_error {
    using std::runtime_error::runtime_error;
};

} // namespace osgSkin::elastic

#endif
