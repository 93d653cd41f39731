// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_ELASTIC_PATCHCROSSINGS_H
#define OSGSKINBIND_ELASTIC_PATCHCROSSINGS_H

#include "elastic/lattice/SkinPatch.h"

namespace osgSkin::elastic {

/// Pairs of triangles that cut each other. A triangle that makes an edge of more than two is left
/// out.
/// \param positions of the corners that the triangles name
std::size_t countCrossings(const RestSkin::Triangles& triangles, const Points& positions);

} // namespace osgSkin::elastic

#endif
