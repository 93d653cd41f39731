// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_FIT_SOLID_CLOSEDSHELLS_H
#define OSGSKINBIND_FIT_SOLID_CLOSEDSHELLS_H

#include "mesh/WeldedMesh.h"

#include <array>
#include <vector>

namespace osgSkin::fit {

/// A closed surface that may cross itself, its corners in turn.
using ClosedShell = std::vector<std::array<glm::dvec3, 3>>;

/// The pieces of a mesh that are wound alike, each closed: seams are stitched, and holes covered by
/// fans about their middle. How often such a shell winds about a point is a whole number, whatever
/// flaws the mesh has.
///
/// \param mesh of any number of shells
/// \param triangles those of the mesh that count
/// \return one for each piece that has a face
std::vector<ClosedShell> closedShells(const WeldedMesh& mesh,
                                      const std::vector<std::array<std::uint32_t, 3>>& triangles);

} // namespace osgSkin::fit

#endif
