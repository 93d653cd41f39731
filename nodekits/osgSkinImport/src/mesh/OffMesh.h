// SPDX-License-Identifier: MIT
#ifndef OSGSKINIMPORT_MESH_OFFMESH_H
#define OSGSKINIMPORT_MESH_OFFMESH_H

#include "mesh/CornerMesh.h"

#include <osgDB/Options>

#include <string>

namespace osgSkin {

/// Reads an OFF file of text: vertices and their normals, colours and texture coordinates, in
/// single precision, and faces of any number of corners; faces' colours are ignored.
/// \param options may be null
/// \throw osgSkin::Error "PATH: what was expected".
CornerMesh readOffMesh(const std::string& path, const osgDB::Options* options);

} // namespace osgSkin

#endif
