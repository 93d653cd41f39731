// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_FIT_PLACE_SYMMETRISE_H
#define OSGSKINBIND_FIT_PLACE_SYMMETRISE_H

#include "fit/place/PlacedJoints.h"

namespace osgSkin {

/// A landmark of one side stands for both.
void mirrorLandmarks(PlacedJoints& placed);

/// Makes left and right joints mirror images, landmarks excepted.
void symmetrise(PlacedJoints& placed);

} // namespace osgSkin

#endif
