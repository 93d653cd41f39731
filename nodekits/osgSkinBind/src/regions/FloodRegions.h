// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_REGIONS_FLOODREGIONS_H
#define OSGSKINBIND_REGIONS_FLOODREGIONS_H

#include "mesh/WeldedMesh.h"

#include <cstdint>
#include <vector>

namespace osgSkin {

/// The flooding step. The printed one gives an unlabelled vertex the joint of a labelled neighbour
/// until none is left, so that a region grows as far as the mesh happens to be coarse. Here a
/// vertex goes to the joint whose seeds a random walk over the skin, shy of creases, most likely
/// meets first (Grady 2006). Vertices of a shell without any label stay kNone.
void floodRegions(const WeldedMesh& mesh, std::vector<std::uint32_t>& jointOf);

} // namespace osgSkin

#endif
