// SPDX-License-Identifier: MIT
#pragma once

#include "ThrowFoot.h"
#include "ThrowPose.h"

namespace mannequin {

/// Minimum knee flexion in degrees. Near a straight leg, a small hip movement would need a large
/// knee movement.
constexpr double kMinKnee = 7;

/// Smoothly lowers the root until both legs reach their feet.
void lowerPelvis(const Skeleton& skeleton, const FootTarget& right, const FootTarget& left,
                 Pose& pose);

/// Sets the rotations of one leg by analytic two-bone inverse kinematics. The leg is stretched
/// towards a foot that is out of reach.
/// \pre the pelvis is posed
void poseLeg(const Skeleton& skeleton, Side side, const FootTarget& foot, Pose& pose);

/// Flexion of the knee in degrees; 0 is straight, negative values bend the wrong way.
double kneeFlexion(const Skeleton& skeleton, Side side, const WorldPose& world);

} // namespace mannequin
