// SPDX-License-Identifier: MIT
#pragma once

#include "skeleton/SkeletonTree.h"

#include <string>
#include <vector>

namespace osgSkin {

/// Which joints belong to the trunk (hips, spine, collar bones, neck, head and what hangs on it)
/// and which to a limb, told by the tree's shape first and by names second.
struct BodyParts {
    std::vector<bool> isLimb; ///< [joint]

    /// Leg joints near the floor in the rest pose: ankles, toe bases. Empty for a body without
    /// legs.
    std::vector<int> feet;

    /// Those of `feet` that begin one: ankles, whose parents are not among `feet`.
    std::vector<int> ankles;

    /// Height (y) of the lowest joint or tip of the legs at rest; of all where there are none.
    double lowest = 0.0;
};

BodyParts findBodyParts(const SkeletonTree& tree);

/// Whether `name` contains `part`, letters' case ignored; `part` in lower case.
bool nameContains(const std::string& name, const char* part);

} // namespace osgSkin
