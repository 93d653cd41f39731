// SPDX-License-Identifier: MIT
#ifndef OSGSKINIMPORT_MESH_FINISHMESH_H
#define OSGSKINIMPORT_MESH_FINISHMESH_H

#include "mesh/CornerMesh.h"

#include <osgSkinImport/ImportedMesh>
#include <osgSkinImport/ReadLimits>

#include <string>

namespace osgSkin {

/// Limits the number of vertices: each is bound and deformed, whether a face uses it or not.
/// \param mesh as read
/// \param path of a file that contains only the mesh
/// \param limits on its size
/// \throw osgSkin::Error if there are more than a file of this size may have
void checkVertices(const CornerMesh& mesh, const std::string& path, const ReadLimits& limits);

/// Limits the number of materials: each one that faces use becomes a separate drawable.
/// \throw osgSkin::Error if there are more than a file of this size may have
void checkMaterials(const CornerMesh& mesh, const std::string& path, const ReadLimits& limits);

/// Checks the whole mesh, computes missing normals and makes its parts.
/// \param read from the file
/// \param path of the file
/// \param limits say whether colours are merged
/// \throw osgSkin::Error with the file and the position in it
ImportedMesh finishMesh(CornerMesh read, const std::string& path, const ReadLimits& limits);

} // namespace osgSkin

#endif
