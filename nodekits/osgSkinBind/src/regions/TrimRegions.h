// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_REGIONS_TRIMREGIONS_H
#define OSGSKINBIND_REGIONS_TRIMREGIONS_H

#include "joints/JointPlan.h"
#include "mesh/WeldedMesh.h"

#include <cstdint>
#include <vector>

namespace osgSkin {

/// Gives what lies well above a joint's plane, where it does not bend, to the region above: the
/// torso's side below a shoulder. So also what lies far from a collar bone, the chest below it, and
/// what faces a limb from afar: the torso's side beside an arm that hangs down.
void trimRegions(const WeldedMesh& mesh, const std::vector<PlannedJoint>& joints,
                 std::vector<std::uint32_t>& jointOf);

} // namespace osgSkin

#endif
