// SPDX-License-Identifier: MIT
#pragma once

#include <osgSkinBind/Export>

#include <vector>

namespace osgSkin {

/// A joint of a fitted skeleton: its CMU name and its parent's index, -1 for the root.
struct FittedJoint {
    const char* name;
    int parent;
};

/// The joints of every fitted skeleton, parents before children.
OSGSKINBIND_EXPORT const std::vector<FittedJoint>& fittedTree();

} // namespace osgSkin
