// SPDX-License-Identifier: MIT
#pragma once

#include "retarget/DrivenRig.h"

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
std::optional<BonePair> findBone(const DrivenRig& body, int j);

/// The rotations A that take the rig's rest bones to the motion's zero-pose bones, one a rig joint.
///
/// Trunk joints are not aligned. A limb joint whose bone has no direction in either skeleton takes
/// its parent's rotation, so that it does not rotate against the limb.
std::vector<glm::dquat> alignBones(const DrivenRig& body);

} // namespace osgSkin
