// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_REGIONS_CLAIMREGIONS_H
#define OSGSKINBIND_REGIONS_CLAIMREGIONS_H

#include "joints/JointPlan.h"
#include "mesh/WeldedMesh.h"

#include <cstdint>
#include <vector>

namespace osgSkin {

/// Gives joints that claim a region the vertices nearer to them than to the neighbouring joint of
/// the chain whose label they have.
void claimRegions(const WeldedMesh& mesh, const std::vector<PlannedJoint>& joints,
                  std::vector<std::uint32_t>& jointOf);

} // namespace osgSkin

#endif
