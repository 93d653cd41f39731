// SPDX-License-Identifier: MIT
#pragma once

#include "assimp/SceneSkeleton.h"

#include <osgSkinRig/Motion>

#include <assimp/anim.h>

#include <string>

namespace osgSkin {

/// Samples an animation at equal steps, as many as its longest track has keys; for BVH these are
/// the file's own samples. Turns are brought into frames that are aligned with the world at rest.
///
/// Only the root moves from its place; moves of other joints are left out, with a notice. Where the
/// root has a single child that moves, as hips over a root on the ground do, the motion begins
/// with that joint, and so on down.
/// \throw osgSkin::Error with `path` where no track has a key, or the keys' times make no sense.
Motion sampleTracks(const aiAnimation& animation, const SceneSkeleton& skeleton,
                    const std::string& path);

} // namespace osgSkin
