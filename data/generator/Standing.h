// SPDX-License-Identifier: MIT
#pragma once

#include "ThrowPose.h"

namespace mannequin {

constexpr double kIdleSeconds = 4;
constexpr double kWaveSeconds = 3.2;

/// Standing at ease: a breath, a slight sway and a glance to the side in kIdleSeconds.
Pose idlePose(const Skeleton& skeleton, double time);

/// Standing while the right hand goes up, waves and goes down in kWaveSeconds. It begins and ends
/// in the idle's first pose.
Pose wavePose(const Skeleton& skeleton, double time);

} // namespace mannequin
