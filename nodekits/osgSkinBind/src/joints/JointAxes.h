// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_JOINTAXES_H
#define OSGSKINBIND_JOINTAXES_H

#include "joints/JointPlan.h"

namespace osgSkin {

/// Fills in centre, parent, child, bone and axes of the joints; centres closer than `tolerance` are
/// one point.
/// \pre the joints' parts are set
/// \pre the joints' parts are set
void setJointAxes(const RestSkeleton& skeleton, double tolerance,
                  std::vector<PlannedJoint>& joints);

} // namespace osgSkin

#endif
