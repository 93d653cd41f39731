// SPDX-License-Identifier: MIT
#ifndef OSGSKINIMPORT_FINISHMESH_H
#define OSGSKINIMPORT_FINISHMESH_H 1

#include "mesh/CornerMesh.h"

#include <osgSkinImport/ImportedMesh>

#include <string>

namespace osgSkin {

/// Checks a mesh as a whole, completes its normals and makes its parts.
/// \throw osgSkin::Error with the file and the place in it
ImportedMesh finishMesh(CornerMesh read, const std::string& path);

} // namespace osgSkin

#endif
