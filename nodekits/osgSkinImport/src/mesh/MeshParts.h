// SPDX-License-Identifier: MIT
#ifndef OSGSKINIMPORT_MESHPARTS_H
#define OSGSKINIMPORT_MESHPARTS_H 1

#include "mesh/CornerMesh.h"

#include <osgSkinRig/MeshPart>

#include <vector>

namespace osgSkin {

/// Builds a drawable part for each material in use. A vertex is copied where its corners differ in
/// normal, texture coordinates or colour.
std::vector<MeshPart> makeMeshParts(const CornerMesh& source);

} // namespace osgSkin

#endif
