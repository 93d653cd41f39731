// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_DELAUNAYLINKS_H
#define OSGSKINBIND_DELAUNAYLINKS_H

#include <glm/vec3.hpp>

#include <cstdint>
#include <vector>

namespace osgSkin {

/// An edge of the Delaunay triangulation between a vertex of the skin and a sample of the skeleton.
struct DelaunayLink {
    std::uint32_t vertex = 0;
    std::uint32_t sample = 0;
};

/// Triangulates vertices and samples of the skeleton together (paper, section 1, Delaunay step) and
/// returns the edges that join one of each kind, sorted by sample, then vertex.
///
/// Empty where the points do not span space (all in one plane). A sample that lies exactly on a
/// vertex is linked to it and to that vertex's neighbours.
std::vector<DelaunayLink> delaunayLinks(const std::vector<glm::dvec3>& vertices,
                                        const std::vector<glm::dvec3>& samples);

} // namespace osgSkin

#endif
