// SPDX-License-Identifier: GPL-3.0-or-later
#include "joints/BodyAxes.h"

#include <glm/geometric.hpp>

#include <algorithm>

namespace osgSkin {
namespace {

/// The largest ratio of a collar bone's length to the upper arm's. For hips, whose bone is the
/// thigh, the ratio is about 1.
constexpr double kCollarLength = 0.8;
/// The same if exactly an upper arm, a forearm and a hand follow. An upper arm whose forearm has
/// two bones is twice as long as the first of them.
constexpr double kCollarLengthBeforeArm = 1.3;

/// A chain is long from this length on, over the mesh's size: longer than a hand with its fingers
/// or a foot, and shorter than an arm.
constexpr double kLongChain = 0.18;

/// True if the joint's bone and one more lead to a hand.
bool isUpperArm(const std::vector<PlannedJoint>& joints, const PlannedJoint& joint) {
    if (joint.child < 0) return false;
    const int end = joints[static_cast<std::size_t>(joint.child)].child;
    return end >= 0 && joints[static_cast<std::size_t>(end)].part == JointPart::Hand;
}

bool isCollarBone(const std::vector<PlannedJoint>& joints, std::size_t index) {
    const PlannedJoint& joint = joints[index];
    if (joint.kind != JointKind::Limb || joint.parent < 0 || joint.child < 0 || joint.rigid >= 0)
        return false;
    const PlannedJoint& next = joints[static_cast<std::size_t>(joint.child)];
    const PlannedJoint& above = joints[static_cast<std::size_t>(joint.parent)];
    if (!above.isOfTrunk() || next.rigid >= 0 || !carries(joints, index, JointPart::Hand))
        return false;
    if (joint.part == JointPart::Collar) return true;
    // An upper arm behind its collar bone is not one, even if its forearm is long.
    if (above.isCollarBone() && isUpperArm(joints, joint)) return false;
    const double most = isUpperArm(joints, next) ? kCollarLengthBeforeArm : kCollarLength;
    return joint.boneLength < most * next.boneLength;
}

/// The distance from a collar bone's joint to the first upper arm below it, else to its bone's end.
double distanceToArm(const std::vector<PlannedJoint>& joints, const PlannedJoint& collar) {
    for (int j = collar.child; j >= 0; j = joints[static_cast<std::size_t>(j)].child)
        if (joints[static_cast<std::size_t>(j)].part == JointPart::UpperArm)
            return glm::distance(collar.centre, joints[static_cast<std::size_t>(j)].centre);
    return collar.boneLength;
}

} // namespace

void markTrunk(std::vector<PlannedJoint>& joints) {
    std::vector<int> ends(joints.size(), 0); // at or below each joint
    for (std::size_t j = 0; j < joints.size(); ++j) ends[j] = joints[j].isExtremity() ? 1 : 0;
    for (std::size_t j = joints.size(); j-- > 1;)
        ends[static_cast<std::size_t>(joints[j].parent)] += ends[j];
    for (std::size_t j = 0; j < joints.size(); ++j)
        if (ends[j] > 1) joints[j].kind = JointKind::Spine;
    for (std::size_t j = 0; j < joints.size(); ++j)
        if (isCollarBone(joints, j)) {
            joints[j].kind = JointKind::CollarBone;
            joints[j].armDistance = distanceToArm(joints, joints[j]);
        }
}

std::vector<bool> trunkByShape(const std::vector<PlannedJoint>& joints, double size) {
    std::vector<double> below(joints.size()); // the longest chain from each joint's centre
    std::vector<int> longChains(joints.size(), 0);
    std::vector<bool> trunk(joints.size());
    for (std::size_t j = joints.size(); j-- > 0;) {
        below[j] = std::max(below[j], joints[j].boneLength);
        trunk[j] = trunk[j] || joints[j].isOfTrunk() || longChains[j] > 1;
        if (joints[j].parent < 0) continue;
        const auto parent = static_cast<std::size_t>(joints[j].parent);
        if (trunk[j]) trunk[parent] = true;
        if (below[j] > kLongChain * size) ++longChains[parent];
        below[parent] = std::max(below[parent],
                                 glm::distance(joints[parent].centre, joints[j].centre) + below[j]);
    }
    for (std::size_t j = 1; j < joints.size(); ++j) {
        if (trunk[j] || joints[j].child < 0) continue;
        const double next = joints[static_cast<std::size_t>(joints[j].child)].boneLength;
        if (longChains[static_cast<std::size_t>(joints[j].parent)] > 1 &&
            joints[j].boneLength < kCollarLength * next)
            trunk[j] = true;
    }
    return trunk;
}

glm::dvec3 facing(const std::vector<PlannedJoint>& joints) {
    glm::dvec3 sum(0.0);
    for (const PlannedJoint& joint : joints) {
        if (joint.part != JointPart::Foot || !(joint.boneLength > 0.0)) continue;
        // Feet slope, so only the component perpendicular to the shin is used.
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
