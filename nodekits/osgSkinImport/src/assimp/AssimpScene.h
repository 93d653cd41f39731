// SPDX-License-Identifier: MIT
#ifndef OSGSKINIMPORT_ASSIMPSCENE_H
#define OSGSKINIMPORT_ASSIMPSCENE_H 1

#include <osgSkinImport/ReadLimits>

#include <assimp/Importer.hpp>
#include <assimp/scene.h>

#include <glm/gtc/quaternion.hpp>
#include <glm/mat4x4.hpp>

#include <string>

namespace osgSkin {

/// Name of a bool in a scene's metadata: the figure's front is -Z, in a format that has +Z.
constexpr char kFacesBackwards[] = "osgSkin:facesBackwards";

/// Whether Assimp has a reader for files with this name's extension.
bool assimpReads(const std::string& path);

/// Whether files with this name's extension hold meshes and nothing that would move them. Assimp is
/// not asked for a rig in them: it reads PLY files out of bounds, and loses memory of OBJ files.
bool holdsMeshesOnly(const std::string& path);

/// Reads a file as it is: nothing triangulated, joined or reordered. The importer owns the scene.
/// \throw osgSkin::Error with the file and Assimp's reason.
const aiScene& readAssimpScene(Assimp::Importer& importer, const std::string& path,
                               const ReadLimits& limits);

glm::dvec3 toGlm(const aiVector3D& v);
glm::dquat toGlm(const aiQuaternion& q);
glm::dmat4 toGlm(const aiMatrix4x4& m);

} // namespace osgSkin

#endif
