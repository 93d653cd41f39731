// SPDX-License-Identifier: MIT
#include "reference/StandingCheck.h"

#include <osgSkin/Error>

#include <glm/geometric.hpp>

#include <string>

namespace osgSkin {
namespace {

constexpr double kUpOnFeet = 0.6; ///< leg lengths from feet to hips, of who stands
constexpr double kOnFloor = 0.25; ///< of who does not

} // namespace

StandingCheck::Legs::Legs(const JointRoles& roles) {
    const auto find = [&](const std::string& role) {
        const auto found = roles.joints.find(role);
        return found == roles.joints.end() ? -1 : found->second.front();
    };
    const std::string sides[] = {"Left", "Right"};
    for (int s = 0; s < 2; ++s) {
        upper[s] = find(sides[s] + "UpperLeg");
        lower[s] = find(sides[s] + "LowerLeg");
        foot[s] = find(sides[s] + "Foot");
    }
}

bool StandingCheck::Legs::complete() const {
    bool result = true;
    for (int s = 0; s < 2; ++s) result = result && upper[s] >= 0 && lower[s] >= 0 && foot[s] >= 0;
    return result;
}

double StandingCheck::Legs::height(const std::vector<glm::dvec3>& positions) const {
    double height = 0.0, length = 0.0;
    for (int s = 0; s < 2; ++s) {
        const glm::dvec3& hip = positions[static_cast<std::size_t>(upper[s])];
        const glm::dvec3& knee = positions[static_cast<std::size_t>(lower[s])];
        const glm::dvec3& ankle = positions[static_cast<std::size_t>(foot[s])];
        height += hip.y - ankle.y;
        length += glm::distance(hip, knee) + glm::distance(knee, ankle);
    }
    return length > 0.0 ? height / length : 0.0;
}

void StandingCheck::add(const std::vector<glm::dvec3>& rig, const std::vector<glm::dvec3>& motion) {
    if (!_rig.complete() || !_motion.complete() || _motion.height(motion) < kUpOnFeet) return;
    ++_standing;
    if (_rig.height(rig) < kOnFloor) ++_lying;
}

void StandingCheck::finish() const {
    if (2 * _lying <= _standing) return;
    throw Error("retarget: the rig's hips are as low as its feet in " + std::to_string(_lying) +
                " of the " + std::to_string(_standing) +
                " samples in which the actor stands; expected joints that match, in names, in the "
                "map and in how both skeletons rest");
}

} // namespace osgSkin
