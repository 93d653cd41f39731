// SPDX-License-Identifier: MIT
#pragma once

#include "Sculpture.h"

namespace mannequin {

/// The left leg and foot, in world space.
Sculpture sculptLeg();

} // namespace mannequin
