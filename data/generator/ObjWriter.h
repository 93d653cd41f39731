// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "SkinMesh.h"

#include <iosfwd>
#include <string>

namespace mannequin {

/// Writes a mesh as Wavefront OBJ with smooth, area-weighted normals.
void writeObj(std::ostream& out, const SkinMesh& mesh, const std::string& name);

} // namespace mannequin
