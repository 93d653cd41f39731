// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_SHELLORDER_H
#define OSGSKINBIND_SHELLORDER_H

#include "mesh/WeldedMesh.h"
#include "regions/RegionLabels.h"

#include <cstdint>
#include <vector>

namespace osgSkin {

/// The shells from the bones outwards: by the area that the Delaunay step labelled from the joints,
/// then by area. A body comes before its clothes, also where the clothes are larger.
std::vector<std::uint32_t> orderedShells(const WeldedMesh& mesh, const Regions& regions);

} // namespace osgSkin

#endif
