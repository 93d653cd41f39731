// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBINDER_MESH_HEATGRAPH_H
#define OSGSKINBINDER_MESH_HEATGRAPH_H

#include "mesh/WeldedMesh.h"

#include <cstdint>
#include <vector>

namespace osgSkin {

/// The cotangent weight of each edge: one for each entry of `mesh.neighbours`, so two per edge.
///
/// Weights are positive, and clamped where obtuse or degenerate triangles would make them negative
/// or huge. So values that are smoothed with them stay in their range.
std::vector<double> edgeWeights(const WeldedMesh& mesh);
/// The same for other triangle meshes, with neighbours as in WeldedMesh.
std::vector<double> edgeWeights(const std::vector<glm::dvec3>& positions,
                                const std::vector<std::array<std::uint32_t, 3>>& triangles,
                                const std::vector<std::uint32_t>& firstNeighbour,
                                const std::vector<std::uint32_t>& neighbours);

/// A penalty for crossing an edge: 1 where the skin is flat or convex, much more where it is
/// concave. Parts of a body meet in creases (Hoffman & Richards 1984): jaw, armpit, groin.
double creaseFactor(const WeldedMesh& mesh, std::uint32_t from, std::uint32_t to);

/// The skin for heat diffusion: vertices with a mass, and edges with a conductivity.
struct HeatGraph {
    std::vector<glm::dvec3> positions;
    std::vector<std::array<std::uint32_t, 3>> triangles;
    std::vector<double> mass;                  ///< area around each vertex, above 0
    std::vector<std::uint32_t> firstNeighbour; ///< size: vertices + 1; offsets into `neighbours`
    std::vector<std::uint32_t> neighbours;
    std::vector<double> weights; ///< cotangent weight for each of `neighbours`, above 0
    double meanEdge = 0.0;       ///< mean length of the edges

    HeatGraph() = default;
    explicit HeatGraph(const WeldedMesh& mesh);
    /// \param points become `positions`
    /// \param faces become `triangles`
    HeatGraph(std::vector<glm::dvec3> points, std::vector<std::array<std::uint32_t, 3>> faces);

    std::size_t vertexCount() const { return positions.size(); }
    IndexRange neighboursOf(std::uint32_t v) const {
        return {neighbours.data() + firstNeighbour[v], neighbours.data() + firstNeighbour[v + 1]};
    }
    double edgeLength(std::uint32_t from, std::uint32_t to) const;
    void measureEdges(); ///< sets `meanEdge`
};

} // namespace osgSkin

#endif
