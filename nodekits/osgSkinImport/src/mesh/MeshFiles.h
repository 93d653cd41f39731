// SPDX-License-Identifier: MIT
#ifndef OSGSKINIMPORT_MESH_MESHFILES_H
#define OSGSKINIMPORT_MESH_MESHFILES_H

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

/// Reads a PLY file, text or binary: polygons or triangle strips, normals, colours, texture
/// coordinates, of vertices or of faces' corners, and the textures that comments name.
/// \param options may be null
/// \throw osgSkin::Error with the file and the place in it
CornerMesh readPlyMesh(const std::string& path, const osgDB::Options* options);

/// Reads an OFF file of text: vertices and their normals, colours and texture coordinates, in
/// single precision, and faces of any number of corners; faces' colours are ignored.
/// \param options may be null
/// \throw osgSkin::Error "PATH: what was expected".
CornerMesh readOffMesh(const std::string& path, const osgDB::Options* options);

} // namespace osgSkin

#endif
