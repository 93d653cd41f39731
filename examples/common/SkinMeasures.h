// SPDX-License-Identifier: MIT
#pragma once

#include <glm/vec3.hpp>

#include <array>
#include <cstdint>
#include <vector>

namespace compare {

using Points = std::vector<glm::dvec3>;

/// Volume inside a closed, outward-facing mesh; folds count against it.
/// \param triangles three vertex indices each
double enclosedVolume(const Points& points, const std::vector<std::uint32_t>& triangles);

/// Area of the surface that a closed loop of vertices spans: the length of its vector area, which
/// for a plane loop is the area itself.
double loopArea(const Points& points, const std::vector<std::uint32_t>& loop);

using Edge = std::array<std::uint32_t, 2>;

/// Each edge of the faces once, as (lower index, higher index), sorted.
/// \param sizes of the faces, as osgSkin::SkinMesh keeps them
/// \param vertices of the faces, one face after the other
std::vector<Edge> faceEdges(const std::vector<std::uint32_t>& sizes,
                            const std::vector<std::uint32_t>& vertices);

/// How edges change length, l'/l - 1, over all edges that have a length at rest.
struct EdgeStrain {
    double rms = 0.0;
    double percentile999 = 0.0; ///< of l'/l
    double largest = 0.0;       ///< of l'/l
};
EdgeStrain edgeStrain(const Points& rest, const Points& posed, const std::vector<Edge>& edges);

/// A bone from one end to the other.
struct Segment {
    glm::dvec3 from, to;
};

/// Largest distance to the nearest posed bone over that to the nearest rest bone, over `vertices`.
double bulge(const Points& rest, const Points& posed, const std::vector<std::uint32_t>& vertices,
             const std::vector<Segment>& restBones, const std::vector<Segment>& posedBones);

} // namespace compare
