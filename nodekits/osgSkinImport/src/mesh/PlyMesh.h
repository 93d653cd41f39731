// SPDX-License-Identifier: MIT
#ifndef OSGSKINIMPORT_MESH_PLYMESH_H
#define OSGSKINIMPORT_MESH_PLYMESH_H

#include "mesh/CornerMesh.h"

#include <osgDB/Options>

#include <string>

namespace osgSkin {

/// Reads a PLY file, text or binary: polygons or triangle strips, normals, colours, texture
/// coordinates, of vertices or of faces' corners, and the textures that comments name.
/// \throw osgSkin::Error with the file and the place in it
CornerMesh readPlyMesh(const std::string& path, const osgDB::Options* options);

} // namespace osgSkin

#endif
