// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_REQUIRESURFACE_H
#define OSGSKINBIND_REQUIRESURFACE_H

#include "mesh/WeldedMesh.h"

namespace osgSkin {

/// Refuses meshes whose triangles make no surface: ones of few vertices, or between vertices at
/// random. Equations on a surface's vertices are solved within a time in proportion to its size,
/// since its graph falls apart into halves along few vertices; those on any other graph take
/// minutes, and gigabytes.
///
/// \throw osgSkin::Error with what was found
void requireSurface(const WeldedMesh& mesh);

} // namespace osgSkin

#endif
