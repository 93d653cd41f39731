// SPDX-License-Identifier: MIT
#pragma once

#include "retarget/JointPairs.h"

#include <string>
#include <vector>

namespace osgSkin {

/// What a person should hear of a map: arms, legs or hips that nothing drives or that drive
/// nothing, though they are there, and skeletons of no known family of which less than half
/// matches. What the caller's own map leaves at rest is no news.
std::vector<std::string> notesOf(const JointPairs& map, const RestSkeleton& rig,
                                 const RestSkeleton& motion, const RetargetOptions& options);

} // namespace osgSkin
