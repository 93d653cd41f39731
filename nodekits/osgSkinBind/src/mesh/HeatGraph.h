// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_HEATGRAPH_H
#define OSGSKINBIND_HEATGRAPH_H

#include "mesh/WeldedMesh.h"

#include <cstdint>
#include <vector>

namespace osgSkin {

/// A skin as heat sees it: vertices that hold heat, and edges that conduct it.
struct HeatGraph {
    std::vector<glm::dvec3> positions;
    std::vector<std::array<std::uint32_t, 3>> triangles;
    std::vector<double> mass;                  ///< area around each vertex, above 0
    std::vector<std::uint32_t> firstNeighbour; ///< size: vertices + 1; offsets into `neighbours`
    std::vector<std::uint32_t> neighbours;
    std::vector<double> weights; ///< cotangent weight for each of `neighbours`, at least 0
    double meanEdge = 0.0;       ///< mean length of an edge

    HeatGraph() = default;
    explicit HeatGraph(const WeldedMesh& mesh);

    std::size_t vertexCount() const { return positions.size(); }
    double edgeLength(std::uint32_t from, std::uint32_t to) const;
    void measureEdges(); ///< sets `meanEdge`
};

} // namespace osgSkin

#endif
