// SPDX-License-Identifier: GPL-3.0-or-later
#include "layers/ShellOrder.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <numeric>
#include <utility>

namespace osgSkin {

std::vector<std::uint32_t> orderedShells(const WeldedMesh& mesh, const Regions& regions) {
    std::vector<std::pair<double, double>> rank(mesh.shells); // area that is seen, area
    for (const auto& t : mesh.triangles) {
        const glm::dvec3& a = mesh.positions[t[0]];
        const double twice =
            glm::length(glm::cross(mesh.positions[t[1]] - a, mesh.positions[t[2]] - a));
        auto& [seen, area] = rank[mesh.shellOf[t[0]]];
        area += twice;
        for (const std::uint32_t v : t)
            if (regions.seedOf[v] != Regions::kNone) seen += twice;
    }
    std::vector<std::uint32_t> order(mesh.shells);
    std::iota(order.begin(), order.end(), 0u);
    std::stable_sort(order.begin(), order.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return rank[a] > rank[b]; });
    return order;
}

} // namespace osgSkin
