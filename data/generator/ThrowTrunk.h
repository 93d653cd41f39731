// SPDX-License-Identifier: MIT
#pragma once

#include "ThrowKeys.h"
#include "ThrowPose.h"

namespace mannequin {

/// Sets the rotations from the pelvis to the head at `time`, and the keyed root position.
///
/// The keys say how the pelvis, the thorax and the head stand in the world; the lumbar and neck
/// joints share the difference between their two ends.
void poseTrunk(const Skeleton& skeleton, const BodyKeys& keys, double time, Pose& pose);

/// The frame that the shoulder's angles are measured in: columns left, up, forward. Up runs from
/// the hips to the neck, so that an arched spine counts towards the shoulder's external rotation,
/// as it does where markers on the hips and shoulders define the trunk (Dillman et al. 1993).
glm::dmat3 trunkFrame(const Skeleton& skeleton, const WorldPose& world);

} // namespace mannequin
