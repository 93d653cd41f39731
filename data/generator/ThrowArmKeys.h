// SPDX-License-Identifier: MIT
#pragma once

#include "ThrowKeys.h"

namespace mannequin {

ArmKeys throwingArmKeys(); ///< the right arm
ArmKeys gloveArmKeys();    ///< the left arm

} // namespace mannequin
