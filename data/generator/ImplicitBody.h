// SPDX-License-Identifier: MIT
#pragma once

#include "Sculpture.h"

#include <glm/vec3.hpp>

namespace mannequin {

/// The whole body as a smooth field: negative inside, about the distance to the skin in metres.
/// Symmetric in x.
class ImplicitBody {
public:
    ImplicitBody();

    double distance(const glm::dvec3& point) const;

    glm::dvec3 gradient(const glm::dvec3& point) const;

    /// Unit gradient, which points out of the body.
    glm::dvec3 normal(const glm::dvec3& point) const;

    /// Nearby point of the skin.
    glm::dvec3 projected(glm::dvec3 point) const;

    glm::dvec3 lowerCorner() const;
    glm::dvec3 upperCorner() const;

private:
    Sculpture _trunk, _head, _arm, _leg;
};

} // namespace mannequin
