// SPDX-License-Identifier: MIT
#pragma once

#include "reference/SameSkeleton.h"

#include <osgSkinRig/JointRoles>
#include <osgSkinRig/Motion>

#include <optional>
#include <string>
#include <vector>

namespace osgSkin {

/// What the rotations of a motion are to be counted from, so that they mean something on another
/// body: a pose in which its actor stands.
struct StandingPose {
    /// The motion counted from that pose; nothing where its own zero pose serves.
    std::optional<Motion> counted;

    /// The rig is the motion's skeleton and neither rests standing: local rotations go over as they
    /// are.
    std::optional<SameSkeleton> copied;

    std::vector<std::string> notes; ///< what a person should hear of it
};

/// Finds it: the zero pose where the actor stands in it, as told by legs, trunk and hips; else the
/// rig's rest pose where the skeletons are one; else the tidiest of the samples in which he stands
/// (a calibration pose, if there is one).
/// \param motion in any zero pose
/// \param rig at rest
/// \param motionJoint [rig joint] which joint of the motion drives it, -1 for none
/// \param rigRoles what the rig's joints are
/// \param motionRoles what the motion's joints are
/// \throw osgSkin::Error where the actor stands nowhere
StandingPose findStandingPose(const Motion& motion, const RestSkeleton& rig,
                              const std::vector<int>& motionJoint, const JointRoles& rigRoles,
                              const JointRoles& motionRoles);

} // namespace osgSkin
