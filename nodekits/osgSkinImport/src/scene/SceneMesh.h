// SPDX-License-Identifier: MIT
#ifndef OSGSKINIMPORT_SCENE_SCENEMESH_H
#define OSGSKINIMPORT_SCENE_SCENEMESH_H

#include "mesh/CornerMesh.h"
#include "scene/SourceScene.h"

#include <osgDB/Options>

#include <string>

namespace osgSkin {

/// Merges all meshes of a scene into one, in the bind pose, with the skins' weights.
///
/// \param scene to read
/// \param path of the scene's file; textures are searched for in its folder
/// \param options may be null
/// \throw osgSkin::Error like readObjMesh()
CornerMesh readSceneMesh(const SourceScene& scene, const std::string& path,
                         const osgDB::Options* options);

} // namespace osgSkin

#endif
