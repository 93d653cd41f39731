// SPDX-License-Identifier: MIT
#ifndef OSGSKINVIEWER_STANDINGHEIGHT_H
#define OSGSKINVIEWER_STANDINGHEIGHT_H 1

#include "Figure.h"

#include <cstddef>

namespace viewer {

/// How high a figure's floor is: where its feet are when they stand. That is the lowest point of
/// all that is drawn, in a tenth of a motion's samples: a jump does not lift the floor, and a foot
/// that dips into it for a moment does not lower it. At rest, the lowest point.
/// \param figure is left in some pose of the motion
/// \param motion index of one of its motions; passed over where it has none
/// \return z in the space of the figure's root
double standingHeight(const Figure& figure, std::size_t motion);

} // namespace viewer

#endif
