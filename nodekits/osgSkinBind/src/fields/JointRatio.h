// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_JOINTRATIO_H
#define OSGSKINBIND_JOINTRATIO_H

#include <cstdint>

namespace osgSkin {

/// How far a vertex follows a joint, 0 to 1.
struct JointRatio {
    std::uint32_t joint;
    double bend, twist;
};

} // namespace osgSkin

#endif
