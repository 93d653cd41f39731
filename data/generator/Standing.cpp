// SPDX-License-Identifier: MIT
#include "Standing.h"

#include "Gait.h"
#include "ThrowLegs.h"
#include "ThrowTrunk.h"

#include <glm/geometric.hpp>

#include <cmath>

namespace mannequin {
namespace {

/// What differs between the motions, in metres and degrees.
struct Stand {
    double sway = 0.004; ///< of the hips, to the left
    double turn = 1.5;   ///< of the thorax, to the left
    double breath = 0;   ///< 0 to 1
    double headYaw = 2;  ///< to the left
    double headRoll = 0; ///< towards the right shoulder
    double raised = 0;   ///< 0 to 1: the right arm
    double waved = 0;    ///< of the raised forearm, outwards
};

/// A frame of an arm: along the upper arm, and towards the flexed forearm.
glm::dquat armFrame(const glm::dvec3& upper, const glm::dvec3& bend) {
    return glm::quat_cast(frameOf(upper, bend));
}

void standOnFeet(const Skeleton& skeleton, Pose& pose) {
    const glm::dvec3 rest = skeleton.joint("LeftFoot").centre;
    for (const Side side : {Side::Left, Side::Right}) {
        FootTarget target;
        const double out = side == Side::Left ? 2 : 7; // degrees, in addition to the rest pose
        target.rotation = turn(sign(side) * out, {0, 1, 0});
        target.kneeYaw = sign(side) * out;
        target.ankle = {sign(side) * 0.098, rest.y, side == Side::Left ? -0.035 : 0.020};
        poseLeg(skeleton, side, target, pose);
    }
}

void hangArms(const Skeleton& skeleton, const Stand& stand, Pose& pose) {
    for (const Side side : {Side::Left, Side::Right}) {
        const double s = sign(side);
        const double raised = side == Side::Right ? stand.raised : 0;
        const double waved = radians(stand.waved);
        const glm::dquat down = armFrame({s * 0.15, -1, -0.02}, {-s * 0.45, 0.1, 1});
        const glm::dquat up = armFrame({s * 0.80, -0.46, 0.38},
                                       {s * std::sin(waved) + s * 0.10, std::cos(waved), 0.32});
        const glm::dmat3 frame = glm::mat3_cast(glm::slerp(down, up, raised));
        ArmAngles arm;
        arm.elevation = 1.2 * stand.breath + 9 * raised;
        arm.elbow = glm::mix(17.0, 104.0, raised) - raised * stand.waved * 0.35;
        arm.pronation = glm::mix(24.0, 8.0, raised);
        arm.wrist = raised * -6;
        arm.fingers = glm::mix(15.0, -7.0, raised);
        arm.thumb = glm::mix(8.0, -10.0, raised);
        poseArm(skeleton, side, arm, {frame[0], frame[1]}, pose);
    }
}

Pose standing(const Skeleton& skeleton, const Stand& stand) {
    Pose pose;
    pose.local.assign(skeleton.joints().size(), glm::dquat(1, 0, 0, 0));
    pose.root = {0.012 + stand.sway, 0.962 + 0.001 * stand.breath, 0.010};
    poseTrunk(skeleton,
              {stance(stand.turn * 0.4 - 2, -2.5, 1),
               stance(stand.turn, -0.6 + 40 * stand.sway, 0.6 - 0.9 * stand.breath),
               turn(stand.headYaw, {0, 1, 0}) * turn(-1 + 0.8 * stand.breath, {1, 0, 0}) *
                   turn(stand.headRoll, {0, 0, 1})},
              pose);
    standOnFeet(skeleton, pose);
    hangArms(skeleton, stand, pose);
    return pose;
}

} // namespace

Pose idlePose(const Skeleton& skeleton, double time) {
    const double phase = time / kIdleSeconds;
    Stand stand;
    stand.sway = Swing{0, 0.007, 0.25}.at(phase);
    stand.turn = Swing{0, 1.2, 0.40}.at(phase);
    stand.breath = 0.5 - Swing{0, 0.5, 0}.at(phase);
    stand.headYaw = Swing{0, 4, 0.35}.at(phase) + Swing{0, 1.2, 0.1}.at(phase, 2);
    stand.headRoll = Swing{0, 1, 0.6}.at(phase);
    return standing(skeleton, stand);
}

Pose wavePose(const Skeleton& skeleton, double time) {
    static const Channel raise(0.16, {{0.16, 0}, {0.72, 1}, {2.36, 1}, {3.00, 0}}, kWaveSeconds);
    static const Channel waved(0.09,
                               {{0.50, 0},
                                {0.84, 24},
                                {1.10, -16},
                                {1.36, 24},
                                {1.62, -16},
                                {1.88, 24},
                                {2.14, -14},
                                {2.50, 0}},
                               kWaveSeconds);
    Stand stand;
    stand.raised = raise.at(time);
    stand.waved = waved.at(time);
    const double phase = time / kWaveSeconds;
    stand.sway = Swing{0, 0.003, 0.25}.at(phase) + 0.004 * stand.raised;
    stand.breath = 0.5 - Swing{0, 0.5, 0}.at(phase);
    stand.turn = -3 * stand.raised;
    stand.headYaw = 2 - 3 * stand.raised;
    stand.headRoll = 3 * stand.raised;
    const Pose pose = standing(skeleton, stand);
    return pose;
}

} // namespace mannequin
