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

/// The joints of a scene: jointNodes(), and the nodes that connect them.
struct SceneSkeleton {
    RestSkeleton rest;
    std::vector<const SourceNode*> nodes; ///< [joint]
    std::vector<glm::dmat4> bind; ///< from the nodes' own frames to the scene, in the bind pose
    std::vector<glm::dquat> worldRotations; ///< of `bind`, [joint]
    glm::dmat4 aboveRoot{1.0};              ///< from the root joint's parent node to the scene
};

/// The joint nodes: bones, and nodes above or below them that are animated, constrained or sources
/// of constraints. Other animated nodes of a scene with a skin (a camera, a door) are not joints;
/// in a scene without a skin, all animated nodes are; in one without a mesh or a clip, all nodes.
std::set<const SourceNode*> jointNodes(const SourceScene& scene, const SceneBind& bind);

/// Finds the joints in the bind pose; no joint if the scene has none. Nothing is checked.
SceneSkeleton findSceneSkeleton(const SourceScene& scene);

/// Reads the joints in the bind pose, as findSceneSkeleton().
/// \throw osgSkin::Error with `path` if the scene has no joint, too many joints, or joints with the
///        same name.
SceneSkeleton readSceneSkeleton(const SourceScene& scene, const std::string& path,
                                const ReadLimits& limits);

} // namespace osgSkin

#endif
