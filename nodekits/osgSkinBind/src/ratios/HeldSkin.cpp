// SPDX-License-Identifier: GPL-3.0-or-later
#include "ratios/HeldSkin.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>

namespace osgSkin {
namespace {

/// Vertices of edges that have a triangle on one side only.
std::vector<bool> bordersOf(const HeatGraph& skin) {
    std::vector<std::pair<std::uint32_t, std::uint32_t>> edges;
    edges.reserve(3 * skin.triangles.size());
    for (const auto& triangle : skin.triangles)
        for (std::size_t c = 0; c < 3; ++c)
            edges.push_back(std::minmax({triangle[c], triangle[(c + 1) % 3]}));
    std::sort(edges.begin(), edges.end());
    std::vector<bool> isBorder(skin.vertexCount());
    for (auto edge = edges.begin(); edge != edges.end();) {
        const auto next =
            std::find_if(edge, edges.end(), [&](const auto& e) { return e != *edge; });
        if (next - edge == 1) isBorder[edge->first] = isBorder[edge->second] = true;
        edge = next;
    }
    return isBorder;
}

} // namespace

void keepLooseSkin(const HeatGraph& skin, const std::vector<double>& field,
                   std::vector<bool>& isFree) {
    const std::vector<bool> isBorder = bordersOf(skin);
    std::vector<bool> isSeen(isFree.size());
    std::vector<std::uint32_t> part;
    for (std::uint32_t first = 0; first < isFree.size(); ++first) {
        if (!isFree[first] || isSeen[first]) continue;
        bool low = false, high = false, ends = false;
        part.assign(1, first);
        isSeen[first] = true;
        for (std::size_t i = 0; i < part.size(); ++i) {
            const std::uint32_t v = part[i];
            ends = ends || isBorder[v];
            for (std::uint32_t n = skin.firstNeighbour[v]; n < skin.firstNeighbour[v + 1]; ++n) {
                const std::uint32_t next = skin.neighbours[n];
                if (!isFree[next]) {
                    (field[next] < 0.5 ? low : high) = true;
                } else if (!isSeen[next]) {
                    isSeen[next] = true;
                    part.push_back(next);
                }
            }
        }
        if (low && high && !ends) continue;
        for (const std::uint32_t v : part) isFree[v] = false;
    }
}

} // namespace osgSkin
