// SPDX-License-Identifier: MIT
#pragma once

#include "chains/PosedChains.h"
#include "model/ChainPlan.h"

#include <osgSkin/Pose>

namespace osgSkin {

/// What multiplies a section out.
struct ChainCall {
    const Pose& pose;
    const ChainPlan& plan;
    const ChainPlan::Section& section;
    double smallMove;   ///< a joint's translation up to this is a rounding error
    const bool* needed; ///< of the section's steps; null: all are
};

/// By the best instructions that the machine has.
void multiplyOut(const ChainCall& call, PosedChains& chains) noexcept;

} // namespace osgSkin
