// SPDX-License-Identifier: MIT
#pragma once

#include "Subject.h"

namespace quality {

/// How rigid the middle third of one limb is: over its skin, the mean share of the bend.
struct LimbRigidity {
    std::string limb;
    std::size_t vertices = 0;
    double own = 0.0, next = 0.0;               ///< ours: of the bone's own joint and of the next
    double paintedOwn = 0.0, paintedNext = 0.0; ///< the same of the painted weights
};

/// Upper arms, forearms, thighs and shins, left and right; those that the rig does not have are
/// left out. A limb's skin is what the painted weights give to its bone most of all.
std::vector<LimbRigidity> measureRigidity(const Subject& subject);

} // namespace quality
