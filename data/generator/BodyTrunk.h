// SPDX-License-Identifier: MIT
#pragma once

#include "Sculpture.h"

namespace mannequin {

/// The trunk in the world's frame.
Sculpture sculptTrunk();

} // namespace mannequin
