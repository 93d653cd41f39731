// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_CALIBRATE_H
#define OSGSKINBIND_CALIBRATE_H

#include "muscles/MuscleSkin.h"

namespace osgSkin {

/// Scales a spindle until the limb's girth is what it should be: as much of what it lifts as that
/// takes, and as much of what it lowers as leaves the volume as it is.
/// \param already what else lifts the skin meanwhile
/// \param amount of the spindle that is there at that girth, above 0
/// \param girth wanted
/// \return the whole spindle in rest units; empty where the limb has no girth or cannot grow
MuscleSkin::Heights calibrate(const MuscleSkin& skin, const MuscleSkin::Heights& spindle,
                              const MuscleSkin::Heights& already, double amount, double girth);

} // namespace osgSkin

#endif
