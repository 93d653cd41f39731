// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_FIT_PLACE_PUSHINSIDE_H
#define OSGSKINBIND_FIT_PLACE_PUSHINSIDE_H

#include "fit/body/FitBody.h"
#include "fit/place/PlacedJoints.h"

#include <string>
#include <vector>

namespace osgSkin {

/// Moves joints that are outside the skin, or in it, to the nearest position a little inside.
///
/// \throw Error where a landmark is far outside
void pushInside(const FitBody& body, PlacedJoints& placed, std::vector<std::string>& notes);

} // namespace osgSkin

#endif
