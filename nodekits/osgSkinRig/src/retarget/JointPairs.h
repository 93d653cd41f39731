// SPDX-License-Identifier: MIT
#pragma once

#include <osgSkinRig/JointRoles>
#include <osgSkinRig/RestSkeleton>
#include <osgSkinRig/Retarget>

#include <vector>

namespace osgSkin {

/// Which motion joint drives which rig joint.
struct JointPairs {
    std::vector<int> motionJoint; ///< [rig joint], -1 for none
    JointRoles rig, motion;
};

/// The caller's map comes first (an empty motion name leaves the joint at rest), then the joint of
/// the same role, as the skeletons' families of names have it, then the joint of equal name, unless
/// it is known to be another part of the body. Spines and necks of different length are stretched
/// over each other, end to end.
/// \throw osgSkin::Error where the map names a joint that is not there, or no joint matches.
JointPairs mapJoints(const RestSkeleton& rig, const RestSkeleton& motion,
                     const RetargetOptions& options);

} // namespace osgSkin
