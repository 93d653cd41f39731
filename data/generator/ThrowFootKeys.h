// SPDX-License-Identifier: MIT
#pragma once

#include "ThrowKeys.h"

namespace mannequin {

FootKeys pivotFootKeys(); ///< the right foot
FootKeys leadFootKeys();  ///< the left foot

} // namespace mannequin
