// SPDX-License-Identifier: MIT
#pragma once

#include <osgSkinRig/Clip>
#include <osgSkinRig/JointRoles>
#include <osgSkinRig/RestSkeleton>

#include <cstddef>
#include <vector>

namespace osgSkin {

/// Shares out the twist that elbows and knees cannot show.
///
/// An elbow or a knee is a hinge, and its twist about its own bone is close to 0 on a living body.
/// A motion whose zero pose has another elbow axis than the rig leaves up to 180 degrees there,
/// where skin wrings, and pops as the angle changes its sign. A hinge keeps 90 degrees. The excess
/// goes to the joint above (shoulder or hip, about the upper bone) and to the one below (wrist or
/// ankle, about the hinge's bone), such that the larger of their two twists is as small as
/// possible. The bones' directions, the joints' positions and the world rotation of the hand or
/// foot, with all that hangs on it, stay as they are.
///
/// Twists are unwrapped over the clip, so that none of the three angles jumps where the hinge's
/// twist runs through 180 degrees. Beyond 270 degrees the shorter angle is taken again.
///
/// \param rig the clip's
/// \param roles of the rig's joints
/// \param clip changed in the samples in which a hinge has more than 90 degrees of twist, and to the
///        last bit the same in all others
/// \return for each joint, in how many samples its twist was shared out
std::vector<std::size_t> shareHingeTwist(const RestSkeleton& rig, const JointRoles& roles,
                                         Clip& clip);

} // namespace osgSkin
