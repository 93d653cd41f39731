// SPDX-License-Identifier: MIT
#include "ThrowClearance.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <limits>

namespace mannequin {
namespace {

struct Capsule {
    const char* from;
    const char* to;
    double radius;
};

struct Pair {
    Capsule a, b;
};

constexpr Capsule kRightForeArm{"RightForeArm", "RightHand", 0.045};
constexpr Capsule kRightHand{"RightHand", "RightFingerBase", 0.035};
constexpr Capsule kLeftForeArm{"LeftForeArm", "LeftHand", 0.045};
constexpr Capsule kLeftHand{"LeftHand", "LeftFingerBase", 0.035};
constexpr Capsule kRightThigh{"RightUpLeg", "RightLeg", 0.085};
constexpr Capsule kLeftThigh{"LeftUpLeg", "LeftLeg", 0.085};
constexpr Capsule kRightShin{"RightLeg", "RightFoot", 0.055};
constexpr Capsule kLeftShin{"LeftLeg", "LeftFoot", 0.055};
constexpr Capsule kBelly{"Hips", "Spine", 0.125};
constexpr Capsule kChest{"Spine", "Neck", 0.115};

constexpr Pair kPairs[] = {
    {kRightForeArm, kRightThigh}, {kRightForeArm, kLeftThigh}, {kRightForeArm, kBelly},
    {kRightForeArm, kChest},      {kRightHand, kRightThigh},   {kRightHand, kLeftThigh},
    {kRightHand, kLeftShin},      {kRightHand, kBelly},        {kRightHand, kChest},
    {kLeftForeArm, kRightThigh},  {kLeftForeArm, kLeftThigh},  {kLeftForeArm, kBelly},
    {kLeftForeArm, kChest},       {kLeftHand, kRightThigh},    {kLeftHand, kLeftThigh},
    {kLeftHand, kBelly},          {kLeftHand, kChest},         {kRightForeArm, kLeftForeArm},
    {kRightShin, kLeftShin},
};

double distanceToSegment(const glm::dvec3& p, const glm::dvec3& from, const glm::dvec3& to) {
    const glm::dvec3 along = to - from;
    const double t = glm::clamp(glm::dot(p - from, along) / glm::dot(along, along), 0.0, 1.0);
    return glm::distance(p, from + t * along);
}

} // namespace

double limbClearance(const Skeleton& skeleton, const WorldPose& world) {
    const auto at = [&](const char* joint) { return world.position[skeleton.index(joint)]; };
    double least = std::numeric_limits<double>::max();
    for (const Pair& pair : kPairs) {
        constexpr int kSteps = 16; // samples along one segment; the other is solved exactly
        for (int i = 0; i <= kSteps; ++i) {
            const glm::dvec3 p =
                glm::mix(at(pair.a.from), at(pair.a.to), static_cast<double>(i) / kSteps);
            const double gap = distanceToSegment(p, at(pair.b.from), at(pair.b.to));
            least = std::min(least, gap - pair.a.radius - pair.b.radius);
        }
    }
    return least;
}

} // namespace mannequin
