// SPDX-License-Identifier: MIT
#include "ThrowMotion.h"

#include "ThrowArmKeys.h"
#include "ThrowBodyKeys.h"
#include "ThrowFootKeys.h"
#include "ThrowLegs.h"
#include "ThrowTrunk.h"

namespace mannequin {

ThrowMotion::ThrowMotion(const Skeleton& skeleton)
    : skeleton_(skeleton), body_(bodyKeys()), throwing_(throwingArmKeys()), glove_(gloveArmKeys()),
      pivot_(pivotFootKeys()), lead_(leadFootKeys()) {}

Pose ThrowMotion::poseAt(double time) const {
    Pose pose;
    pose.local.assign(skeleton_.joints().size(), glm::dquat(1, 0, 0, 0));
    poseTrunk(skeleton_, body_, time, pose);
    const FootTarget right = footTarget(skeleton_, Side::Right, pivot_, time);
    const FootTarget left = footTarget(skeleton_, Side::Left, lead_, time);
    lowerPelvis(skeleton_, right, left, pose);
    poseLeg(skeleton_, Side::Right, right, pose);
    poseLeg(skeleton_, Side::Left, left, pose);
    poseArm(skeleton_, Side::Right, armAngles(throwing_, time), pose);
    poseArm(skeleton_, Side::Left, armAngles(glove_, time), pose);
    return pose;
}

glm::dvec3 grip(const Skeleton& skeleton, const WorldPose& world) {
    const std::size_t hand = skeleton.index("RightHand");
    const glm::dvec3 offset =
        gripAtRest(skeleton, Side::Right) - skeleton.joint("RightHand").centre;
    return world.position[hand] + world.rotation[hand] * offset;
}

glm::dvec3 ThrowMotion::gripAt(double time) const {
    return grip(skeleton_, worldPose(skeleton_, poseAt(time)));
}

glm::dvec3 ThrowMotion::gripVelocityAt(double time) const {
    constexpr double kStep = 1e-4;
    return (gripAt(time + kStep) - gripAt(time - kStep)) / (2 * kStep);
}

} // namespace mannequin
