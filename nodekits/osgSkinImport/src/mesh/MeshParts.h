// SPDX-License-Identifier: MIT
#pragma once

#include "mesh/CornerMesh.h"

#include <osgSkin/MeshPart>

#include <vector>

namespace osgSkin {

/// Builds a drawable part for each material in use. A vertex is copied where its corners differ in
/// normal, texture coordinates or colour.
std::vector<MeshPart> makeMeshParts(const CornerMesh& source);

} // namespace osgSkin
