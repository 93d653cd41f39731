// SPDX-License-Identifier: GPL-3.0-or-later
#include "Regions.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <functional>
#include <limits>
#include <queue>
#include <tuple>

namespace osgSkin {
namespace {

/// How much longer a fully concave edge counts. Parts of a body meet in creases (Hoffman & Richards
/// 1984), so a region should rather end in one - jaw, armpit, groin - than run across it.
constexpr double kCreaseCost = 10.0;

double stepLength(const WeldedMesh& mesh, std::uint32_t from, std::uint32_t to) {
    const glm::dvec3 edge = mesh.positions[to] - mesh.positions[from];
    const double length = glm::length(edge);
    if (!(length > 0.0)) return 0.0;
    // Normals that lean towards each other: 0 where flat or convex, up to 2.
    const double concavity =
        std::max(0.0, glm::dot(mesh.normals[from] - mesh.normals[to], edge) / length);
    return length * (1.0 + kCreaseCost * concavity);
}

} // namespace

void floodRegions(const WeldedMesh& mesh, std::vector<std::uint32_t>& jointOf) {
    // Dijkstra's shortest paths from all labelled vertices at once. Breadth-first, as printed,
    // walks further where the mesh is coarse; length along the edges does not depend on the
    // sampling.
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
            const double there = reached + stepLength(mesh, v, next);
            if (there < length[next]) {
                length[next] = there;
                front.emplace(there, next, joint);
            }
        }
    }
}

} // namespace osgSkin
