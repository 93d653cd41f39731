// SPDX-License-Identifier: MIT
#pragma once

#include "Sculpture.h"

namespace mannequin {

/// The head and neck, in world space.
Sculpture sculptHead();

} // namespace mannequin
