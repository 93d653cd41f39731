// SPDX-License-Identifier: MIT
#pragma once

#include "chains/KernelJoints.h"
#include "model/ChainPlan.h"
#include "points/KernelMap.h"

#include <osgSkin/Pose>
#include <osgSkin/SkinModel>

#include <cstddef>

namespace osgSkin {

/// x -> scale * turn x + move, while full turns are being multiplied out: columns of the turn, then
/// the move with the scale behind it. Turns are rotations.
struct alignas(64) PosedMap {
    double column[4][4];
};

/// The maps of a plan's section in one pose. Only what the section has is ever set.
struct PosedChains {
    /// Works out what the groups from `firstGroup` to before `endGroup` need, which are of one
    /// section.
    void set(const SkinModel& model, const Pose& pose, const ChainPlan::Section& section,
             std::size_t firstGroup, std::size_t endGroup) noexcept;

    /// The joints' full turns, column after column.
    double turns[9][ChainPlan::kMostJoints];
    PosedMap wide[ChainPlan::kWideMaps]; ///< by ChainPlan's indices
    KernelMap maps[ChainPlan::kMaps];    ///< the same
    KernelMap outs[ChainPlan::kMostOuts];
    KernelJoints joints;
    bool scaled; ///< any joint is
};

} // namespace osgSkin
