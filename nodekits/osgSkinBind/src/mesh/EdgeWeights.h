// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_EDGEWEIGHTS_H
#define OSGSKINBIND_EDGEWEIGHTS_H

#include "mesh/WeldedMesh.h"

#include <vector>

namespace osgSkin {

/// Cotangent weight of each edge, one for each entry of `mesh.neighbours`, so each edge twice.
///
/// Always positive: weights that obtuse or degenerate triangles would make negative or huge are
/// clamped. So values that are spread with them stay in the range that they came from.
std::vector<double> edgeWeights(const WeldedMesh& mesh);
/// The same for a skin that isn't welded from anything, with neighbours as WeldedMesh has them.
std::vector<double> edgeWeights(const std::vector<glm::dvec3>& positions,
                                const std::vector<std::array<std::uint32_t, 3>>& triangles,
                                const std::vector<std::uint32_t>& firstNeighbour,
                                const std::vector<std::uint32_t>& neighbours);

/// How much harder it is to go from one neighbour to the other because a crease lies between: 1
/// where the skin is flat or convex, much more where it is concave.
///
/// Parts of a body meet in creases (Hoffman & Richards 1984): jaw, armpit, groin.
double creaseFactor(const WeldedMesh& mesh, std::uint32_t from, std::uint32_t to);

} // namespace osgSkin

#endif
