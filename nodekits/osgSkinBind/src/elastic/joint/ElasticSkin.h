// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_ELASTIC_ELASTICSKIN_H
#define OSGSKINBIND_ELASTIC_ELASTICSKIN_H

#include <glm/vec3.hpp>

#include <array>
#include <cstdint>
#include <vector>

namespace osgSkin {

/// A skin as solveElasticJoint() reads it: welded, so that triangles that touch share vertices.
/// Rest space. May be open and of several shells. Owns nothing.
struct ElasticSkin {
    const std::vector<glm::dvec3>& positions;
    const std::vector<std::array<std::uint32_t, 3>>& triangles;
};

} // namespace osgSkin

#endif
