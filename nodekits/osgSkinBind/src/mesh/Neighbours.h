// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_NEIGHBOURS_H
#define OSGSKINBIND_NEIGHBOURS_H

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace osgSkin {

/// A directed edge: the vertex that it leaves and the one that it leads to.
using DirectedEdge = std::pair<std::uint32_t, std::uint32_t>;

/// Fills in each vertex's neighbours, one list after the other.
///
/// \param vertices their number
/// \param edges sorted, each edge in both directions; one that is listed several times counts once
/// \param firstNeighbour becomes offsets into `neighbours`: one for each vertex, and the end
/// \param neighbours becomes the edges' ends, sorted for each vertex
void listNeighbours(std::size_t vertices, const std::vector<DirectedEdge>& edges,
                    std::vector<std::uint32_t>& firstNeighbour,
                    std::vector<std::uint32_t>& neighbours);

} // namespace osgSkin

#endif
