// SPDX-License-Identifier: GPL-3.0-or-later
#include "TrunkJoints.h"

#include <osgSkinBind/Bind>

namespace osgSkin {
namespace {

/// A collar bone's length over that of the upper arm, at most. Hips, whose bone is the thigh, have
/// about 1.
constexpr double kCollarLength = 0.8;

bool isCollarBone(const std::vector<PlannedJoint>& joints, const PlannedJoint& joint) {
    if (joint.parent < 0 || joint.child < 0 || joint.rigid >= 0) return false;
    const PlannedJoint& next = joints[static_cast<std::size_t>(joint.child)];
    return joints[static_cast<std::size_t>(joint.parent)].trunk && next.rigid < 0 &&
           joint.boneLength < kCollarLength * next.boneLength;
}

} // namespace

void markTrunk(const RestSkeleton& skeleton, std::vector<PlannedJoint>& joints) {
    std::vector<int> ends(joints.size(), 0); // at or below each joint
    for (const std::string& name : automaticRigidJoints(skeleton)) {
        const auto joint = static_cast<std::size_t>(skeleton.find(name));
        joints[joint].extremity = true;
        ends[joint] = 1;
    }
    for (std::size_t j = joints.size(); j-- > 1;)
        ends[static_cast<std::size_t>(joints[j].parent)] += ends[j];
    for (std::size_t j = 0; j < joints.size(); ++j) joints[j].trunk = ends[j] > 1;
    for (std::size_t j = 0; j < joints.size(); ++j)
        if (!joints[j].trunk && isCollarBone(joints, joints[j])) joints[j].trunk = true;
}

} // namespace osgSkin
