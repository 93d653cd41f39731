// SPDX-License-Identifier: MIT
#pragma once

#include <osgSkinRig/RestSkeleton>

#include <assimp/scene.h>

#include <glm/gtc/quaternion.hpp>
#include <glm/mat4x4.hpp>

#include <string>
#include <vector>

namespace osgSkin {

/// The joints of an Assimp scene: what its first animation or its meshes' bones move, and the nodes
/// that connect them.
struct SceneSkeleton {
    RestSkeleton rest;
    std::vector<const aiNode*> nodes; ///< [joint]
    std::vector<glm::dmat4> bind;     ///< places the nodes' own frames in the bind pose, [joint]
    std::vector<glm::dquat> worldRotations; ///< the nodes' own frames in the bind pose, [joint]
    glm::dmat4 aboveRoot{1.0};              ///< places the root joint's parent node in the world
};

/// \throw osgSkin::Error with `path` where the scene has no joint, or joints of one name.
SceneSkeleton skeletonOf(const aiScene& scene, const std::string& path);

/// The turn of a matrix, without its scale.
glm::dquat rotationOf(const glm::dmat4& matrix);

} // namespace osgSkin
