// SPDX-License-Identifier: MIT
#pragma once

#include "Sculpture.h"

namespace mannequin {

/// The left arm with its hand, in the world's frame.
Sculpture sculptArm();

} // namespace mannequin
