// SPDX-License-Identifier: MIT
#pragma once

#include "assimp/SceneBind.h"

#include <glm/mat4x4.hpp>

#include <vector>

struct aiMesh;

namespace osgSkin {

/// Of a mesh that was bound in another pose than the meshes that share its bones: where each vertex
/// goes in the pose that all are bound in, as its bones take it there, each by its weight.
///
/// \param toScene the mesh's place, as bind.mesh() has it
/// \return a matrix for each vertex, from the mesh's space into the scene's; none where `toScene`
///         is right for all, but for a thousandth of the mesh's size
std::vector<glm::dmat4> perVertexBindPose(const aiMesh& mesh, const glm::dmat4& toScene,
                                          const SceneBind& bind);

} // namespace osgSkin
