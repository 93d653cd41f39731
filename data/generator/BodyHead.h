// SPDX-License-Identifier: MIT
#pragma once

#include "Sculpture.h"

namespace mannequin {

/// The head and neck in the world's frame.
Sculpture sculptHead();

} // namespace mannequin
