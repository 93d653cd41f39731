// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBINDER_REGIONS_SPREADREGIONS_H
#define OSGSKINBINDER_REGIONS_SPREADREGIONS_H

#include "mesh/WeldedMesh.h"

#include <cstdint>
#include <vector>

namespace osgSkin {

/// The flooding step. The paper's version gives an unlabelled vertex the joint of a labelled
/// neighbour until none is left, so regions depend on how coarse the mesh is. Here a vertex goes to
/// the joint whose seeds a random walk over the skin, which avoids creases, most likely reaches
/// first (Grady 2006). Vertices of a shell without any label stay kNone.
void floodRegions(const WeldedMesh& mesh, std::vector<std::uint32_t>& jointOf);

/// Labels each kNone vertex like the labelled vertex that is nearest along the edges of the mesh.
/// Vertices are only added to a region that they are connected to.
void spreadRegions(const WeldedMesh& mesh, std::vector<std::uint32_t>& jointOf);

/// Joins each region's islands to the regions around them. Of a region's connected patches on one
/// shell, the one with the most seeds stays (then the most vertices, then by position). On a shell
/// without seeds larger ones stay as well: the two sides of a cloth may be separate patches.
void removeIslands(const WeldedMesh& mesh, const std::vector<bool>& isSeed,
                   std::vector<std::uint32_t>& jointOf);

} // namespace osgSkin

#endif
