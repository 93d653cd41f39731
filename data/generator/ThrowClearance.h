// SPDX-License-Identifier: MIT
#pragma once

#include "ThrowPose.h"

namespace mannequin {

/// Minimum gap in metres between limbs that could collide: forearms and hands with thighs, shins
/// and trunk, forearm with forearm, and shin with shin. The limbs are capsules about as thick as
/// the mannequin's skin; a negative gap is an overlap.
double limbClearance(const Skeleton& skeleton, const WorldPose& world);

} // namespace mannequin
