// SPDX-License-Identifier: MIT
#pragma once

#include "Blending.h"

#include <glm/gtc/constants.hpp>
#include <glm/gtc/quaternion.hpp>

#include <cmath>
#include <cstdint>
#include <vector>

namespace test {

/// A rotation about `axis` (any length), then a translation.
inline glm::dmat4 turnAndShift(double radians, const glm::dvec3& axis, const glm::dvec3& shift) {
    glm::dmat4 result = glm::mat4_cast(glm::angleAxis(radians, glm::normalize(axis)));
    result[3] = glm::dvec4(shift, 1.0);
    return result;
}

/// A limb's cross-section, a unit circle about z; one half follows each of two joints.
struct HalfTurned {
    std::vector<glm::dvec3> rest;
    std::vector<std::uint32_t> loop;
    compare::SkinWeights weights;

    HalfTurned() {
        for (std::uint32_t i = 0; i < 24; ++i) {
            const double angle = glm::two_pi<double>() * i / 24;
            rest.emplace_back(std::cos(angle), std::sin(angle), 0.0);
            loop.push_back(i);
            weights.add({{0, 0.5}, {1, 0.5}});
        }
    }

    /// The first joint at rest, the second one rotated about the circle's centre.
    std::vector<glm::dmat4> turned(double degrees, const glm::dvec3& axis) const {
        return {glm::dmat4(1.0), turnAndShift(glm::radians(degrees), axis, glm::dvec3(0.0))};
    }
};

} // namespace test
