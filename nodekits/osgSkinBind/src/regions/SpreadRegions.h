// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_REGIONS_SPREADREGIONS_H
#define OSGSKINBIND_REGIONS_SPREADREGIONS_H

#include "mesh/WeldedMesh.h"

#include <cstdint>
#include <vector>

namespace osgSkin {

/// Labels each kNone vertex like the labelled vertex that is nearest along the edges of the mesh,
/// so that what it adds to a region is connected to it.
void spreadRegions(const WeldedMesh& mesh, std::vector<std::uint32_t>& jointOf);

} // namespace osgSkin

#endif
