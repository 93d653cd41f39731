// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_PACKSHAPES_H
#define OSGSKINBIND_PACKSHAPES_H

#include "shapes/ShapeFit.h"

#include <osgSkin/Correctives>

#include <vector>

namespace osgSkin {

/// The joints' shapes as a binding's correctives. Vertices that no bend moves by more than the
/// shapes' tolerance are left out, and so are joints without modes; of the others' last modes those
/// that together move them by no more are 0.
/// \param weldedOf the welded vertex of each vertex that is bound
Correctives packShapes(const std::vector<FittedShapes>& joints,
                       const std::vector<std::uint32_t>& weldedOf);

} // namespace osgSkin

#endif
