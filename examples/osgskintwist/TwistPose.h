// SPDX-License-Identifier: MIT
#pragma once

#include <glm/gtc/quaternion.hpp>
#include <glm/trigonometric.hpp>
#include <glm/vec3.hpp>

namespace twist {

/// How the upper half of the cylinder is turned against the lower one; degrees.
struct TwistPose {
    double bend = 0.0;  ///< about y: the upper half leans towards +x
    double twist = 0.0; ///< about the bone

    /// Twist first, then bend: eq. 1 of the paper.
    glm::dquat rotation() const {
        return glm::angleAxis(glm::radians(bend), glm::dvec3(0, 1, 0)) *
               glm::angleAxis(glm::radians(twist), glm::dvec3(0, 0, 1));
    }
};

} // namespace twist
