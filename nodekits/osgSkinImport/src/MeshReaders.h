// SPDX-License-Identifier: MIT
#pragma once

#include "CornerMesh.h"

#include <osgSkinImport/ImportMesh>

#include <osgDB/Options>

#include <string>

struct aiScene;

namespace osgSkin {

/// The three ways to read a mesh file. Each throws osgSkin::Error with the file and the place in it
/// where the file is malformed; whether the mesh makes sense as a whole is for the caller to check.
CornerMesh readObjMesh(const std::string& path, const osgDB::Options* options);
CornerMesh readAssimpMesh(const std::string& path, const osgDB::Options* options);
CornerMesh readOsgMesh(const std::string& path, const osgDB::Options* options);

/// The meshes of a scene that Assimp has read.
CornerMesh meshOf(const aiScene& scene, const std::string& path, const osgDB::Options* options);

/// Checks a mesh as a whole, completes its normals and makes its parts. \throw osgSkin::Error
ImportedMesh finishMesh(CornerMesh read, const std::string& path);

/// Whether Assimp has a reader for files with this name's extension.
bool assimpReads(const std::string& path);

} // namespace osgSkin
