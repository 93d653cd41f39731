// SPDX-License-Identifier: GPL-3.0-or-later
#include "joints/BodyAxes.h"

#include <glm/geometric.hpp>

#include <algorithm>

namespace osgSkin {

glm::dvec3 facing(const std::vector<PlannedJoint>& joints) {
    glm::dvec3 sum(0.0);
    for (const PlannedJoint& joint : joints) {
        if (joint.part != JointPart::Foot || !(joint.boneLength > 0.0)) continue;
        // Feet slope: only what is across the shin counts.
        const glm::dvec3& shin = joint.comingFrom;
        sum += joint.boneAxis - shin * glm::dot(shin, joint.boneAxis);
    }
    return sum;
}

std::optional<BodyAxes> bodyAxes(const std::vector<PlannedJoint>& joints) {
    const auto head = std::find_if(joints.begin(), joints.end(), [](const PlannedJoint& joint) {
        return joint.part == JointPart::Head;
    });
    if (head == joints.end()) return std::nullopt;
    const glm::dvec3 spine = head->centre - joints.front().centre;
    const double height = glm::length(spine);
    if (!(height > 0.0)) return std::nullopt;
    BodyAxes axes;
    axes.up = spine / height;
    const glm::dvec3 feet = facing(joints);
    const glm::dvec3 front = feet - axes.up * glm::dot(axes.up, feet);
    const double length = glm::length(front);
    if (!(length > 1e-6)) return std::nullopt;
    axes.front = front / length;
    return axes;
}

bool carries(const std::vector<PlannedJoint>& joints, std::size_t joint, JointPart part) {
    const std::vector<bool> inside = subtreeOf(joints, joint);
    for (std::size_t j = joint; j < joints.size(); ++j)
        if (inside[j] && joints[j].part == part) return true;
    return false;
}

} // namespace osgSkin
