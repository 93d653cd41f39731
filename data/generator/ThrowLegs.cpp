// SPDX-License-Identifier: MIT
#include "ThrowLegs.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace mannequin {
namespace {

/// The bones of a leg in the rest pose.
struct RestLeg {
    RestLeg(const Skeleton& skeleton, Side side) {
        const std::string prefix = side == Side::Left ? "Left" : "Right";
        hip = skeleton.index(prefix + "UpLeg");
        knee = skeleton.index(prefix + "Leg");
        ankle = skeleton.index(prefix + "Foot");
        toe = skeleton.index(prefix + "ToeBase");
        const std::vector<RestJoint>& joints = skeleton.joints();
        thigh = joints[knee].centre - joints[hip].centre;
        shank = joints[ankle].centre - joints[knee].centre;
        hinge = glm::normalize(glm::cross(thigh, shank));
        flexion = std::acos(glm::dot(glm::normalize(thigh), glm::normalize(shank)));
    }

    /// Distance from hip to ankle if the knee is flexed by `angle` radians.
    double reach(double angle) const {
        const double a = glm::length(thigh);
        const double b = glm::length(shank);
        return std::sqrt(a * a + b * b + 2 * a * b * std::cos(angle));
    }

    std::size_t hip, knee, ankle, toe;
    glm::dvec3 thigh, shank;
    glm::dvec3 hinge; ///< axis of the knee's flexion
    double flexion;   ///< at rest, radians
};

double smoothMinimum(double a, double b, double width) {
    const double d = std::abs(a - b);
    return d >= width
               ? std::min(a, b)
               : std::min(a, b) - (width - d) * (width - d) * (width - d) / (6 * width * width);
}

/// Maximum height of the hip above the ankle: the height at the minimum knee flexion.
double reachableHeight(const RestLeg& leg, const glm::dvec3& hip, const glm::dvec3& ankle) {
    const double most = leg.reach(radians(kMinKnee));
    const double across = std::hypot(hip.x - ankle.x, hip.z - ankle.z);
    return std::sqrt(std::max(most * most - across * across, 0.01));
}

} // namespace

void lowerPelvis(const Skeleton& skeleton, const FootTarget& right, const FootTarget& left,
                 Pose& pose) {
    const WorldPose world = worldPose(skeleton, pose);
    double height = pose.root.y;
    for (const Side side : {Side::Right, Side::Left}) {
        const RestLeg leg(skeleton, side);
        const glm::dvec3 hip = world.position[leg.hip];
        const glm::dvec3 ankle = side == Side::Right ? right.ankle : left.ankle;
        const double limit = pose.root.y + ankle.y + reachableHeight(leg, hip, ankle) - hip.y;
        height = smoothMinimum(height, limit, 0.03);
    }
    pose.root.y = height;
}

void poseLeg(const Skeleton& skeleton, Side side, const FootTarget& foot, Pose& pose) {
    const RestLeg leg(skeleton, side);
    const WorldPose world = worldPose(skeleton, pose);
    const double a = glm::length(leg.thigh);
    const double b = glm::length(leg.shank);
    const glm::dvec3 span = foot.ankle - world.position[leg.hip];
    const double reach =
        std::clamp(glm::length(span), leg.reach(radians(150)), leg.reach(radians(kMinKnee)));
    const double cosine = (reach * reach - a * a - b * b) / (2 * a * b);
    const double flexion = std::acos(std::clamp(cosine, -1.0, 1.0));

    // The knee points midway between the foot's direction and the pelvis's.
    const glm::dvec3 forward = world.rotation[skeleton.index("Hips")] * glm::dvec3(0, 0, 1);
    const glm::dvec3 footward = turn(foot.kneeYaw, {0, 1, 0}) * glm::dvec3(0, 0, 1);
    const glm::dvec3 pole = glm::normalize(forward) + footward;

    // Two frames of the flexed leg, at rest and in the world: the first axis points from the hip to
    // the ankle, the second towards the knee.
    const glm::dquat bend = glm::angleAxis(flexion - leg.flexion, leg.hinge);
    const glm::dvec3 restSpan = leg.thigh + bend * leg.shank;
    const glm::dmat3 fromRest = frameOf(span, pole) * glm::transpose(frameOf(restSpan, leg.thigh));
    const glm::dquat thigh = glm::normalize(glm::quat_cast(fromRest));

    const glm::dquat pelvis = world.rotation[skeleton.index("Hips")];
    pose.local[leg.hip] = glm::inverse(pelvis) * thigh;
    pose.local[leg.knee] = bend;
    pose.local[leg.ankle] = glm::inverse(thigh * bend) * foot.rotation;
    pose.local[leg.toe] = turn(-foot.toeBend, {1, 0, 0});
}

double kneeFlexion(const Skeleton& skeleton, Side side, const WorldPose& world) {
    const RestLeg leg(skeleton, side);
    const glm::dvec3 thigh = world.position[leg.knee] - world.position[leg.hip];
    const glm::dvec3 shank = world.position[leg.ankle] - world.position[leg.knee];
    const glm::dvec3 hinge = world.rotation[leg.hip] * leg.hinge;
    return degrees(std::atan2(glm::dot(glm::cross(thigh, shank), hinge), glm::dot(thigh, shank)));
}

} // namespace mannequin
