// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_FIT_SURFACE_CLOSEDSURFACE_H
#define OSGSKINBIND_FIT_SURFACE_CLOSEDSURFACE_H

#include "fit/solid/SolidGrid.h"
#include "fit/surface/SurfaceMesh.h"
#include "mesh/WeldedMesh.h"

#include <string>
#include <vector>

namespace osgSkin::fit {

/// The shell with the largest area, oriented, its holes closed.
///
/// \param mesh whose shells are looked at
/// \param notes gets one line for each thing that was left out or closed
/// \throw Error where that does not give one closed surface
Mesh largestSurface(const WeldedMesh& mesh, std::vector<std::string>& notes);

/// The surface around what all shells enclose together, pieces that lie near each other joined.
///
/// \param filled by the mesh's shells
/// \param mesh whose shells they are
/// \param notes gets a line that tells so
/// \throw Error where nothing is enclosed
Mesh unionSurface(const SolidGrid& filled, const WeldedMesh& mesh, std::vector<std::string>& notes);

} // namespace osgSkin::fit

#endif
