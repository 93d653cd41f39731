// SPDX-License-Identifier: MIT
#include "ThrowMeasure.h"

#include "ThrowLegs.h"
#include "ThrowTiming.h"
#include "ThrowTrunk.h"

#include <glm/geometric.hpp>

#include <cmath>

namespace mannequin {
namespace {

/// The heading of a segment. Uses its left-right axis, which stays near the horizontal even if the
/// forward axis does not.
double yawOf(const glm::dquat& rotation) {
    const glm::dvec3 left = rotation * glm::dvec3(1, 0, 0);
    return degrees(std::atan2(-left.z, left.x));
}

struct Peak {
    int frame = 0;
    double speed = 0;
};

/// The fastest increase (`direction` +1) or decrease (-1) of an angle, from the stride until
/// shortly after the release.
Peak fastest(const std::vector<FrameMeasure>& frames, double FrameMeasure::*angle,
             double direction) {
    Peak peak;
    for (int i = kContactFrame - 24; i <= kReleaseFrame + 12; ++i) {
        const auto at = static_cast<std::size_t>(i);
        const double speed =
            direction * (frames[at + 1].*angle - frames[at - 1].*angle) * kFrameRate / 2;
        if (speed > peak.speed) peak = {i, speed};
    }
    return peak;
}

} // namespace

std::vector<FrameMeasure> measureFrames(const Skeleton& skeleton, const std::vector<Pose>& poses) {
    const auto index = [&](const char* name) { return skeleton.index(name); };
    std::vector<FrameMeasure> frames;
    for (const Pose& pose : poses) {
        const WorldPose world = worldPose(skeleton, pose);
        const ArmAngles arm = measureArm(skeleton, Side::Right, world);
        const glm::dvec3 trunk = world.position[index("Neck")] - world.position[index("Hips")];
        FrameMeasure m{};
        m.abduction = arm.abduction;
        m.horizontal = arm.horizontal;
        m.external = arm.external;
        m.elbow = arm.elbow;
        m.leftElbow = measureArm(skeleton, Side::Left, world).elbow;
        m.rightKnee = kneeFlexion(skeleton, Side::Right, world);
        m.leftKnee = kneeFlexion(skeleton, Side::Left, world);
        m.pelvisYaw = yawOf(world.rotation[index("Hips")]);
        m.thoraxYaw = yawOf(world.rotation[index("Spine1")]);
        m.tiltForward = degrees(std::atan2(trunk.x, trunk.y));
        m.tiltSide = degrees(std::atan2(-trunk.z, trunk.y));
        m.rightSole = soleHeight(skeleton, Side::Right, world);
        m.leftSole = soleHeight(skeleton, Side::Left, world);
        m.rightToe = world.position[index("RightToeBase")];
        m.leftToe = world.position[index("LeftToeBase")];
        m.rightAnkle = world.position[index("RightFoot")];
        m.leftAnkle = world.position[index("LeftFoot")];
        frames.push_back(m);
    }
    return frames;
}

Sequence kinematicSequence(const std::vector<FrameMeasure>& frames) {
    const Peak pelvis = fastest(frames, &FrameMeasure::pelvisYaw, 1);
    const Peak thorax = fastest(frames, &FrameMeasure::thoraxYaw, 1);
    const Peak elbow = fastest(frames, &FrameMeasure::elbow, -1);
    const Peak shoulder = fastest(frames, &FrameMeasure::external, -1);
    return {pelvis.frame, thorax.frame, elbow.frame, shoulder.frame,
            pelvis.speed, thorax.speed, elbow.speed, shoulder.speed};
}

Launch launchOf(const glm::dvec3& velocity) {
    return {glm::length(velocity),
            degrees(std::atan2(velocity.y, std::hypot(velocity.x, velocity.z))),
            degrees(std::atan2(velocity.z, velocity.x))};
}

} // namespace mannequin
