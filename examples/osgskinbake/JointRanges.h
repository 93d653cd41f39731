// SPDX-License-Identifier: MIT
#pragma once

#include <osgSkin/Binding>
#include <osgSkin/Pose>

#include <vector>

namespace bake {

/// Poses for a body without clips: each joint but the root alone, bent half way and all the way
/// through its range and twisted by up to 60 degrees both ways, then all joints together, in some
/// ways that are the same in each run.
///
/// The range of a joint with shapes is theirs: they are fitted to it. Others bend by 60 degrees to
/// all sides.
/// \param binding valid
std::vector<osgSkin::Pose> jointRanges(const osgSkin::Binding& binding);

} // namespace bake
