// SPDX-License-Identifier: GPL-3.0-or-later
#include "Regions.h"

#include <glm/geometric.hpp>

#include <functional>
#include <limits>
#include <queue>
#include <tuple>

namespace osgSkin {

void floodRegions(const WeldedMesh& mesh, std::vector<std::uint32_t>& jointOf) {
    // Dijkstra's shortest paths from all labelled vertices at once. Breadth-first, as printed,
    // walks further where the mesh is coarse; distance along the edges does not depend on the
    // sampling.
    using Step = std::tuple<double, std::uint32_t, std::uint32_t>; // distance, vertex, joint
    std::priority_queue<Step, std::vector<Step>, std::greater<>> front;
    std::vector<double> distance(mesh.vertexCount(), std::numeric_limits<double>::infinity());
    for (std::uint32_t v = 0; v < mesh.vertexCount(); ++v)
        if (jointOf[v] != Regions::kNone) {
            distance[v] = 0.0;
            front.emplace(0.0, v, jointOf[v]);
        }
    while (!front.empty()) {
        const auto [reached, v, joint] = front.top();
        front.pop();
        if (reached > distance[v] || (reached > 0.0 && jointOf[v] != Regions::kNone)) continue;
        jointOf[v] = joint;
        for (std::uint32_t i = mesh.firstNeighbour[v]; i < mesh.firstNeighbour[v + 1]; ++i) {
            const std::uint32_t next = mesh.neighbours[i];
            const double there = reached + glm::distance(mesh.positions[v], mesh.positions[next]);
            if (there < distance[next]) {
                distance[next] = there;
                front.emplace(there, next, joint);
            }
        }
    }
}

} // namespace osgSkin
