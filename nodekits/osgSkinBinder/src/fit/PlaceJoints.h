// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBINDER_FIT_PLACEJOINTS_H
#define OSGSKINBINDER_FIT_PLACEJOINTS_H

#include "fit/PlacedJoints.h"
#include "fit/body/FitBody.h"

#include <cstddef>

namespace osgSkin {

// Each function places the joints of one part and keeps landmarks. It reads the joints that are
// placed already: call placeLeg() for both sides first, then placeTrunk(), placeArm() and
// placeHand(). Side 0 is the left one. They throw osgSkin::Error where the part is not found and
// its landmarks are not given.

void placeLeg(const FitBody& body, std::size_t side, PlacedJoints& placed);
void placeTrunk(const FitBody& body, PlacedJoints& placed);
void placeArm(const FitBody& body, std::size_t side, PlacedJoints& placed);

/// Thumb and fingers.
void placeHand(const FitBody& body, std::size_t side, PlacedJoints& placed);

} // namespace osgSkin

#endif
