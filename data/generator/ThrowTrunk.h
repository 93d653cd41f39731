// SPDX-License-Identifier: MIT
#pragma once

#include "ThrowKeys.h"
#include "ThrowPose.h"

namespace mannequin {

/// Orientations in the world.
struct TrunkRotations {
    glm::dquat pelvis, thorax, head;
};

/// Sets the rotations from the pelvis to the head. The lumbar joints share the rotation between
/// pelvis and thorax, the neck joints that between thorax and head.
void poseTrunk(const Skeleton& skeleton, const TrunkRotations& rotations, Pose& pose);

/// Sets the keyed rotations from the pelvis to the head at `time`, and the keyed root position.
void poseTrunk(const Skeleton& skeleton, const BodyKeys& keys, double time, Pose& pose);

/// The frame of the shoulder's angles; its columns are left, up and forward. Up points from the
/// hips to the neck, so an arched spine adds to the shoulder's external rotation. That is also the
/// case if markers on hips and shoulders define the trunk (Dillman et al. 1993).
glm::dmat3 trunkFrame(const Skeleton& skeleton, const WorldPose& world);

} // namespace mannequin
