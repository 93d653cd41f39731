// SPDX-License-Identifier: MIT
#include "names/Sides.h"

#include <glm/geometric.hpp>

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace osgSkin {
namespace {

constexpr double kAlong = 0.85; ///< least cosine of the angle between bones that stand in one line
constexpr double kAhead = 0.5;  ///< least component of a foot towards the back

class Figure {
public:
    Figure(const RestSkeleton& skeleton, const JointRoles& roles)
        : _skeleton(skeleton), _roles(roles) {}

    /// The unit direction from one part to another; nothing where either is missing.
    std::optional<glm::dvec3> way(const std::string& from, const std::string& to) const {
        const auto a = _roles.joints.find(from), b = _roles.joints.find(to);
        if (a == _roles.joints.end() || b == _roles.joints.end()) return std::nullopt;
        const glm::dvec3 result = centre(b->second.front()) - centre(a->second.front());
        const double length = glm::length(result);
        if (!(length > 0.0)) return std::nullopt;
        return result / length;
    }

private:
    const glm::dvec3& centre(int joint) const {
        return _skeleton.joints[static_cast<std::size_t>(joint)].centre;
    }

    const RestSkeleton& _skeleton;
    const JointRoles& _roles;
};

std::string otherSide(const std::string& role) {
    if (role.rfind("Left", 0) == 0) return "Right" + role.substr(4);
    if (role.rfind("Right", 0) == 0) return "Left" + role.substr(5);
    return role;
}

} // namespace

bool areSidesExchanged(const RestSkeleton& skeleton, const JointRoles& roles) {
    const Figure figure(skeleton, roles);
    const auto up = figure.way("Hips", "Head");
    const auto left = figure.way("RightUpperLeg", "LeftUpperLeg");
    if (!up || !left) return false;
    const glm::dvec3 front = glm::cross(*left, *up);
    for (const std::string side : {"Left", "Right"}) {
        const auto thigh = figure.way(side + "LowerLeg", side + "UpperLeg");
        const auto shin = figure.way(side + "Foot", side + "LowerLeg");
        const auto foot = figure.way(side + "Foot", side + "Toe");
        if (!thigh || !shin || !foot) return false;
        if (glm::dot(*thigh, *up) < kAlong || glm::dot(*shin, *up) < kAlong) return false;
        if (glm::dot(*foot, front) > -kAhead) return false;
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
