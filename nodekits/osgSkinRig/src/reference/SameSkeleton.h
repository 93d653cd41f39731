// SPDX-License-Identifier: MIT
#pragma once

#include <osgSkinRig/RestSkeleton>

#include <glm/gtc/quaternion.hpp>

#include <optional>
#include <vector>

namespace osgSkin {

/// That a motion's skeleton is the rig's own, though both may rest in different poses: the same
/// tree, names and bones, each seen in its joint's own frame (RestJoint::frame).
struct SameSkeleton {
    double scale; ///< from the motion's unit to the rig's

    /// [motion joint] the rotations that take the motion's zero pose to the rig's rest pose.
    std::vector<glm::dquat> toRigRest;

    /// Nothing where it is another one.
    /// \param motionJoint [rig joint] which joint of the motion drives it, -1 for none
    static std::optional<SameSkeleton> find(const RestSkeleton& rig, const RestSkeleton& motion,
                                            const std::vector<int>& motionJoint);
};

} // namespace osgSkin
