// SPDX-License-Identifier: MIT
#ifndef OSGSKINIMPORT_MESH_MESHFILES_H
#define OSGSKINIMPORT_MESH_MESHFILES_H

#include "mesh/CornerMesh.h"

#include <osgDB/Options>

#include <string>

namespace osgSkin {

/// Reads an OBJ file and its material libraries: vertices and faces in file order, coordinates in
/// double precision. Lines end with LF, CR or both.
/// \param path of the file
/// \param options may be null
/// \throw osgSkin::Error with the file and the line if it is malformed. As with the other readers,
///        the caller checks the mesh as a whole
CornerMesh readObjMesh(const std::string& path, const osgDB::Options* options);

/// Reads a PLY file, text or binary: polygons or triangle strips; normals, colours and texture
/// coordinates of vertices or face corners; and textures named in comments.
/// \param path of the file
/// \param options may be null
/// \throw osgSkin::Error with the file and the position in it
CornerMesh readPlyMesh(const std::string& path, const osgDB::Options* options);

/// Reads a text OFF file: vertices with their normals, colours and texture coordinates in single
/// precision, and faces with any number of corners. Face colours are ignored.
/// \param path of the file
/// \param options may be null
/// \throw osgSkin::Error "PATH: what was expected".
CornerMesh readOffMesh(const std::string& path, const osgDB::Options* options);

} // namespace osgSkin

#endif
