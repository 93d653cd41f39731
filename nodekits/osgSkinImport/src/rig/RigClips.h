// SPDX-License-Identifier: MIT
#ifndef OSGSKINIMPORT_RIGCLIPS_H
#define OSGSKINIMPORT_RIGCLIPS_H 1

#include "assimp/SceneSkeleton.h"

#include <osgAnimation/Animation>

#include <string>
#include <vector>

namespace osgSkin {

/// For each joint, whether some clip of the scene moves it.
std::vector<bool> movedJoints(const aiScene& scene, const SceneSkeleton& joints);

/// The scene's clips for the bones of makeBones(); clips that move no joint are left out.
/// \throw osgSkin::Error where a key is not finite
osgAnimation::AnimationList makeClips(const aiScene& scene, const SceneSkeleton& joints,
                                      std::size_t mostSamples, const std::string& path);

} // namespace osgSkin

#endif
