// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_FIT_PLACE_PLACETRUNK_H
#define OSGSKINBIND_FIT_PLACE_PLACETRUNK_H

#include "fit/body/FitBody.h"
#include "fit/place/PlacedJoints.h"

namespace osgSkin {

/// Places the joints of the trunk and reads what landmarks and the parts placed before it
/// say. Order: legs, trunk, arms, hands.
///
/// \param body the measured body
/// \param placed takes the joints
/// \throw Error where the part is not found and no landmarks stand in
void placeTrunk(const FitBody& body, PlacedJoints& placed);

} // namespace osgSkin

#endif
