// SPDX-License-Identifier: MIT
#pragma once

#include "retarget/PoseTransfer.h"
#include "retarget/Posture.h"
#include "retarget/RetargetTarget.h"

#include <osgSkinRig/Motion>
#include <osgSkinRig/RestSkeleton>
#include <osgSkinRig/Retarget>
#include <osgSkinRig/RetargetReport>

namespace osgSkin {

/// Fills a report in where local rotations are copied.
/// \param scale of the root motion
void reportCopied(const RotationCopy& copy, const Motion& motion, const RestSkeleton& rig,
                  const JointPairs& map, double scale, RetargetReport& report);

/// Fills a report in where bones are aligned, without what is measured of the feet.
void reportAligned(PoseTransfer& transfer, const Motion& motion, const RestSkeleton& rig,
                   RetargetReport& report);

/// Adds notes for a person to a report that was filled in: on the pose from which rotations are
/// counted, and on joints that do not match.
void addNotes(const StandingPose& pose, const JointPairs& map, const Motion& motion,
              const RestSkeleton& rig, const RetargetOptions& options, RetargetReport& report);

} // namespace osgSkin
