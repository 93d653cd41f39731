// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "ImplicitBody.h"
#include "SkinMesh.h"

namespace mannequin {

/// Triangulates the body's skin by marching tetrahedra on a grid of the given spacing in metres.
/// The mesh is closed and manifold by construction, but dense and full of slivers.
SkinMesh isosurface(const ImplicitBody& body, double spacing);

} // namespace mannequin
