// SPDX-License-Identifier: MIT
#pragma once

#include <glm/vec3.hpp>

namespace mannequin {

/// Target edge length of the skin: short on face, hands, toes and joints, long elsewhere.
class DetailMap {
public:
    /// Edge length in metres, before it is scaled to reach the number of vertices.
    double edgeLength(const glm::dvec3& point) const;
};

} // namespace mannequin
