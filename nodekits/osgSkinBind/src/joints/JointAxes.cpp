// SPDX-License-Identifier: GPL-3.0-or-later
#include "joints/JointAxes.h"

#include <glm/geometric.hpp>

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

/// The child that continues the chain. Where several do: not the thumb; from the root the one that
/// carries most joints (the spine, not a leg); elsewhere the one that goes straightest on (the
/// neck, not a collar bone).
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

} // namespace

void setJointAxes(const RestSkeleton& skeleton, double tolerance,
                  std::vector<PlannedJoint>& joints) {
    const std::vector<std::size_t> sizes = subtreeSizes(skeleton);
    // Leaves first: a bone without length ends where its child's bone ends.
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

} // namespace osgSkin
