// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_FIT_PLACEJOINTS_H
#define OSGSKINBIND_FIT_PLACEJOINTS_H

#include "FitBody.h"
#include "JointSheet.h"

namespace osgSkin {

/// Each places its part's joints into the sheet, and reads there what landmarks and earlier parts
/// said. Order: legs, trunk, arms, hands.
///
/// \throw Error where the part is not found and no landmarks stand in

void placeLeg(const FitBody& body, std::size_t side, JointSheet& sheet);

void placeTrunk(const FitBody& body, JointSheet& sheet);

void placeArm(const FitBody& body, std::size_t side, JointSheet& sheet);

/// Everything beyond the wrist.
void placeHand(const FitBody& body, std::size_t side, JointSheet& sheet);

/// A landmark of one side stands for both.
void mirrorLandmarks(JointSheet& sheet);

/// Makes left and right joints mirror images, landmarks excepted.
void symmetrise(JointSheet& sheet);

/// Refuses what no body looks like: a limb that was measured together with another part.
///
/// \throw Error with what was expected and found
void checkProportions(const JointSheet& sheet);

/// Moves joints that are outside the skin, or in it, to the nearest place a little inside.
///
/// \throw Error where a landmark is far outside
void pushInside(const FitBody& body, JointSheet& sheet, std::vector<std::string>& notes);

} // namespace osgSkin

#endif
