// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "PosedMesh.h"

#include <osgSkin/SkinMesh>

#include <string>

namespace bake {

/// Writes the posed vertices and normals with the mesh's own faces, as bytes.
/// \throw osgSkin::Error where it cannot
void writePly(const std::string& file, const osgSkin::SkinMesh& mesh, const PosedMesh& posed);

} // namespace bake
