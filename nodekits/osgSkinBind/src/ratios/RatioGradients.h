// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_RATIOGRADIENTS_H
#define OSGSKINBIND_RATIOGRADIENTS_H

#include "mesh/WeldedMesh.h"

#include <osgSkin/Binding>

#include <vector>

namespace osgSkin {

/// How the ratios of partial influences grow along the skin: the one of each triangle, where it is
/// linear, as the normals of triangles make those of vertices, by area. 0 for influences that are
/// not partial and vertices without triangles.
/// \param binding of the mesh as given, whose vertices `mesh` has welded
/// \return for each of the binding's influences
std::vector<RatioGradient> ratioGradients(const WeldedMesh& mesh, const Binding& binding);

} // namespace osgSkin

#endif
