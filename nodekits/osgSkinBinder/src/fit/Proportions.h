// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBINDER_FIT_PROPORTIONS_H
#define OSGSKINBINDER_FIT_PROPORTIONS_H

#include "fit/PlacedJoints.h"

/// Positions of joints that the skin does not show, in heights unless stated otherwise.
///
/// Segment lengths: R. Drillis & R. Contini, *Body Segment Parameters* (1966), as reprinted in
/// D. A. Winter, *Biomechanics and Motor Control of Human Movement*, 4th ed. (2009), Fig. 4.1.
/// Fractions of sections are rounded means over the rigs of three bodies. Shoulders, hips, knees
/// and ankles are where those of five captured people rotate on average (tests/quality/PEOPLE.md).
namespace osgSkin::proportions {

inline constexpr double kUpperArm = 0.186;
inline constexpr double kForeArm = 0.146;
inline constexpr double kHand = 0.108;
inline constexpr double kThigh = 0.245;
inline constexpr double kShin = 0.246;
inline constexpr double kAnkleHeight = 0.039;
inline constexpr double kHipHeight = 0.530;
inline constexpr double kShoulderHeight = 0.818;
inline constexpr double kNeckHeight = 0.870; ///< where the neck is thinnest, under the chin

// Trunk.
inline constexpr double kHipAboveCrotch = 0.064;
inline constexpr double kHipsAboveHip = 0.006; ///< the root joint above the hip joints
inline constexpr double kNeckBelowThinnest = 0.017;
inline constexpr double kHeadAboveThinnest = 0.043;
/// Fractions of the height from Hips to Neck, and of the depth from the back to the front of the
/// trunk: the spine runs near the back.
inline constexpr double kLowerBackUp = 0.10, kLowerBackDepth = 0.31;
inline constexpr double kSpineUp = 0.365, kSpineDepth = 0.27;
inline constexpr double kSpine1Up = 0.64, kSpine1Depth = 0.24;
inline constexpr double kHipsDepth = 0.49;
inline constexpr double kHipDepth = 0.60; ///< of the hip joints, in front of Hips
inline constexpr double kNeckDepth = 0.42, kNeck1Depth = 0.42, kHeadDepth = 0.30;

// Arms. The shoulder joint is above the armpit, at a fraction of the height up to the top of the
// shoulder, inside and ahead of the section's middle.
inline constexpr double kShoulderUp = 0.69;
inline constexpr double kShoulderInside = 0.021, kShoulderAhead = 0.010;
inline constexpr double kCollarAside = 0.016; ///< inner end of the collar bone
inline constexpr double kCollarDepth = 0.70;
inline constexpr double kWristBeyondThinnest = 0.008;
/// Fractions of the distance from wrist to finger tip.
inline constexpr double kThumb = 0.25, kFingerBase = 0.40, kFingers = 0.74;
inline constexpr double kThumbAside = 0.022;

// Legs.
inline constexpr double kKneeAboveThinnest = 0.025;  ///< over the hollow between thigh and calf
inline constexpr double kAnkleBelowThinnest = 0.029; ///< under the thinnest section of the shin
inline constexpr double kToeBase = 0.75;             ///< fraction of the distance from heel to toes
inline constexpr double kToeBaseHeight = 0.012;

} // namespace osgSkin::proportions

namespace osgSkin {

/// \throw Error if no body has such proportions, as when a limb was measured together with another part
void checkProportions(const PlacedJoints& placed);

/// How far from a person's proportions the joints are, to compare measured surfaces: 0 for those of
/// Drillis & Contini (1966), above 1 hardly a person.
double oddity(const PlacedJoints& placed);

} // namespace osgSkin

#endif
