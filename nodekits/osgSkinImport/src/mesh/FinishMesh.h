// SPDX-License-Identifier: MIT
#ifndef OSGSKINIMPORT_MESH_FINISHMESH_H
#define OSGSKINIMPORT_MESH_FINISHMESH_H

#include "mesh/CornerMesh.h"

#include <osgSkinImport/ImportedMesh>
#include <osgSkinImport/ReadLimits>

#include <string>

namespace osgSkin {

/// Limits the number of vertices: each is bound and deformed, whether a face names it or not.
/// \param path of a file that holds the mesh alone
/// \throw osgSkin::Error where there are more than a file of this size may have
void checkVertices(const CornerMesh& mesh, const std::string& path, const ReadLimits& limits);

/// Limits the number of materials: each that faces use becomes a drawable of its own.
/// \throw osgSkin::Error where there are more than a file of this size may have
void checkMaterials(const CornerMesh& mesh, const std::string& path, const ReadLimits& limits);

/// Checks a mesh as a whole, completes its normals and makes its parts.
/// \throw osgSkin::Error with the file and the place in it
ImportedMesh finishMesh(CornerMesh read, const std::string& path);

} // namespace osgSkin

#endif
