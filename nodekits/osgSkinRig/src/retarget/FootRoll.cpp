// SPDX-License-Identifier: MIT
#include "retarget/FootRoll.h"

#include "retarget/Alignment.h"

#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>

#include <cmath>

namespace osgSkin {
namespace {

/// The angle of `rotation` about a unit `axis`, -pi..pi: the twist that is left after the swing.
double rollAbout(const glm::dvec3& axis, const glm::dquat& rotation) {
    const double sine = glm::dot(axis, glm::dvec3(rotation.x, rotation.y, rotation.z));
    return rotation.w < 0.0 ? 2.0 * std::atan2(-sine, -rotation.w)
                            : 2.0 * std::atan2(sine, rotation.w);
}

} // namespace

FootRoll::FootRoll(const DrivenRig& body, const std::vector<glm::dquat>& alignment)
    : _rig(body.rig), _rolledOver(alignment.size(), 0) {
    for (const int ankle : body.rigParts.ankles) {
        const auto j = static_cast<std::size_t>(ankle);
        if (body.driver(ankle) < 0) continue;
        const auto bone = findBone(body, ankle);
        if (!bone || !(glm::length(bone->motion) > 0.0)) continue;
        _feet.push_back({ankle, glm::conjugate(alignment[j]) * glm::normalize(bone->motion)});
    }
}

void FootRoll::straighten(std::vector<glm::dquat>& world) {
    for (const Foot& foot : _feet) {
        const auto j = static_cast<std::size_t>(foot.joint);
        const glm::dquat& shin = world[static_cast<std::size_t>(_rig.joint(foot.joint).parent)];
        const double roll = rollAbout(foot.length, glm::conjugate(shin) * world[j]);
        const double beyond = std::abs(roll) - glm::half_pi<double>();
        if (!(beyond > 0.0)) continue;
        ++_rolledOver[j];
        const glm::dquat back =
            glm::angleAxis(std::copysign(2.0 * beyond, -roll), world[j] * foot.length);
        rotate(foot.joint, back, world);
    }
}

void FootRoll::rotate(int joint, const glm::dquat& by, std::vector<glm::dquat>& world) const {
    glm::dquat& own = world[static_cast<std::size_t>(joint)];
    own = glm::normalize(by * own);
    for (const int child : _rig.children(joint)) rotate(child, by, world);
}

} // namespace osgSkin
