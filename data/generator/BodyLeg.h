// SPDX-License-Identifier: MIT
#pragma once

#include "Sculpture.h"

namespace mannequin {

/// The left leg with its foot, in the world's frame.
Sculpture sculptLeg();

} // namespace mannequin
