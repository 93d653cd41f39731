// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/HeatGraph.h"

#include "mesh/EdgeWeights.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <numeric>

namespace osgSkin {
namespace {

std::vector<double> lumpedMass(const WeldedMesh& mesh) {
    std::vector<double> mass(mesh.vertexCount(), 0.0);
    for (const auto& t : mesh.triangles) {
        const glm::dvec3& a = mesh.positions[t[0]];
        const double area =
            0.5 * glm::length(glm::cross(mesh.positions[t[1]] - a, mesh.positions[t[2]] - a));
        for (const std::uint32_t v : t) mass[v] += area / 3.0;
    }
    // A vertex of zero-area triangles only still needs some mass, as one without any triangle does.
    const double total = std::accumulate(mass.begin(), mass.end(), 0.0);
    const double lowest = total > 0.0 ? 1e-6 * total / static_cast<double>(mass.size()) : 1.0;
    for (double& m : mass) m = std::max(m, lowest);
    return mass;
}

} // namespace

HeatGraph::HeatGraph(const WeldedMesh& mesh)
    : positions(mesh.positions), triangles(mesh.triangles), mass(lumpedMass(mesh)),
      firstNeighbour(mesh.firstNeighbour), neighbours(mesh.neighbours), weights(edgeWeights(mesh)) {
    measureEdges();
}

double HeatGraph::edgeLength(std::uint32_t from, std::uint32_t to) const {
    return glm::distance(positions[from], positions[to]);
}

void HeatGraph::measureEdges() {
    double sum = 0.0;
    for (std::uint32_t v = 0; v < vertexCount(); ++v)
        for (std::uint32_t i = firstNeighbour[v]; i < firstNeighbour[v + 1]; ++i)
            sum += edgeLength(v, neighbours[i]);
    meanEdge = neighbours.empty() ? 0.0 : sum / static_cast<double>(neighbours.size());
}

} // namespace osgSkin
