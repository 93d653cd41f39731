// SPDX-License-Identifier: MIT
// Two-bone IK: how an arm or a leg bends.
#pragma once

#include <osgSkin/GlmTypes>

#include <algorithm>
#include <cmath>

namespace osgSkin {

/// A vector of length 1; 0 stays.
inline glm::dvec3 unitOrZero(const glm::dvec3& v) {
    const double length = glm::length(v);
    return length > 0.0 ? v / length : glm::dvec3(0.0);
}

/// Where the middle joint of a limb is, by the law of cosines: along the line from the first joint
/// to the end, and beside it.
struct LimbBend {
    double along, beside;
};

/// \param upper length of the first bone
/// \param lower length of the second bone
/// \param distance from the first joint to the end, which the bones reach
inline LimbBend bendOf(double upper, double lower, double distance) {
    if (!(distance > 0.0)) return {0.0, upper};
    const double along = (upper * upper + distance * distance - lower * lower) / (2.0 * distance);
    return {along, std::sqrt(std::max(0.0, upper * upper - along * along))};
}

/// See LimbRotations.
struct LimbTurns {
    glm::dquat lower{1.0, 0.0, 0.0, 0.0}, upper{1.0, 0.0, 0.0, 0.0};
    bool reaches = false;
};

/// The parameters and the result of reachRotations().
LimbTurns reachTurns(const glm::dvec3& first, const glm::dvec3& middle, const glm::dvec3& end,
                     const glm::dvec3& target, const glm::dvec3& pole = glm::dvec3(0.0));

} // namespace osgSkin
