// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_SHAPEREACH_H
#define OSGSKINBIND_SHAPEREACH_H

#include <glm/vec3.hpp>

namespace osgSkin {

/// How far from a joint skin is shaped, in radii of the limb.
struct ShapeReach {
    double whole; ///< up to there skin takes its whole target
    double end;   ///< from there on nothing of it

    /// What skin takes of its target, 1 to 0, falling smoothly.
    double shareAt(double radii) const;
};

/// The reach on the side of a limb where it rises from the trunk.
struct ShapePit {
    ShapeReach reach;
    glm::dvec3 away{0.0}; ///< unit, from the trunk, across the limb; 0 where there is no such side
};

/// The reach of a joint with a pit in one direction from its centre: from `reach` to the pit's
/// where a direction leans towards the trunk by 30 degrees from the plane across `away`.
ShapeReach reachTowards(const glm::dvec3& direction, const ShapeReach& reach, const ShapePit& pit);

} // namespace osgSkin

#endif
