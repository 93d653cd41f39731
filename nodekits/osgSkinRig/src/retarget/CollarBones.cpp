// SPDX-License-Identifier: MIT
#include "retarget/MotionSteps.h"

#include <osgSkin/GlmTypes>

#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>

#include <cmath>
#include <cstddef>
#include <string>

namespace osgSkin {
namespace {

constexpr double kAboutUp = 0.22, kAboutFront = 0.12;
constexpr double kStill = 0.99999; ///< cosine of half of half a degree
const glm::dvec3 kUp(0.0, 1.0, 0.0);

/// Whether the joint turns on its parent between any two samples.
bool turns(const Motion& motion, int joint) {
    const auto j = static_cast<std::size_t>(joint);
    for (std::size_t f = 1; f < motion.frames; ++f)
        if (std::abs(glm::dot(motion.rotation(0, j), motion.rotation(f, j))) < kStill) return true;
    return motion.frames < 2;
}

/// The shortest rotation between two unit directions, as an axis times radians.
glm::dvec3 swing(const glm::dvec3& from, const glm::dvec3& to) {
    const glm::dvec3 axis = glm::cross(from, to);
    const double sine = glm::length(axis);
    if (sine < 1e-9) return glm::dvec3(0.0);
    return axis * (std::atan2(sine, glm::dot(from, to)) / sine);
}

} // namespace

CollarBones::CollarBones(const RetargetTarget& body, const Motion& motion) {
    const JointRoles& roles = body.map.rig;
    const int arms[] = {roles.joint("LeftUpperArm"), roles.joint("RightUpperArm")};
    if (arms[0] < 0 || arms[1] < 0) return;
    glm::dvec3 left = body.rig.centre(arms[0]) - body.rig.centre(arms[1]);
    left.y = 0.0;
    if (!(glm::length(left) > 0.0)) return;
    left = glm::normalize(left);
    _front = glm::cross(left, kUp);
    for (const int side : {0, 1}) {
        const std::string name = side == 0 ? "Left" : "Right";
        const int joint = roles.joint(name + "Collar");
        const int elbow = roles.joint(name + "LowerArm");
        if (joint < 0 || elbow < 0 || body.rig.joint(joint).parent < 0 ||
            body.driver(arms[side]) < 0)
            continue;
        if (body.driver(joint) >= 0 && turns(motion, body.driver(joint))) continue;
        const glm::dvec3 arm = body.rig.centre(elbow) - body.rig.centre(arms[side]);
        if (!(glm::length(arm) > 0.0)) continue;
        Collar collar{body.rig.joint(joint).parent,
                      arms[side],
                      {joint},
                      glm::normalize(arm),
                      glm::normalize((side == 0 ? left : -left) - kUp),
                      glm::dquat(1.0, 0.0, 0.0, 0.0)};
        for (std::size_t i = 0; i < collar.joints.size(); ++i)
            for (const int child : body.rig.children(collar.joints[i]))
                if (body.driver(child) < 0) collar.joints.push_back(child);
        collar.atRest = taken(collar, collar.arm);
        _collars.push_back(collar);
    }
}

glm::dquat CollarBones::taken(const Collar& collar, const glm::dvec3& arm) const {
    const glm::dvec3 turn = swing(collar.halfway, arm);
    const glm::dvec3 part =
        kAboutUp * glm::dot(turn, kUp) * kUp + kAboutFront * glm::dot(turn, _front) * _front;
    const double angle = glm::length(part);
    return angle > 0.0 ? glm::angleAxis(angle, part / angle) : glm::dquat(1.0, 0.0, 0.0, 0.0);
}

void CollarBones::follow(std::vector<glm::dquat>& world) const {
    for (const Collar& collar : _collars) {
        const glm::dquat& chest = world[static_cast<std::size_t>(collar.chest)];
        const glm::dvec3 arm =
            glm::conjugate(chest) * (world[static_cast<std::size_t>(collar.upperArm)] * collar.arm);
        const glm::dquat by =
            chest * taken(collar, arm) * glm::conjugate(collar.atRest) * glm::conjugate(chest);
        for (const int j : collar.joints) {
            glm::dquat& q = world[static_cast<std::size_t>(j)];
            q = glm::normalize(by * q);
        }
    }
}

} // namespace osgSkin
