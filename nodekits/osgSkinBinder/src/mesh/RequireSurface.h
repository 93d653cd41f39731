// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBINDER_MESH_REQUIRESURFACE_H
#define OSGSKINBINDER_MESH_REQUIRESURFACE_H

#include "mesh/WeldedMesh.h"

namespace osgSkin {

/// Rejects meshes that are not a surface: very many triangles for few vertices, or triangles
/// between random vertices. Sparse systems on a surface are solved in nearly linear time, since
/// few vertices separate its graph into halves; on other graphs they take minutes and gigabytes.
///
/// \throw osgSkin::Error with what was found
void requireSurface(const WeldedMesh& mesh);

} // namespace osgSkin

#endif
