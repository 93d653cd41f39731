// SPDX-License-Identifier: MIT
#pragma once

#include "Tiles.h"

namespace figures {

class Body;

/// The paper's Fig. 3 with its caption: ratios along a limb.
Tile ratioFigure(const Body& body);

} // namespace figures
