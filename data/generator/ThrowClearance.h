// SPDX-License-Identifier: MIT
#pragma once

#include "ThrowPose.h"

namespace mannequin {

/// Least gap in metres between limbs that could run into each other: forearms and hands against
/// thighs, shins and trunk, the forearms against each other, and the shins. The limbs are taken as
/// capsules about as thick as the mannequin's skin; below 0 they overlap.
double limbClearance(const Skeleton& skeleton, const WorldPose& world);

} // namespace mannequin
