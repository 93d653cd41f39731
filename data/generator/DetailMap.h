// SPDX-License-Identifier: MIT
#pragma once

#include <glm/vec3.hpp>

namespace mannequin {

/// Wanted length of the skin's edges: short at face, hands, toes and joints, long on plain flesh.
class DetailMap {
public:
    /// Edge length in metres, before any scaling to a number of vertices.
    double edgeLength(const glm::dvec3& point) const;
};

} // namespace mannequin
