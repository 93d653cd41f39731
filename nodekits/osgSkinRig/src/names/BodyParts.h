// SPDX-License-Identifier: MIT
#pragma once

#include "skeleton/SkeletonTree.h"

#include <osgSkinRig/JointRoles>

#include <vector>

namespace osgSkin {

/// Which joints belong to the trunk (hips, spine, collar bones, neck, head and what hangs on it)
/// and which to a limb, told by what the joints are recognised as and by the tree's shape. Where
/// legs are recognised, nothing else is one: what hangs down as far (capes, tails, swords,
/// targets on the floor) has no part in `feet` and `lowest`.
struct BodyParts {
    std::vector<bool> isLimb; ///< [joint]

    /// Leg joints near the floor in the rest pose: ankles, toe bases. Empty for a body without
    /// legs.
    std::vector<int> feet;

    /// Those of `feet` that begin one: ankles, whose parents are not among `feet`.
    std::vector<int> ankles;

    /// Height (y) of the lowest joint or tip of the legs at rest; of all where there are none.
    double lowest = 0.0;

    /// Whether a height above the floor can be told: not where the names are known and name no leg.
    bool stands = true;
};

/// Finds them.
/// \param tree at rest, +y up
/// \param roles of its joints
BodyParts findBodyParts(const SkeletonTree& tree, const JointRoles& roles);

} // namespace osgSkin
