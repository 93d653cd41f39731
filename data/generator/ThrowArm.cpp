// SPDX-License-Identifier: MIT
#include "ThrowArm.h"

#include "ThrowTrunk.h"

#include <glm/geometric.hpp>

#include <cmath>

namespace mannequin {
namespace {

/// The bones of an arm in the rest pose.
struct RestArm {
    RestArm(const Skeleton& skeleton, Side side)
        : prefix(side == Side::Left ? "Left" : "Right"),
          thumbName(side == Side::Left ? "LThumb" : "RThumb") {
        const auto centre = [&](const char* name) { return skeleton.joint(prefix + name).centre; };
        upper = glm::normalize(centre("ForeArm") - centre("Arm"));
        fore = glm::normalize(centre("Hand") - centre("ForeArm"));
        hand = glm::normalize(centre("FingerBase") - centre("Hand"));
        hinge = glm::normalize(glm::cross(upper, fore));
        palm = glm::normalize(glm::cross(hand, glm::dvec3(0, 0, 1))) * sign(side);
        const RestJoint& thumbJoint = skeleton.joint(thumbName);
        thumb = glm::normalize(thumbJoint.endSite - thumbJoint.centre);
        flexion = degrees(std::acos(glm::dot(upper, fore)));
    }

    std::string prefix, thumbName;
    glm::dvec3 upper, fore, hand, thumb;
    glm::dvec3 hinge; ///< axis of the elbow's flexion
    glm::dvec3 palm;  ///< direction out of the palm
    double flexion;   ///< of the elbow at rest
};

/// Axes of the clinical angles, in the trunk's frame.
struct ArmAxes {
    glm::dvec3 upper; ///< along the upper arm
    glm::dvec3 zero;  ///< direction of the flexed forearm at 0 degrees of external rotation
    glm::dvec3 right; ///< the same at 90 degrees
};

ArmAxes armAxes(Side side, double abduction, double horizontal) {
    const double a = radians(abduction);
    const double s = sign(side);
    const glm::dquat about = turn(-s * horizontal, {0, 1, 0});
    return {about * glm::dvec3(s * std::sin(a), -std::cos(a), 0), about * glm::dvec3(0, 0, 1),
            about * glm::dvec3(s * std::cos(a), std::sin(a), 0)};
}

} // namespace

ArmAngles armAngles(const ArmKeys& keys, double time) {
    ArmAngles a;
    a.protraction = keys.protraction.at(time);
    a.elevation = keys.elevation.at(time);
    a.tilt = keys.tilt.at(time);
    a.abduction = keys.abduction.at(time);
    a.horizontal = keys.horizontal.at(time);
    a.external = keys.external.at(time);
    a.elbow = keys.elbow.at(time);
    a.pronation = keys.pronation.at(time);
    a.wrist = keys.wrist.at(time);
    a.fingers = keys.fingers.at(time);
    a.thumb = keys.thumb.at(time);
    return a;
}

void poseArm(const Skeleton& skeleton, Side side, const ArmAngles& angles, Pose& pose) {
    const ArmAxes axes = armAxes(side, angles.abduction, angles.horizontal);
    const double external = radians(angles.external);
    poseArm(skeleton, side, angles,
            {axes.upper, std::cos(external) * axes.zero + std::sin(external) * axes.right}, pose);
}

void poseArm(const Skeleton& skeleton, Side side, const ArmAngles& angles,
             const ArmDirections& directions, Pose& pose) {
    const RestArm rest(skeleton, side);
    const double s = sign(side);
    const auto local = [&](const std::string& name) -> glm::dquat& {
        return pose.local[skeleton.index(name)];
    };
    local(rest.prefix + "Shoulder") = turn(-s * angles.protraction, {0, 1, 0}) *
                                      turn(s * angles.elevation, {0, 0, 1}) *
                                      turn(-angles.tilt, {1, 0, 0});

    const WorldPose world = worldPose(skeleton, pose);
    const glm::dmat3 target =
        trunkFrame(skeleton, world) * frameOf(directions.upper, directions.bend);
    const glm::dmat3 fromRest = target * glm::transpose(frameOf(rest.upper, rest.fore));
    const glm::dquat girdle = world.rotation[skeleton.index(rest.prefix + "Shoulder")];
    local(rest.prefix + "Arm") =
        glm::normalize(glm::inverse(girdle) * glm::normalize(glm::quat_cast(fromRest)));

    local(rest.prefix + "ForeArm") = turn(angles.elbow - rest.flexion, rest.hinge);
    // In CMU's skeletons the hand joint performs the forearm's pronation.
    local(rest.prefix + "Hand") = turn(s * angles.pronation, rest.fore) *
                                  turn(angles.wrist, glm::cross(rest.hand, rest.palm));
    const glm::dquat curl = turn(angles.fingers, glm::cross(rest.hand, rest.palm));
    local(rest.prefix + "FingerBase") = curl;
    local(rest.prefix + "HandIndex1") = curl;
    local(rest.thumbName) = turn(angles.thumb, glm::cross(rest.thumb, rest.palm));
}

ArmAngles measureArm(const Skeleton& skeleton, Side side, const WorldPose& world) {
    const std::string prefix = side == Side::Left ? "Left" : "Right";
    const auto at = [&](const char* name) { return world.position[skeleton.index(prefix + name)]; };
    const glm::dmat3 toTrunk = glm::transpose(trunkFrame(skeleton, world));
    const glm::dvec3 upper = toTrunk * glm::normalize(at("ForeArm") - at("Arm"));
    const glm::dvec3 fore = toTrunk * glm::normalize(at("Hand") - at("ForeArm"));
    ArmAngles a;
    a.abduction = degrees(std::acos(glm::clamp(-upper.y, -1.0, 1.0)));
    a.horizontal = degrees(std::atan2(upper.z, sign(side) * upper.x));
    const ArmAxes axes = armAxes(side, a.abduction, a.horizontal);
    a.external = degrees(std::atan2(glm::dot(fore, axes.right), glm::dot(fore, axes.zero)));
    if (a.external < -90) a.external += 360; // 180 is within the throwing shoulder's range
    const std::size_t arm = skeleton.index(prefix + "Arm");
    const glm::dvec3 hinge = toTrunk * (world.rotation[arm] * RestArm(skeleton, side).hinge);
    a.elbow = degrees(std::atan2(glm::dot(glm::cross(upper, fore), hinge), glm::dot(upper, fore)));
    return a;
}

glm::dvec3 gripAtRest(const Skeleton& skeleton, Side side) {
    const RestArm rest(skeleton, side);
    const glm::dvec3 knuckle = skeleton.joint(rest.prefix + "FingerBase").centre;
    constexpr double kHalfHand = 0.014; // metres from the bones to the palm's skin
    return knuckle + 0.022 * rest.hand + (kBallRadius + kHalfHand) * rest.palm;
}

} // namespace mannequin
