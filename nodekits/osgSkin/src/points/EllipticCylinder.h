// SPDX-License-Identifier: MIT
#pragma once

#include <glm/vec3.hpp>

#include <vector>

namespace osgSkin {

/// A cylinder over an ellipse: centre + x axes[0] + y axes[1] + z axes[2] with x^2 + y^2 <= 1 and
/// |z| <= 1. The axes are perpendicular to each other.
struct EllipticCylinder {
    glm::vec3 centre{0.0f};
    glm::vec3 axes[3] = {glm::vec3(0.0f), glm::vec3(0.0f), glm::vec3(0.0f)};

    /// How far it reaches from its centre in a direction.
    float reach(const glm::vec3& direction) const;
    /// The radius of the ball about its centre that holds it.
    float radius() const;
};

/// One along the points' principal axes that holds them all, and is not much larger than the
/// smallest one.
///
/// \param points at least one
EllipticCylinder cylinderAround(const std::vector<glm::vec3>& points);

} // namespace osgSkin
