// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_LIMBS_ARMSWINGS_H
#define OSGSKINBIND_LIMBS_ARMSWINGS_H

#include "joints/JointPlan.h"

#include <vector>

namespace osgSkin {

/// The turns by which an upper arm leaves its rest pose for the directions that arms point in:
/// hanging down, reaching forwards, to the side and up. An arm that rests raised mostly turns down.
///
/// \param joints as planned
/// \param joint where a limb leaves the trunk
/// \return axis times angle, radians, rest space; none where no hand hangs on the joint, or where
///         nothing tells how the body stands
std::vector<glm::dvec3> armSwings(const std::vector<PlannedJoint>& joints, std::size_t joint);

} // namespace osgSkin

#endif
