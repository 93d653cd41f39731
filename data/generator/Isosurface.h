// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "ImplicitBody.h"
#include "SkinMesh.h"

namespace mannequin {

/// Skin of the body by marching tetrahedra on a grid of the given spacing: closed and manifold by
/// construction, but fine and full of slivers.
SkinMesh isosurface(const ImplicitBody& body, double spacing);

} // namespace mannequin
