// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapes/ShapeReach.h"

#include "regions/HermiteRatio.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace osgSkin {
namespace {

/// Sine of the lean towards the trunk from which on skin is the pit's.
constexpr double kLean = 0.5;

} // namespace

double ShapeReach::shareAt(double radii) const {
    return 1.0 - hermiteRatio((radii - whole) / (end - whole));
}

ShapeReach reachTowards(const glm::dvec3& direction, const ShapeReach& reach, const ShapePit& pit) {
    const double length = glm::length(direction);
    if (!(length > 0.0)) return reach;
    const double lean = -glm::dot(direction, pit.away) / length;
    const double share = hermiteRatio(lean / kLean);
    return {glm::mix(reach.whole, pit.reach.whole, share),
            glm::mix(reach.end, pit.reach.end, share)};
}

} // namespace osgSkin
