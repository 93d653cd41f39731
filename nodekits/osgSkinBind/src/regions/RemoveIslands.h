// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_REGIONS_REMOVEISLANDS_H
#define OSGSKINBIND_REGIONS_REMOVEISLANDS_H

#include "mesh/WeldedMesh.h"

#include <cstdint>
#include <limits>
#include <vector>

namespace osgSkin {

/// Joins each region's islands to the regions around them: of a region's connected patches on one
/// shell the one with most seeds (then most vertices) stays.
///
/// \param share an island with at least this share of its shell's vertices stays, too
void removeIslands(const WeldedMesh& mesh, const std::vector<bool>& isSeed,
                   std::vector<std::uint32_t>& jointOf,
                   double share = std::numeric_limits<double>::infinity());

} // namespace osgSkin

#endif
