// SPDX-License-Identifier: MIT
#pragma once

#include "ThrowArm.h"
#include "ThrowKeys.h"
#include "ThrowPose.h"

namespace mannequin {

/// Where a foot is to be, in world space.
struct FootTarget {
    glm::dvec3 ankle{0};
    glm::dvec3 toe{0}; ///< the joint ToeBase: the ball of the foot
    glm::dquat rotation{1, 0, 0, 0};
    double toeBend = 0; ///< degrees; extends the toes, which stay flat on the floor
    double kneeYaw = 0; ///< degrees; where the knee points when the foot is on the floor
};

/// The keyed foot: its ball at (x, z), `lift` metres above the floor; `yaw` from the rest pose;
/// `heel` degrees of heel raised (above 0) or toes raised (below 0). Raised as a whole as far as
/// any of its points would be below the floor, so that a foot lands on its heel and leaves over
/// its toes.
FootTarget footTarget(const Skeleton& skeleton, Side side, const FootKeys& keys, double time);

/// Lowest height of the foot's sole: heel, ball and tip of the toes.
double soleHeight(const Skeleton& skeleton, Side side, const WorldPose& world);

} // namespace mannequin
