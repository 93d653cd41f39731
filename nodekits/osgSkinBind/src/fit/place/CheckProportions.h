// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_FIT_PLACE_CHECKPROPORTIONS_H
#define OSGSKINBIND_FIT_PLACE_CHECKPROPORTIONS_H

#include "fit/place/PlacedJoints.h"

namespace osgSkin {

/// Refuses what no body looks like: a limb that was measured together with another part.
///
/// \throw Error with what was expected and found
void checkProportions(const PlacedJoints& placed);

/// How far from a person's proportions the joints are: 0 for those of Drillis & Contini (1966),
/// more than 1 for what hardly is one. For telling which of two measured surfaces is the body's.
double oddity(const PlacedJoints& placed);

} // namespace osgSkin

#endif
