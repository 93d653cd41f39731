// SPDX-License-Identifier: MIT
#pragma once

#include "names/BodyParts.h"
#include "retarget/JointPairs.h"
#include "skeleton/SkeletonTree.h"

#include <vector>

namespace osgSkin {

/// A rig and the motion that drives it, as retargeting looks at them: both skeletons standing with
/// +y up and facing the same way.
struct DrivenRig {
    /// \param uprightRig must outlive this
    /// \param uprightMotion must outlive this
    /// \param joints which joint drives which, and what the joints are; must outlive this
    DrivenRig(const RestSkeleton& uprightRig, const RestSkeleton& uprightMotion,
              const JointPairs& joints)
        : rig(uprightRig), motion(uprightMotion), map(joints),
          rigParts(findBodyParts(rig, map.rig)), motionParts(findBodyParts(motion, map.motion)) {}

    /// The motion joint that drives rig joint `j`, -1 for none.
    int driver(int j) const { return map.motionJoint[static_cast<std::size_t>(j)]; }

    SkeletonTree rig, motion;
    const JointPairs& map;
    BodyParts rigParts, motionParts;
};

} // namespace osgSkin
