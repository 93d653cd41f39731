// SPDX-License-Identifier: MIT
#pragma once

#include "Sculpture.h"

namespace mannequin {

/// The left arm and hand, in world space.
Sculpture sculptArm();

} // namespace mannequin
