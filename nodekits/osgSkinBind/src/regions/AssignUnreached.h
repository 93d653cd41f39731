// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_REGIONS_ASSIGNUNREACHED_H
#define OSGSKINBIND_REGIONS_ASSIGNUNREACHED_H

#include "joints/JointPlan.h"
#include "mesh/WeldedMesh.h"

#include <cstdint>
#include <vector>

namespace osgSkin {

/// Labels what flooding cannot reach: vertices like the nearest labelled vertex or the nearest
/// bone, whichever is nearer. So a button goes with the skin below it, and a lined coat that has no
/// body in it with the bones.
void assignUnreached(const WeldedMesh& mesh, const std::vector<PlannedJoint>& joints,
                     std::vector<std::uint32_t>& jointOf);

} // namespace osgSkin

#endif
