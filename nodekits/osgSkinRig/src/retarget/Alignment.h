// SPDX-License-Identifier: MIT
#pragma once

#include "skeleton/SkeletonTree.h"

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

#include <optional>
#include <vector>

namespace osgSkin {

/// A bone in both skeletons, from the joint to its end in their zero poses.
struct BonePair {
    glm::dvec3 rig;
    glm::dvec3 motion;
};

/// The bone of rig joint `j`, which the motion drives: to a joint below that both skeletons have,
/// or else each to its own end. Nothing where either has no length.
/// \param motionJoint for each rig joint, the motion joint that drives it, or -1
std::optional<BonePair> findBone(const SkeletonTree& rig, const SkeletonTree& motion,
                                 const std::vector<int>& motionJoint, int j);

/// The turns A that take the rig's rest bones to the motion's zero-pose bones, one a rig joint.
///
/// Trunk joints are not aligned. A limb joint whose bone has no direction in either skeleton takes
/// its parent's turn, so that it does not turn against the limb.
/// \param motionJoint for each rig joint, the motion joint that drives it, or -1
std::vector<glm::dquat> alignBones(const SkeletonTree& rig, const SkeletonTree& motion,
                                   const std::vector<int>& motionJoint);

/// The shortest turn that takes the direction `from` to `to`; neither is zero.
glm::dquat shortestTurn(const glm::dvec3& from, const glm::dvec3& to);

} // namespace osgSkin
