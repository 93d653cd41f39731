// SPDX-License-Identifier: MIT
#ifndef OSGSKINIMPORT_SCENE_SCENEMESH_H
#define OSGSKINIMPORT_SCENE_SCENEMESH_H

#include "mesh/CornerMesh.h"
#include "scene/SourceScene.h"

#include <osgDB/Options>

#include <string>

namespace osgSkin {

/// Makes one mesh of all that a scene shows, in the bind pose, with the skins' weights.
///
/// \param path of the file that the scene was read from; textures are looked for beside it
/// \throw osgSkin::Error as readObjMesh()
CornerMesh readSceneMesh(const SourceScene& scene, const std::string& path,
                         const osgDB::Options* options);

} // namespace osgSkin

#endif
