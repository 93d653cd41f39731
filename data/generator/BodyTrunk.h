// SPDX-License-Identifier: MIT
#pragma once

#include "Sculpture.h"

namespace mannequin {

/// The trunk, in world space.
Sculpture sculptTrunk();

} // namespace mannequin
