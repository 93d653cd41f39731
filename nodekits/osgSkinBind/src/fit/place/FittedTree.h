// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_FIT_PLACE_FITTEDTREE_H
#define OSGSKINBIND_FIT_PLACE_FITTEDTREE_H

#include <cstddef>
#include <string>
#include <vector>

namespace osgSkin {

/// A joint of a fitted skeleton: its CMU name and its parent's index, -1 for the root.
struct FittedJoint {
    const char* name;
    int parent;
};

/// The joints of every fitted skeleton, parents before children.
const std::vector<FittedJoint>& fittedTree();

/// "Left" and "Right", as joint names begin; index 0 is the left side, x > 0.
const std::string& sidePrefix(std::size_t side);

/// The other side's joint; the name itself for a joint of the trunk.
std::string mirroredName(const std::string& name);

} // namespace osgSkin

#endif
