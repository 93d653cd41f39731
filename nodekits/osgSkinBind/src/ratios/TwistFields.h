// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_RATIOS_TWISTFIELDS_H
#define OSGSKINBIND_RATIOS_TWISTFIELDS_H

#include "joints/JointPlan.h"
#include "mesh/WeldedMesh.h"
#include "ratios/JointFields.h"

#include <vector>

namespace osgSkin {

/// Twist ratios: they build up along the pole bone, within the bend field of the joint that moves
/// that bone, so they are as continuous as the bend fields. Never more than the parent's.
JointFields twistFields(const WeldedMesh& mesh, const std::vector<PlannedJoint>& joints,
                        const std::vector<double>& radii, const JointFields& bend);

} // namespace osgSkin

#endif
