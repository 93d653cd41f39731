// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_INSIDESKIN_H
#define OSGSKINBIND_INSIDESKIN_H

#include "mesh/WeldedMesh.h"

#include <cstdint>
#include <vector>

namespace osgSkin {

/// True where the skin winds around the point: the generalised winding number (Jacobson, Kavan &
/// Sorkine-Hornung 2013) is above one half. Needs no closed mesh, and takes either winding.
bool isInsideSkin(const WeldedMesh& mesh, const glm::dvec3& point);

/// The closed shells that a point is inside.
std::vector<std::uint32_t> shellsAround(const WeldedMesh& mesh, const glm::dvec3& point);

} // namespace osgSkin

#endif
