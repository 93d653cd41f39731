// SPDX-License-Identifier: MIT
#ifndef OSGSKINIMPORT_OBJMESH_H
#define OSGSKINIMPORT_OBJMESH_H 1

#include "mesh/CornerMesh.h"

#include <osgDB/Options>

#include <string>

namespace osgSkin {

/// Reads an OBJ file by tinyobjloader: vertices and faces in file order.
/// \throw osgSkin::Error with the file and the place in it where it is malformed; whether the mesh
///        makes sense as a whole is for the caller to check, as with the other readers
CornerMesh readObjMesh(const std::string& path, const osgDB::Options* options);

} // namespace osgSkin

#endif
