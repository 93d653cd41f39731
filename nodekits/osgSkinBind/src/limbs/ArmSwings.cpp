// SPDX-License-Identifier: GPL-3.0-or-later
#include "limbs/ArmSwings.h"

#include "joints/BodyAxes.h"

#include <glm/geometric.hpp>

#include <cmath>

namespace osgSkin {
namespace {

/// Where an arm may point: to the front, up and away from the body; of any length.
constexpr double kReached[][3] = {{0.0, -1.0, 0.2}, {0.5, -1.0, 0.2}, {-0.5, -1.0, 0.3},
                                  {1.0, 0.0, 0.0},  {1.0, 0.0, 1.0},  {0.0, 0.0, 1.0},
                                  {1.0, -0.7, 1.0}, {1.0, -0.7, 0.0}, {0.5, 0.7, 1.0},
                                  {1.0, 1.0, 0.4},  {0.0, 0.8, 1.0},  {-0.3, -0.4, 1.0}};

} // namespace

std::vector<glm::dvec3> armSwings(const std::vector<PlannedJoint>& joints, std::size_t joint) {
    const std::optional<BodyAxes> body = bodyAxes(joints);
    if (!body || !carries(joints, joint, JointPart::Hand)) return {};
    glm::dvec3 away = glm::cross(body->up, body->front);
    if (glm::dot(away, joints[joint].centre - joints.front().centre) < 0.0) away = -away;
    std::vector<glm::dvec3> swings;
    for (const auto& [front, up, out] : kReached) {
        const glm::dvec3 to = glm::normalize(front * body->front + up * body->up + out * away);
        const glm::dvec3 axis = glm::cross(joints[joint].boneAxis, to);
        const double sine = glm::length(axis);
        if (sine < 1e-6) continue; // it rests there
        swings.push_back(std::atan2(sine, glm::dot(joints[joint].boneAxis, to)) / sine * axis);
    }
    return swings;
}

} // namespace osgSkin
