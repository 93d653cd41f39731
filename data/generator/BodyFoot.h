// SPDX-License-Identifier: MIT
#pragma once

#include "Sculpture.h"

namespace mannequin {

/// Adds the left foot to the left leg.
void sculptFoot(Sculpture& leg);

} // namespace mannequin
