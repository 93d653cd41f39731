// SPDX-License-Identifier: MIT
#ifndef OSGSKINIMPORT_SAMPLETRACKS_H
#define OSGSKINIMPORT_SAMPLETRACKS_H 1

#include "assimp/SceneSkeleton.h"

#include <osgSkinRig/Motion>

#include <assimp/anim.h>

#include <string>

namespace osgSkin {

/// Samples an animation at equal steps, 30 a second or more, and at every key (see SampleGrid).
/// Rotations are brought into frames that are aligned with the world at rest, as a Motion has them.
///
/// Of positions, those of the root are used, or of the joint that rootMotionJoint() finds; moves of
/// others are left out, with a notice.
/// \throw osgSkin::Error with `path` where no track has a key, the keys' times make no sense, or
///        joints times frames are more than `mostSamples`.
Motion sampleTracks(const aiAnimation& animation, const SceneSkeleton& skeleton,
                    std::size_t mostSamples, const std::string& path);

} // namespace osgSkin

#endif
