// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_FIT_PLACE_PLACEHAND_H
#define OSGSKINBIND_FIT_PLACE_PLACEHAND_H

#include "fit/body/FitBody.h"
#include "fit/place/PlacedJoints.h"

#include <cstddef>

namespace osgSkin {

/// Places the joints of one hand (everything beyond the wrist) and reads what landmarks and the
/// parts placed before it say. Order: legs, trunk, arms, hands.
///
/// \param body the measured body
/// \param side 0 left, 1 right
/// \param placed takes the joints
/// \throw Error where the part is not found and no landmarks stand in
void placeHand(const FitBody& body, std::size_t side, PlacedJoints& placed);

} // namespace osgSkin

#endif
