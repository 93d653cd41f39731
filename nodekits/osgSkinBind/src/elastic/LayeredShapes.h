// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_ELASTIC_LAYEREDSHAPES_H
#define OSGSKINBIND_ELASTIC_LAYEREDSHAPES_H

#include "garments/SkinLayers.h"
#include "shapes/ShapeFit.h"

#include <cstddef>

namespace osgSkin {

/// Moves what lies on other skin, clothes, by a joint's shapes of the skin below: solved by itself
/// it would come apart from that by as much as both are solved differently.
///
/// \param welded the number of welded vertices
void followBelow(const SkinLayers& layers, std::size_t welded, FittedShapes& shapes);

} // namespace osgSkin

#endif
