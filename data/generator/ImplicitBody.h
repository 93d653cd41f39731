// SPDX-License-Identifier: MIT
#pragma once

#include "Sculpture.h"

#include <glm/vec3.hpp>

namespace mannequin {

/// A body as a smooth implicit surface.
class ImplicitBody {
public:
    virtual ~ImplicitBody() = default;

    /// Approximate signed distance to the skin in metres, negative inside.
    virtual double distance(const glm::dvec3& point) const = 0;

    glm::dvec3 gradient(const glm::dvec3& point) const;

    /// Unit gradient, pointing out of the body.
    glm::dvec3 normal(const glm::dvec3& point) const;

    /// A nearby point on the skin.
    glm::dvec3 projected(glm::dvec3 point) const;

    virtual glm::dvec3 lowerCorner() const = 0;
    virtual glm::dvec3 upperCorner() const = 0;
};

/// Distance to a part, or to its bounds if those are far away: there the field is only used to
/// skip empty space.
double distanceWithin(const Sculpture& part, const glm::dvec3& point, const RoundCone& bounds);

} // namespace mannequin
