// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_REGIONS_REMOVEISLANDS_H
#define OSGSKINBIND_REGIONS_REMOVEISLANDS_H

#include "mesh/WeldedMesh.h"

#include <cstdint>
#include <vector>

namespace osgSkin {

/// Joins each region's islands to the regions around them: of a region's connected patches on one
/// shell the one with most seeds (then most vertices, then by its place) stays. On a shell without
/// seeds larger ones stay, too: the inside and the outside of a cloth are islands to each other.
void removeIslands(const WeldedMesh& mesh, const std::vector<bool>& isSeed,
                   std::vector<std::uint32_t>& jointOf);

} // namespace osgSkin

#endif
