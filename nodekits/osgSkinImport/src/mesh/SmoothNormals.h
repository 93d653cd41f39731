// SPDX-License-Identifier: MIT
#ifndef OSGSKINIMPORT_SMOOTHNORMALS_H
#define OSGSKINIMPORT_SMOOTHNORMALS_H 1

#include <osgSkinRig/SkinMesh>

#include <glm/vec3.hpp>

#include <vector>

namespace osgSkin {

/// Normals at the corners, smooth over the skin and weighted by area. Vertices at one position
/// count as one, so that seams of texture coordinates do not show.
std::vector<glm::vec3> smoothNormals(const SkinMesh& mesh);

} // namespace osgSkin

#endif
