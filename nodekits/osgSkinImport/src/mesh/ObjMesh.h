// SPDX-License-Identifier: MIT
#ifndef OSGSKINIMPORT_OBJMESH_H
#define OSGSKINIMPORT_OBJMESH_H 1

#include "mesh/CornerMesh.h"

#include <osgDB/Options>

#include <string>

namespace osgSkin {

/// Reads an OBJ file and its material libraries: vertices and faces in file order, coordinates in
/// double precision. Lines end with LF, CR or both.
/// \param options may be null
/// \throw osgSkin::Error with the file and the line where it is malformed; the caller checks the
///        mesh as a whole, as with the other readers
CornerMesh readObjMesh(const std::string& path, const osgDB::Options* options);

} // namespace osgSkin

#endif
