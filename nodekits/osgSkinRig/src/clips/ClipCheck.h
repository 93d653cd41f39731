// SPDX-License-Identifier: MIT
#pragma once

#include <osgSkinRig/Clip>
#include <osgSkinRig/RestSkeleton>

namespace osgSkin {

/// Throws osgSkin::Error where the clip is empty, has no positive frame time, or was not made for a
/// rig of this many joints.
void requireFits(const Clip& clip, const RestSkeleton& rig);

/// The same where rotations are not unit, or the root is beyond -1e18 to 1e18.
void requireUsable(const Clip& clip, const RestSkeleton& rig);

} // namespace osgSkin
