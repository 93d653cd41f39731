// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_JOINTFIELDS_H
#define OSGSKINBIND_JOINTFIELDS_H

#include "joints/JointPlan.h"

#include <vector>

namespace osgSkin {

/// For each joint a value at each welded vertex.
using JointFields = std::vector<std::vector<double>>;

/// Raises each joint's field to that of its children, so that along a chain no joint rotates skin
/// that its parent leaves behind. A joint without a region (of no length, or skipped) rotates what
/// its children rotate.
///
/// \param joints of planJoints(); what is below a rigid joint raises nothing
/// \param fields one for each joint
void raiseParents(const std::vector<PlannedJoint>& joints, JointFields& fields);

} // namespace osgSkin

#endif
