// SPDX-License-Identifier: MIT
#pragma once

#include "Sculpture.h"

namespace mannequin {

/// Adds the left hand to the left arm.
void sculptHand(Sculpture& arm);

} // namespace mannequin
