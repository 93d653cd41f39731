// SPDX-License-Identifier: MIT
#pragma once

#include "skeleton/SkeletonTree.h"

#include <osgSkinRig/JointRoles>

#include <vector>

namespace osgSkin {

/// Classifies joints as trunk (hips, spine, collar bones, neck, head and its descendants) or limb,
/// by their roles and by the tree's shape. Where legs are recognised, other joints near the floor
/// (capes, tails, swords, targets) do not count for `feet` and `lowest`.
struct BodyParts {
    std::vector<bool> isLimb; ///< [joint]

    /// Leg joints near the floor in the rest pose: ankles, toe bases. Empty for a body without
    /// legs.
    std::vector<int> feet;

    /// The first joint of each foot: its parent is not among `feet`.
    std::vector<int> ankles;

    /// Height (y) of the lowest joint or tip of the legs at rest; of all joints where there are no
    /// legs.
    double lowest = 0.0;

    /// Whether heights above the floor are known: false where names are recognised and none is a
    /// leg.
    bool stands = true;
};

/// Finds them.
/// \param tree at rest, +y up
/// \param roles of its joints
BodyParts findBodyParts(const SkeletonTree& tree, const JointRoles& roles);

} // namespace osgSkin
