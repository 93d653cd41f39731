// SPDX-License-Identifier: MIT
#include "reference/SameSkeleton.h"

#include <glm/geometric.hpp>

#include <cstddef>

namespace osgSkin {
namespace {

constexpr std::size_t kFewestBones = 5; ///< that are alike before two skeletons are one
constexpr double kTolerance = 0.02;     ///< how far bones differ in the sum, in their lengths' sum

std::size_t at(int joint) {
    return static_cast<std::size_t>(joint);
}

/// The offset of a joint from its parent, in the parent's own frame.
glm::dvec3 offset(const RestSkeleton& skeleton, int joint) {
    const RestJoint& own = skeleton.joints[at(joint)];
    const RestJoint& parent = skeleton.joints[at(own.parent)];
    return glm::conjugate(parent.frame) * (own.centre - parent.centre);
}

} // namespace

std::optional<SameSkeleton> SameSkeleton::find(const RestSkeleton& rig, const RestSkeleton& motion,
                                               const std::vector<int>& motionJoint) {
    SameSkeleton result{1.0, std::vector<glm::dquat>(motion.joints.size(), {1.0, 0.0, 0.0, 0.0})};
    std::vector<int> rigJoint(motion.joints.size(), -1);
    std::vector<glm::dvec3> ours, theirs;
    double ourLength = 0.0, theirLength = 0.0;
    for (std::size_t j = 0; j < rig.joints.size(); ++j) {
        const int driver = motionJoint[j];
        if (driver < 0) continue;
        if (rig.joints[j].name != motion.joints[at(driver)].name) return std::nullopt;
        rigJoint[at(driver)] = static_cast<int>(j);
        const int parent = rig.joints[j].parent;
        if (parent < 0 || motionJoint[at(parent)] < 0) continue;
        if (motion.joints[at(driver)].parent != motionJoint[at(parent)]) return std::nullopt;
        ours.push_back(offset(rig, static_cast<int>(j)));
        theirs.push_back(offset(motion, driver));
        ourLength += glm::length(ours.back());
        theirLength += glm::length(theirs.back());
    }
    if (ours.size() < kFewestBones || !(theirLength > 0.0)) return std::nullopt;
    result.scale = ourLength / theirLength;
    double difference = 0.0;
    for (std::size_t b = 0; b < ours.size(); ++b)
        difference += glm::distance(ours[b], result.scale * theirs[b]);
    if (!(difference <= kTolerance * ourLength)) return std::nullopt;

    for (std::size_t m = 0; m < motion.joints.size(); ++m) {
        const int j = rigJoint[m], parent = motion.joints[m].parent;
        if (j >= 0)
            result.toRigRest[m] =
                glm::normalize(rig.joints[at(j)].frame * glm::conjugate(motion.joints[m].frame));
        else if (parent >= 0)
            result.toRigRest[m] = result.toRigRest[at(parent)];
    }
    return result;
}

} // namespace osgSkin
