// SPDX-License-Identifier: MIT
#pragma once

#include "Tiles.h"

namespace figures {

class Body;

/// The paper's Fig. 4 with its caption: the thrower.
Tile throwFigure(Body& body);

} // namespace figures
