// SPDX-License-Identifier: MIT
#pragma once

#include "retarget/JointPairs.h"
#include "skeleton/SkeletonTree.h"

#include <glm/gtc/quaternion.hpp>

namespace osgSkin {

/// How a motion's space lies to a rig's, told by both skeletons' rest poses.
///
/// Up is the coordinate axis along which the thighs stand, or trunk and shins, where they agree and
/// the body sits; left is from the right hip to the left one, or else between the shoulders. Both
/// need the roles of joints: a skeleton without them is taken to have +y up, and one without pairs
/// to face as the other does.
struct UprightFrames {
    glm::dquat rigUpright{1.0, 0.0, 0.0, 0.0}; ///< takes the rig's space to one with +y up

    /// Takes the motion's space to that one too, so that both skeletons face the same way.
    glm::dquat motionUpright{1.0, 0.0, 0.0, 0.0};
};

/// Finds them. A skeleton without roles of its own has those of the joints that it is mapped to.
UprightFrames findUprightFrames(const SkeletonTree& rig, const SkeletonTree& motion,
                                const JointPairs& map);

/// The skeleton in a space that `rotation` takes its own to.
RestSkeleton rotated(const RestSkeleton& skeleton, const glm::dquat& rotation);

} // namespace osgSkin
