// SPDX-License-Identifier: MIT
#pragma once

#include "Tiles.h"

namespace figures {

/// The paper's Fig. 2 with its caption: a rotation split into bend and twist.
Tile splitFigure();

} // namespace figures
