// SPDX-License-Identifier: MIT
#pragma once

#include "ThrowKeys.h"

namespace mannequin {

/// Pelvis, thorax and head of the throw.
BodyKeys bodyKeys();

} // namespace mannequin
