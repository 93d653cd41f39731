// SPDX-License-Identifier: MIT
#include <osgSkinRig/BodyDirections>

#include "skeleton/SkeletonTree.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <utility>

namespace osgSkin {

BodyDirections::BodyDirections(const JointRoles& roles, std::vector<glm::dvec3> centres)
    : _roles(&roles), _centres(std::move(centres)) {
    for (const glm::dvec3& centre : _centres)
        _minLength = std::max(_minLength, 1e-3 * glm::distance(centre, _centres.front()));
    glm::dvec3 trunk(0.0), thighs(0.0), shins(0.0);
    for (const std::string side : {"Left", "Right"}) {
        const std::string thigh = side + "UpperLeg", knee = side + "LowerLeg";
        thighs += between(knee, thigh);
        shins += between(side + "Foot", knee);
        glm::dvec3 top = between(thigh, "Neck");
        if (top == glm::dvec3(0.0)) top = between(thigh, "Head");
        if (top == glm::dvec3(0.0)) top = between(thigh, side + "UpperArm");
        trunk += top;
    }
    _trunk = nearAxis(trunk);
    _thighs = nearAxis(thighs);
    _shins = nearAxis(shins);
}

glm::dvec3 BodyDirections::between(const std::string& from, const std::string& to) const {
    const int a = _roles->joint(from), b = _roles->joint(to);
    if (a < 0 || b < 0) return glm::dvec3(0.0);
    const glm::dvec3 result =
        _centres[static_cast<std::size_t>(b)] - _centres[static_cast<std::size_t>(a)];
    const double length = glm::length(result);
    return length > _minLength ? result / length : glm::dvec3(0.0);
}

int BodyDirections::up(int expected) const {
    if (_trunk == expected || (_trunk != 0 && _trunk == _shins)) return _trunk;
    const bool isCurled = _trunk != 0 && _shins != 0 && _thighs != _trunk && _thighs != _shins;
    return isCurled ? 0 : _thighs;
}

} // namespace osgSkin
