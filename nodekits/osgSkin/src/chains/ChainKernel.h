// SPDX-License-Identifier: MIT
#pragma once

#include "chains/PosedChains.h"
#include "model/ChainPlan.h"

#include <osgSkin/Pose>

#include <bitset>

namespace osgSkin {

/// Which of a section's maps are needed.
struct NeededMaps {
    std::bitset<ChainPlan::kMostStates> states;
    std::bitset<ChainPlan::kMostOuts> outs;
};

/// What multiplies a section out.
struct ChainCall {
    const Pose& pose;
    const ChainPlan& plan;
    const ChainPlan::Section& section; ///< with the next one behind it
    double smallMove;                  ///< a joint's translation up to this is a rounding error
    const NeededMaps* needed;          ///< null: all are
};

/// By the best instructions that the machine has.
void multiplyOut(const ChainCall& call, PosedChains& chains) noexcept;

} // namespace osgSkin
