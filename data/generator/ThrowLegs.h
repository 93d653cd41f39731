// SPDX-License-Identifier: MIT
#pragma once

#include "ThrowFoot.h"
#include "ThrowPose.h"

namespace mannequin {

/// The least knee flexion, degrees: short of straight, where a small step of the hip needs a large
/// one of the knee.
constexpr double kMinKnee = 7;

/// Lowers the root, smoothly, as far as needed for both legs to reach their feet.
void lowerPelvis(const Skeleton& skeleton, const FootTarget& right, const FootTarget& left,
                 Pose& pose);

/// Sets the rotations of one leg by analytic two-bone inverse kinematics.
/// The pelvis must be posed; a foot out of reach is approached as far as the leg goes.
void poseLeg(const Skeleton& skeleton, Side side, const FootTarget& foot, Pose& pose);

/// Flexion of the knee in degrees, 0 straight; below 0 when it bends the wrong way.
double kneeFlexion(const Skeleton& skeleton, Side side, const WorldPose& world);

} // namespace mannequin
