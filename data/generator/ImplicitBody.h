// SPDX-License-Identifier: MIT
#pragma once

#include "Sculpture.h"

#include <glm/vec3.hpp>

namespace mannequin {

/// The body as a smooth implicit surface: approximate signed distance to the skin in metres,
/// negative inside. Symmetric in x.
class ImplicitBody {
public:
    ImplicitBody();

    double distance(const glm::dvec3& point) const;

    glm::dvec3 gradient(const glm::dvec3& point) const;

    /// Unit gradient, pointing out of the body.
    glm::dvec3 normal(const glm::dvec3& point) const;

    /// A nearby point on the skin.
    glm::dvec3 projected(glm::dvec3 point) const;

    glm::dvec3 lowerCorner() const;
    glm::dvec3 upperCorner() const;

private:
    Sculpture _trunk, _head, _arm, _leg;
};

} // namespace mannequin
