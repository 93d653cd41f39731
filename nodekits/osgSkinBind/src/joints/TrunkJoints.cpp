// SPDX-License-Identifier: GPL-3.0-or-later
#include "joints/TrunkJoints.h"

#include "joints/BodyAxes.h"

#include <glm/geometric.hpp>

namespace osgSkin {
namespace {

/// A collar bone's length over that of the upper arm, at most. Hips, whose bone is the thigh, have
/// about 1.
constexpr double kCollarLength = 0.8;
/// The same where just an upper arm, a forearm and a hand follow. An upper arm whose forearm has
/// two bones is twice as long as the first of them.
constexpr double kCollarLengthBeforeArm = 1.3;

/// True where the joint's bone and one more lead to a hand.
bool isUpperArm(const std::vector<PlannedJoint>& joints, const PlannedJoint& joint) {
    if (joint.child < 0) return false;
    const int end = joints[static_cast<std::size_t>(joint.child)].child;
    return end >= 0 && joints[static_cast<std::size_t>(end)].part == JointPart::Hand;
}

bool isCollarBone(const std::vector<PlannedJoint>& joints, std::size_t index) {
    const PlannedJoint& joint = joints[index];
    if (joint.trunk || joint.parent < 0 || joint.child < 0 || joint.rigid >= 0) return false;
    const PlannedJoint& next = joints[static_cast<std::size_t>(joint.child)];
    const PlannedJoint& above = joints[static_cast<std::size_t>(joint.parent)];
    if (!above.trunk || next.rigid >= 0 || !carries(joints, index, JointPart::Hand)) return false;
    if (joint.part == JointPart::Collar) return true;
    // An upper arm behind its collar bone is none, however long its forearm is.
    if (above.collarBone && isUpperArm(joints, joint)) return false;
    const double most = isUpperArm(joints, next) ? kCollarLengthBeforeArm : kCollarLength;
    return joint.boneLength < most * next.boneLength;
}

/// From a collar bone's joint to the first upper arm below it, else to its bone's end.
double distanceToArm(const std::vector<PlannedJoint>& joints, const PlannedJoint& collar) {
    for (int j = collar.child; j >= 0; j = joints[static_cast<std::size_t>(j)].child)
        if (joints[static_cast<std::size_t>(j)].part == JointPart::UpperArm)
            return glm::distance(collar.centre, joints[static_cast<std::size_t>(j)].centre);
    return collar.boneLength;
}

} // namespace

void markTrunk(std::vector<PlannedJoint>& joints) {
    std::vector<int> ends(joints.size(), 0); // at or below each joint
    for (std::size_t j = 0; j < joints.size(); ++j) ends[j] = joints[j].extremity ? 1 : 0;
    for (std::size_t j = joints.size(); j-- > 1;)
        ends[static_cast<std::size_t>(joints[j].parent)] += ends[j];
    for (std::size_t j = 0; j < joints.size(); ++j) joints[j].trunk = ends[j] > 1;
    for (std::size_t j = 0; j < joints.size(); ++j)
        if (isCollarBone(joints, j)) {
            joints[j].trunk = joints[j].collarBone = true;
            joints[j].armDistance = distanceToArm(joints, joints[j]);
        }
}

} // namespace osgSkin
