// SPDX-License-Identifier: MIT
#ifndef OSGSKINIMPORT_CHECKANIMATION_H
#define OSGSKINIMPORT_CHECKANIMATION_H 1

#include <osgAnimation/Animation>

#include <string>

namespace osgSkin {

/// Why OSG cannot play an animation: it looks a time up between the keys of each channel, and
/// believes that there are some, and in order. Empty: it can.
std::string whyNotPlayed(const osgAnimation::Animation& animation);

} // namespace osgSkin

#endif
