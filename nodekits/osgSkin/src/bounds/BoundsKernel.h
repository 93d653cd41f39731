// SPDX-License-Identifier: MIT
#pragma once

#include "bounds/JointMotion.h"
#include "model/BoundsProxy.h"

#include <osgSkin/Pose>

namespace osgSkin {

/// A box, three lanes each.
struct FourBox {
    Four low, high;
};

/// The box that holds a posed skin, by the best instruction set that the processor has.
///
/// \param proxy of the pose's model
/// \param pose of the model's joints
/// \param room for as many as the pose has joints, and at least PoseAccess::kAtOnce
/// \param weights CorrectiveStray's; null where there are no correctives
FourBox boxOf(const BoundsProxy& proxy, const Pose& pose, JointMotion* room,
              const float* weights) noexcept;

} // namespace osgSkin
