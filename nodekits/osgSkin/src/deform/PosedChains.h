// SPDX-License-Identifier: MIT
#pragma once

#include "model/SkinBlocks.h"

#include <osgSkin/Pose>
#include <osgSkin/SkinModel>

#include <bitset>
#include <cstddef>
#include <cstdint>

namespace osgSkin {

/// An angle of which each vertex takes a fraction. The smaller it is, the fewer terms its sine
/// needs.
struct KernelAngle {
    /// Up to 0.34, 0.9, pi / 2, pi and 2 pi.
    enum Range : std::int32_t { kSmall, kMedium, kLarge, kHalved, kQuartered };
    const float& value; ///< radians; half the angle where the range is kHalved, a quarter where
                        ///< kQuartered
    std::int32_t range;
};

/// The joints of a section in a pose.
///
/// In the frame (v, w x v, w) about the joint centre, with bend axis v and twist axis w, a partial
/// rotation is one in the plane of the first two axes (the twist) followed by one in the plane of
/// the last two (the bend).
struct KernelJoints {
    static constexpr std::size_t kMax = ChainPlan::kMaxJoints;

    KernelAngle bendOf(std::size_t joint) const { return {bend[joint], bendRange[joint]}; }
    KernelAngle twistOf(std::size_t joint) const { return {twist[joint], twistRange[joint]}; }

    float bend[kMax], twist[kMax]; ///< psi and phi, as KernelAngle has them
    std::int32_t bendRange[kMax], twistRange[kMax];
    float wholeBend[kMax], wholeTwist[kMax];      ///< psi and phi
    float azimuthCosine[kMax], azimuthSine[kMax]; ///< of v, in the joint's fixed frame
    float move[3][kMax];         ///< translation, in its frame; times the bend ratio
    float growth[kMax];          ///< scale less 1; times the bend ratio
    std::int32_t adjusted[kMax]; ///< whether either is not 0 and any group follows it in part
    bool anyAdjusted;            ///< whether any joint is
};

/// x -> scale * turn x + move: columns of the rotation, then the translation and the scale.
struct alignas(64) PosedMap {
    double column[4][4];
};

/// The maps of a plan's section in one pose. Only those in the plan are set.
struct PosedChains {
    /// Computes what the groups from `firstGroup` to before `endGroup`, all of one section, need.
    void set(const SkinModel& model, const Pose& pose, const ChainPlan::Section& section,
             std::size_t firstGroup, std::size_t endGroup) noexcept;

    /// The joints' full rotations, column by column.
    double turns[9][ChainPlan::kMaxJoints];
    PosedMap wide[ChainPlan::kWideMaps]; ///< by ChainPlan's indices
    KernelMap maps[ChainPlan::kMaps];    ///< by ChainPlan's indices
    KernelMap outs[ChainPlan::kMaxOuts];
    KernelJoints joints;
    bool scaled; ///< whether any joint is
};

/// Which of a section's maps are needed.
struct NeededMaps {
    std::bitset<ChainPlan::kMaxStates> states;
    std::bitset<ChainPlan::kMaxOuts> outs;
};

/// The arguments of multiplyOut().
struct ChainCall {
    const Pose& pose;
    const ChainPlan& plan;
    const ChainPlan::Section& section; ///< followed by the next one
    double smallMove;                  ///< SkinBlocks::smallMove
    const NeededMaps* needed;          ///< null: all
};

/// Computes a section's maps.
void multiplyOut(const ChainCall& call, PosedChains& chains) noexcept;

} // namespace osgSkin
