// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_RATIOFIELDS_H
#define OSGSKINBIND_RATIOFIELDS_H

#include <vector>

namespace osgSkin {

/// For each joint a value at each welded vertex.
using JointFields = std::vector<std::vector<double>>;

} // namespace osgSkin

#endif
