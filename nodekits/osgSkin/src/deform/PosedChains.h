// SPDX-License-Identifier: MIT
#pragma once

#include "model/SkinBlocks.h"

#include <osgSkin/Pose>
#include <osgSkin/SkinModel>

#include <bitset>
#include <cstddef>
#include <cstdint>

namespace osgSkin {

/// An angle of which each vertex takes its share. The smaller it is, the fewer terms its sine
/// needs.
struct KernelAngle {
    /// Up to 0.34, 0.9, pi / 2, pi and 2 pi.
    enum Range : std::int32_t { kSmall, kMedium, kLarge, kHalved, kQuartered };
    const float& value; ///< radians; half the angle where the range is kHalved, a quarter where
                        ///< kQuartered
    std::int32_t range;
};

/// What joints do in the present pose, whatever chain they are in.
///
/// In the frame (v, w x v, w) about the joint centre, with bend axis v and twist axis w, the
/// partial turn is a turn in the plane of the first two axes (by the twist) followed by one in the
/// plane of the last two (by the bend).
struct KernelJoints {
    static constexpr std::size_t kMost = ChainPlan::kMostJoints;

    KernelAngle bendOf(std::size_t joint) const { return {bend[joint], bendRange[joint]}; }
    KernelAngle twistOf(std::size_t joint) const { return {twist[joint], twistRange[joint]}; }

    float bend[kMost], twist[kMost]; ///< psi and phi, as KernelAngle has them
    std::int32_t bendRange[kMost], twistRange[kMost];
    float wholeBend[kMost], wholeTwist[kMost];      ///< psi and phi
    float azimuthCosine[kMost], azimuthSine[kMost]; ///< of v in the joint's fixed frame
    float move[3][kMost]; ///< the joint's translation, in its frame; comes in with the bend ratio
    float growth[kMost];  ///< the joint's scale less 1; the same
    std::int32_t adjusted[kMost]; ///< these are not 0, and something follows the joint in part
    bool anyAdjusted;             ///< of all joints, whatever their number
};

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
