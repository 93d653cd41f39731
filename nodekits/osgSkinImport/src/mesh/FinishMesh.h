// SPDX-License-Identifier: MIT
#pragma once

#include "mesh/CornerMesh.h"

#include <osgSkinImport/ImportMesh>

#include <string>

namespace osgSkin {

/// Checks a mesh as a whole, completes its normals and makes its parts. \throw osgSkin::Error
ImportedMesh finishMesh(CornerMesh read, const std::string& path);

} // namespace osgSkin
