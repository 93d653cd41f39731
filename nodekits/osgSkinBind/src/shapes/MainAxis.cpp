// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapes/MainAxis.h"

#include "joints/BodyAxes.h"

#include <glm/geometric.hpp>

#include <cmath>

namespace osgSkin {
namespace {

/// Sines of the rest pose's bend from which on it says how the joint bends: alone (12 degrees), and
/// where nothing better is known (3 degrees).
constexpr double kPlain = 0.21;
constexpr double kFaint = 0.052;

/// Cosine of the angle that a knee's axis leans from its main axis, at most.
constexpr double kMinAlong = 0.9;

enum class End { None, Hand, Foot };

/// What a limb ends in: the first hand or foot below the joint.
End endOf(const RestSkeleton& skeleton, const std::vector<PlannedJoint>& joints,
          std::size_t joint) {
    for (std::size_t j = joint + 1; j < skeleton.joints.size(); ++j) {
        if (!skeleton.isInSubtree(static_cast<int>(j), static_cast<int>(joint))) continue;
        if (joints[j].part == JointPart::Hand) return End::Hand;
        if (joints[j].part == JointPart::Foot) return End::Foot;
    }
    return End::None;
}

} // namespace

std::optional<glm::dvec3> findMainAxis(const RestSkeleton& skeleton,
                                       const std::vector<PlannedJoint>& joints, std::size_t joint) {
    const PlannedJoint& planned = joints[joint];
    const auto acrossTwist = [&planned](const glm::dvec3& axis) {
        return glm::normalize(axis - planned.twistAxis * glm::dot(axis, planned.twistAxis));
    };
    const glm::dvec3 atRest = glm::cross(planned.comingFrom, planned.boneAxis);
    const double sine = glm::length(atRest);
    if (sine > kPlain) return acrossTwist(atRest);
    const End end = endOf(skeleton, joints, joint);
    const glm::dvec3 front = facing(joints);
    if (end != End::None && glm::length(front) > 1e-6) {
        const glm::dvec3 axis = glm::cross(planned.boneAxis, end == End::Hand ? front : -front);
        if (glm::length(axis) > 0.3 * glm::length(front)) return acrossTwist(axis);
    }
    if (end != End::None && sine > kFaint) return acrossTwist(atRest);
    return std::nullopt;
}

glm::dvec3 findHinge(const RestSkeleton& skeleton, const std::vector<PlannedJoint>& joints,
                     std::size_t joint, const glm::dvec3& mainAxis) {
    const std::optional<BodyAxes> body = bodyAxes(joints);
    if (!body || endOf(skeleton, joints, joint) != End::Foot) return mainAxis;
    const glm::dvec3 across = glm::cross(body->up, body->front);
    const double along = glm::dot(across, mainAxis);
    if (std::abs(along) < kMinAlong) return mainAxis;
    return glm::normalize(mainAxis + std::copysign(1.0, along) * across);
}

} // namespace osgSkin
