// SPDX-License-Identifier: MIT
#ifndef OSGSKINIMPORT_ASSIMPMESH_H
#define OSGSKINIMPORT_ASSIMPMESH_H 1

#include "mesh/CornerMesh.h"

#include <osgDB/Options>

#include <string>

struct aiScene;

namespace osgSkin {

/// Reads the meshes of a file that Assimp reads.
/// \throw osgSkin::Error as readObjMesh()
CornerMesh readAssimpMesh(const std::string& path, const osgDB::Options* options);

/// The meshes of a scene that Assimp has read.
CornerMesh readSceneMesh(const aiScene& scene, const std::string& path,
                         const osgDB::Options* options);

} // namespace osgSkin

#endif
