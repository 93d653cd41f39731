// SPDX-License-Identifier: MIT
#pragma once

#include "CornerMesh.h"

#include <osgSkin/MeshPart>

#include <vector>

namespace osgSkin {

/// Normals at the corners, smooth over the skin and weighted by area. Vertices at one position
/// count as one, so that seams of texture coordinates do not show.
std::vector<glm::vec3> smoothNormals(const SkinMesh& mesh);

/// Builds a drawable part for each material in use. A vertex is copied where its corners differ in
/// normal, texture coordinates or colour.
std::vector<MeshPart> makeMeshParts(const CornerMesh& source);

} // namespace osgSkin
