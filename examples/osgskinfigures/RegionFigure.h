// SPDX-License-Identifier: MIT
#pragma once

#include "Tiles.h"

namespace figures {

class Body;

/// The paper's Fig. 1 with its caption: the regions of the skin.
Tile regionFigure(const Body& body);

} // namespace figures
