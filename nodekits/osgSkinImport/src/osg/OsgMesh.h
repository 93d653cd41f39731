// SPDX-License-Identifier: MIT
#ifndef OSGSKINIMPORT_OSGMESH_H
#define OSGSKINIMPORT_OSGMESH_H 1

#include "mesh/CornerMesh.h"

#include <osgDB/Options>

#include <string>

namespace osgSkin {

/// Reads the geometries of a file that osgDB reads.
/// \throw osgSkin::Error as readObjMesh()
CornerMesh readOsgMesh(const std::string& path, const osgDB::Options* options);

} // namespace osgSkin

#endif
