// SPDX-License-Identifier: MIT
#pragma once

#include "ThrowArm.h"
#include "ThrowKeys.h"
#include "ThrowPose.h"

namespace mannequin {

/// Target placement of a foot, in world space.
struct FootTarget {
    glm::dvec3 ankle{0};
    glm::dvec3 toe{0}; ///< the joint ToeBase: the ball of the foot
    glm::dquat rotation{1, 0, 0, 0};
    double toeBend = 0; ///< degrees; extends the toes, which stay flat on the floor
    double kneeYaw = 0; ///< degrees; direction of the knee while the foot is on the floor
};

/// The keyed foot: its ball is at (x, z), `lift` metres above the floor; `yaw` is relative to the
/// rest pose; `heel` raises the heel (positive) or the toes (negative), in degrees. The foot is
/// raised until no point is below the floor, so it lands on its heel and leaves on its toes.
FootTarget footTarget(const Skeleton& skeleton, Side side, const FootKeys& keys, double time);

/// Height of the lowest of heel, ball and toe tip.
double soleHeight(const Skeleton& skeleton, Side side, const WorldPose& world);

} // namespace mannequin
