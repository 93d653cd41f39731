// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_BOUNDJOINTS_H
#define OSGSKINBIND_BOUNDJOINTS_H

#include "joints/JointPlan.h"

#include <osgSkin/Binding>
#include <osgSkinRig/RestSkeleton>

#include <vector>

namespace osgSkin {

/// The planned joints as the deformation needs them, in the skeleton's order.
std::vector<BoundJoint> boundJoints(const RestSkeleton& skeleton,
                                    const std::vector<PlannedJoint>& joints);

} // namespace osgSkin

#endif
