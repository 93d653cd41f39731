// SPDX-License-Identifier: MIT
#pragma once

#include "BvhWriter.h"
#include "ThrowMotion.h"

#include <vector>

namespace mannequin {

/// The ball's BVH rows, one per frame: in the hand up to the release frame, then free.
///
/// It is released with the hand's velocity, falls under gravity without drag, and bounces off the
/// floor y = 0. In the last frame of the loop it is in the hand again.
std::vector<BvhRow> ballRows(const Skeleton& skeleton, const ThrowMotion& motion);

} // namespace mannequin
