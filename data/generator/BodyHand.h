// SPDX-License-Identifier: MIT
#pragma once

#include "Sculpture.h"

namespace mannequin {

/// How the fingers stand.
struct HandStyle {
    double spread = 1;    ///< 0: parallel
    double blend = 0.004; ///< metres; at 0.02 they are one block with furrows, for coarse meshes
};

/// Adds the left hand to the left arm.
void sculptHand(Sculpture& arm, const HandStyle& style = {});

} // namespace mannequin
