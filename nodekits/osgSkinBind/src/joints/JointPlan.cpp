// SPDX-License-Identifier: MIT
#include "joints/JointPlan.h"

#include <osgSkin/Error>
#include <osgSkin/ExpectedNames>
#include <osgSkinBind/RigidJoints>

#include <glm/geometric.hpp>

#include <algorithm>
#include <map>

namespace osgSkin {
namespace {

std::size_t at(int index) {
    return static_cast<std::size_t>(index);
}

/// The offset from the nearest ancestor that lies elsewhere; zero for the root.
glm::dvec3 offsetFromAbove(const RestSkeleton& skeleton, std::size_t joint, double tolerance) {
    for (int p = skeleton.joints[joint].parent; p >= 0; p = skeleton.joints[at(p)].parent) {
        const glm::dvec3 d = skeleton.joints[joint].centre - skeleton.joints[at(p)].centre;
        if (glm::length(d) > tolerance) return d;
    }
    return glm::dvec3(0.0);
}

std::vector<std::size_t> subtreeSizes(const RestSkeleton& skeleton) {
    std::vector<std::size_t> sizes(skeleton.joints.size(), 1);
    for (std::size_t j = skeleton.joints.size(); j-- > 1;)
        sizes[at(skeleton.joints[j].parent)] += sizes[j];
    return sizes;
}

/// The child that continues the chain. Of several, the thumb is the last choice. From the root it
/// is the one with the most joints (the spine, not a leg), elsewhere the one in the straightest
/// direction (the neck, not a collar bone).
int mainChild(const RestSkeleton& skeleton, std::size_t joint,
              const std::vector<std::size_t>& sizes, const std::vector<PlannedJoint>& planned,
              double tolerance) {
    const std::vector<int> children = skeleton.children(static_cast<int>(joint));
    const glm::dvec3 incoming = offsetFromAbove(skeleton, joint, tolerance);
    int best = -1;
    bool bestIsThumb = true;
    double bestScore = 0.0;
    for (const int child : children) {
        const glm::dvec3 toBoneEnd = planned[at(child)].boneEnd - skeleton.joints[joint].centre;
        const glm::dvec3 direct = skeleton.joints[at(child)].centre - skeleton.joints[joint].centre;
        const glm::dvec3 along = glm::length(direct) > tolerance ? direct : toBoneEnd;
        const double length = glm::length(along);
        const bool thumb = planned[at(child)].part == JointPart::Thumb;
        const double score = incoming == glm::dvec3(0.0)
                                 ? static_cast<double>(sizes[at(child)])
                                 : (length > tolerance ? glm::dot(along, incoming) / length : -2.0);
        if (best < 0 || (bestIsThumb && !thumb) || (bestIsThumb == thumb && score > bestScore)) {
            best = child;
            bestIsThumb = thumb;
            bestScore = score;
        }
    }
    return best;
}

/// Sets centre, parent, child, bone and axes of the joints. Centres closer than `tolerance` are one
/// point.
/// \pre the joints' parts are set
void setJointAxes(const RestSkeleton& skeleton, double tolerance,
                  std::vector<PlannedJoint>& joints) {
    const std::vector<std::size_t> sizes = subtreeSizes(skeleton);
    // Leaves first, since a bone without a length ends where its child's bone ends.
    for (std::size_t j = joints.size(); j-- > 0;) {
        const RestJoint& rest = skeleton.joints[j];
        PlannedJoint& joint = joints[j];
        joint.centre = rest.centre;
        joint.parent = rest.parent;
        joint.child = mainChild(skeleton, j, sizes, joints, tolerance);
        joint.boneEnd = rest.tip ? *rest.tip : rest.centre;
        if (joint.child >= 0) {
            const PlannedJoint& child = joints[at(joint.child)];
            joint.boneEnd = glm::distance(child.centre, joint.centre) > tolerance ? child.centre
                                                                                  : child.boneEnd;
        }
        joint.boneLength = glm::distance(joint.boneEnd, joint.centre);
    }
    for (std::size_t j = 0; j < joints.size(); ++j) {
        PlannedJoint& joint = joints[j];
        const PlannedJoint* parent = joint.parent >= 0 ? &joints[at(joint.parent)] : nullptr;
        if (joint.boneLength > tolerance)
            joint.boneAxis = (joint.boneEnd - joint.centre) / joint.boneLength;
        else
            joint.boneAxis = parent ? parent->boneAxis : glm::dvec3(0.0, 1.0, 0.0);
        const glm::dvec3 above = offsetFromAbove(skeleton, j, tolerance);
        joint.lengthAbove = glm::length(above);
        joint.comingFrom = joint.lengthAbove > 0.0 ? above / joint.lengthAbove : joint.boneAxis;
        joint.twistAxis = joint.poleIsParent ? joint.comingFrom : joint.boneAxis;
        joint.poleLength = joint.poleIsParent ? joint.lengthAbove : joint.boneLength;
    }
}

/// The topmost heads, hands and feet, in joint order. The root is never one of them.
std::vector<std::size_t> extremities(const RestSkeleton& skeleton, const JointRoles& roles) {
    std::vector<std::size_t> result;
    std::vector<bool> inside(skeleton.joints.size(), false);
    for (std::size_t j = 1; j < skeleton.joints.size(); ++j) {
        inside[j] = inside[at(skeleton.joints[j].parent)];
        if (inside[j]) continue;
        for (const JointPart part : {JointPart::Head, JointPart::Hand, JointPart::Foot})
            if (roles.is(j, part)) inside[j] = true;
        if (inside[j]) result.push_back(j);
    }
    return result;
}

/// For each joint the topmost rigid joint at or above it, or -1.
/// \throw osgSkin::Error if an option names a joint that does not exist
std::vector<int> rigidJoints(const RestSkeleton& skeleton, const BindOptions& options) {
    const std::map<std::string, int> jointOf = skeleton.byName();
    std::vector<bool> named(skeleton.joints.size(), false);
    for (const std::string& name :
         options.rigid ? *options.rigid : automaticRigidJoints(skeleton, options.names)) {
        const auto joint = jointOf.find(name);
        if (joint == jointOf.end())
            throw Error("bind: rigid joint \"" + name + "\" is not in the skeleton" +
                        expectedNames(name, jointOf));
        named[at(joint->second)] = true;
    }
    std::vector<int> result(skeleton.joints.size(), -1);
    for (std::size_t j = 0; j < result.size(); ++j) {
        const int parent = skeleton.joints[j].parent;
        if (parent >= 0) result[j] = result[at(parent)];
        if (result[j] < 0 && named[j]) result[j] = static_cast<int>(j);
    }
    return result;
}

bool hasParentPole(const JointBindOptions& options, JointPart part) {
    if (options.twistAxis == JointBindOptions::Pole::Automatic) return part == JointPart::Hand;
    return options.twistAxis == JointBindOptions::Pole::Parent;
}

} // namespace

std::vector<std::string> automaticRigidJoints(const RestSkeleton& skeleton,
                                              const std::vector<JointNames>& names,
                                              const std::vector<bool>& isMoved) {
    const JointRoles roles = recogniseJoints(skeleton, names);
    std::vector<std::string> result;
    for (const std::size_t joint : extremities(skeleton, roles)) {
        bool bends = false;
        for (std::size_t j = joint + 1; j < skeleton.joints.size() && !bends; ++j) {
            if (!skeleton.isInSubtree(static_cast<int>(j), static_cast<int>(joint))) continue;
            const bool isEnd = !skeleton.joints[j].tip && roles.roles[j].empty() &&
                               skeleton.children(static_cast<int>(j)).empty();
            const JointPart part = roles.parts[j];
            const bool isSame = part == JointPart::Head || part == JointPart::Hand ||
                                part == JointPart::Foot; // a hand below its wrist
            bends = !isEnd && !isSame && (isMoved.empty() || isMoved[j]);
        }
        if (!bends) result.push_back(skeleton.joints[joint].name);
    }
    return result;
}

std::vector<PlannedJoint> planAxes(const RestSkeleton& skeleton, const WeldedMesh& mesh,
                                   const JointRoles& roles, const BindOptions& options) {
    std::vector<PlannedJoint> joints(skeleton.joints.size());
    const std::vector<int> rigid = rigidJoints(skeleton, options);
    for (std::size_t j = 0; j < joints.size(); ++j) {
        joints[j].part = roles.parts[j];
        joints[j].rigid = rigid[j];
        const auto found = options.joints.find(skeleton.joints[j].name);
        if (found != options.joints.end()) joints[j].options = found->second;
        joints[j].poleIsParent =
            skeleton.joints[j].parent >= 0 && hasParentPole(joints[j].options, joints[j].part);
    }
    for (const std::size_t joint : extremities(skeleton, roles))
        joints[joint].kind = JointKind::Extremity;
    for (std::size_t j = 1; j < joints.size(); ++j) {
        const PlannedJoint& above = joints[at(skeleton.joints[j].parent)];
        if (joints[j].rigid < 0 && (above.isExtremity() || above.isDigit()))
            joints[j].kind = JointKind::Digit;
    }
    setJointAxes(skeleton, kCentreTolerance * mesh.size, joints);
    return joints;
}

std::vector<BoundJoint> boundJoints(const RestSkeleton& skeleton,
                                    const std::vector<PlannedJoint>& joints) {
    std::vector<BoundJoint> result;
    for (std::size_t j = 0; j < joints.size(); ++j)
        result.push_back({skeleton.joints[j].name, joints[j].parent, joints[j].centre,
                          joints[j].boneAxis, joints[j].twistAxis});
    return result;
}

} // namespace osgSkin
