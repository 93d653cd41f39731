// SPDX-License-Identifier: GPL-3.0-or-later
#include "regions/SpreadRegions.h"

#include "mesh/EdgeWeights.h"
#include "regions/RegionLabels.h"

#include <glm/geometric.hpp>

#include <functional>
#include <limits>
#include <queue>
#include <tuple>

namespace osgSkin {

void spreadRegions(const WeldedMesh& mesh, std::vector<std::uint32_t>& jointOf) {
    // Dijkstra's shortest paths from all labelled vertices at once.
    using Step = std::tuple<double, std::uint32_t, std::uint32_t>; // length, vertex, joint
    std::priority_queue<Step, std::vector<Step>, std::greater<>> front;
    std::vector<double> length(mesh.vertexCount(), std::numeric_limits<double>::infinity());
    for (std::uint32_t v = 0; v < mesh.vertexCount(); ++v)
        if (jointOf[v] != Regions::kNone) {
            length[v] = 0.0;
            front.emplace(0.0, v, jointOf[v]);
        }
    std::vector<bool> settled(mesh.vertexCount(), false);
    while (!front.empty()) {
        const auto [reached, v, joint] = front.top();
        front.pop();
        if (settled[v]) continue;
        settled[v] = true;
        jointOf[v] = joint;
        for (std::uint32_t i = mesh.firstNeighbour[v]; i < mesh.firstNeighbour[v + 1]; ++i) {
            const std::uint32_t next = mesh.neighbours[i];
            const double there = reached + glm::distance(mesh.positions[v], mesh.positions[next]) *
                                               creaseFactor(mesh, v, next);
            if (there < length[next]) {
                length[next] = there;
                front.emplace(there, next, joint);
            }
        }
    }
}

} // namespace osgSkin
