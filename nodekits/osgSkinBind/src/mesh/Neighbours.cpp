// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/Neighbours.h"

namespace osgSkin {

void listNeighbours(std::size_t vertices, const std::vector<DirectedEdge>& edges,
                    std::vector<std::uint32_t>& firstNeighbour,
                    std::vector<std::uint32_t>& neighbours) {
    firstNeighbour.assign(vertices + 1, 0);
    neighbours.clear();
    for (std::size_t i = 0; i < edges.size(); ++i) {
        if (i > 0 && edges[i] == edges[i - 1]) continue;
        ++firstNeighbour[edges[i].first + 1];
        neighbours.push_back(edges[i].second);
    }
    for (std::size_t v = 0; v < vertices; ++v) firstNeighbour[v + 1] += firstNeighbour[v];
}

} // namespace osgSkin
