// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_RATIOS_TWISTFIELDS_H
#define OSGSKINBIND_RATIOS_TWISTFIELDS_H

#include "fields/JointFields.h"
#include "joints/JointPlan.h"
#include "limbs/BoundarySpan.h"
#include "mesh/WeldedMesh.h"

#include <optional>
#include <vector>

namespace osgSkin {

/// Where the twist fields of the method `smooth` build up; unset where the twist goes with the
/// bend.
///
/// \param joint whose twist
/// \param radius of the limb at the joint, of limbRadii()
std::optional<BoundarySpan> twistSpan(const PlannedJoint& joint, double radius);

/// Twist ratios: they build up along the pole bone, within the bend field of the joint that moves
/// that bone, so they are as continuous as the bend fields. Never more than the parent's.
///
/// \param mesh the skin
/// \param joints of planJoints()
/// \param radii of limbRadii()
/// \param bend of bendFields()
JointFields twistFields(const WeldedMesh& mesh, const std::vector<PlannedJoint>& joints,
                        const std::vector<double>& radii, const JointFields& bend);

} // namespace osgSkin

#endif
