// SPDX-License-Identifier: MIT
#include "ThrowFoot.h"

#include <algorithm>
#include <cmath>

namespace mannequin {
namespace {

// Centre of the heel, a sphere that touches the floor at rest, relative to the ankle.
const glm::dvec3 kHeel(0, -0.043, -0.030);
constexpr double kHeelRadius = 0.035;
constexpr double kBallHeight = 0.022; // of the joint ToeBase at rest
constexpr double kTipHeight = 0.015;

std::string name(Side side, const char* joint) {
    return std::string(side == Side::Left ? "Left" : "Right") + joint;
}

double smoothStep(double x) {
    const double u = std::clamp(x, 0.0, 1.0);
    return u * u * (3 - 2 * u);
}

} // namespace

FootTarget footTarget(const Skeleton& skeleton, Side side, const FootKeys& keys, double time) {
    const RestJoint& ankle = skeleton.joint(name(side, "Foot"));
    const RestJoint& toe = skeleton.joint(name(side, "ToeBase"));
    const double heel = keys.heel.at(time);
    const double lift = keys.lift.at(time);

    FootTarget target;
    target.rotation = turn(keys.yaw.at(time), {0, 1, 0}) * turn(heel, {1, 0, 0});
    target.kneeYaw = keys.yaw.at(time) + keys.kneeOut.at(time);
    // Toes bend up to 55 degrees while they press on the floor, and relax in the air.
    const double grounded = smoothStep(1 - lift / 0.25);
    target.toeBend = std::min(std::max(heel, 0.0), 55.0) * grounded;

    const glm::dvec3 back = target.rotation * (ankle.centre - toe.centre);
    const glm::dvec3 tip =
        target.rotation * turn(-target.toeBend, {1, 0, 0}) * (toe.endSite - toe.centre);
    const double heelBottom = back.y + (target.rotation * kHeel).y - kHeelRadius + kBallHeight;
    const double tipBottom = tip.y - kTipHeight + kBallHeight;
    const double raise = std::max({0.0, -heelBottom - lift, -tipBottom - lift});
    target.toe = {keys.x.at(time), kBallHeight + lift + raise, keys.z.at(time)};
    target.ankle = target.toe + back;
    return target;
}

double soleHeight(const Skeleton& skeleton, Side side, const WorldPose& world) {
    const std::size_t ankle = skeleton.index(name(side, "Foot"));
    const std::size_t toe = skeleton.index(name(side, "ToeBase"));
    const double heel = (world.position[ankle] + world.rotation[ankle] * kHeel).y - kHeelRadius;
    return std::min({heel, world.position[toe].y - kBallHeight, world.tip[toe].y - kTipHeight});
}

} // namespace mannequin
