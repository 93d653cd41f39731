// SPDX-License-Identifier: MIT
#ifndef OSGSKINIMPORT_SCENESKELETON_H
#define OSGSKINIMPORT_SCENESKELETON_H 1

#include <osgSkinImport/ReadLimits>
#include <osgSkinRig/RestSkeleton>

#include "scene/SourceScene.h"

#include <glm/gtc/quaternion.hpp>
#include <glm/mat4x4.hpp>

#include <set>
#include <string>
#include <vector>

namespace osgSkin {

class SceneBind;

/// The joints of a scene: what its first animation or its meshes' bones move, and the nodes
/// that connect them.
struct SceneSkeleton {
    RestSkeleton rest;
    std::vector<const SourceNode*> nodes; ///< [joint]
    std::vector<glm::dmat4> bind; ///< from the nodes' own frames to the scene, in the bind pose
    std::vector<glm::dquat> worldRotations; ///< of `bind`, [joint]
    glm::dmat4 aboveRoot{1.0};              ///< from the root joint's parent node to the scene
};

/// The nodes that are joints: bones and what moves above or below them. Other things that move
/// beside a skin (a camera, a door) are not; without a skin, all that moves is a joint.
std::set<const SourceNode*> jointNodes(const SourceScene& scene, const SceneBind& bind);

/// Reads the joints, in the bind pose.
/// \throw osgSkin::Error with `path` where the scene has no joint, more than are allowed, or
///        joints of one name.
SceneSkeleton readSceneSkeleton(const SourceScene& scene, const std::string& path,
                                const ReadLimits& limits);

} // namespace osgSkin

#endif
