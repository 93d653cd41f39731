// SPDX-License-Identifier: MIT
#include "names/Sides.h"

#include "skeleton/SkeletonTree.h"

#include <osgSkinRig/BodyDirections>

#include <glm/geometric.hpp>

#include <map>
#include <string>
#include <utility>
#include <vector>

namespace osgSkin {
namespace {

constexpr double kAlong = 0.85; ///< least cosine of the angle between bones that stand in one line
constexpr double kAhead = 0.5;  ///< least component of a foot towards the back

std::string otherSide(const std::string& role) {
    if (role.rfind("Left", 0) == 0) return "Right" + role.substr(4);
    if (role.rfind("Right", 0) == 0) return "Left" + role.substr(5);
    return role;
}

} // namespace

bool areSidesExchanged(const RestSkeleton& skeleton, const JointRoles& roles) {
    const BodyDirections body(roles, centresOf(skeleton));
    const glm::dvec3 up = body.between("Hips", "Head");
    const glm::dvec3 front = glm::cross(body.between("RightUpperLeg", "LeftUpperLeg"), up);
    for (const std::string side : {"Left", "Right"}) {
        const std::string knee = side + "LowerLeg", ankle = side + "Foot";
        if (glm::dot(body.between(knee, side + "UpperLeg"), up) < kAlong ||
            glm::dot(body.between(ankle, knee), up) < kAlong ||
            glm::dot(body.between(ankle, side + "Toe"), front) > -kAhead)
            return false;
    }
    return true;
}

void exchangeSides(JointRoles& roles) {
    for (std::string& role : roles.roles) role = otherSide(role);
    std::map<std::string, std::vector<int>> joints;
    for (auto& [role, list] : roles.joints) joints[otherSide(role)] = std::move(list);
    roles.joints = std::move(joints);
}

} // namespace osgSkin
