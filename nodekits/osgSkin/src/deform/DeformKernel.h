// SPDX-License-Identifier: MIT
#pragma once

#include "model/ChainPlan.h"
#include "model/SkinBlocks.h"
#include "pose/LinkTilt.h"

#include <cmath>
#include <cstddef>
#include <cstdint>

namespace osgSkin {

/// What rounding errors are taken as: their products would be denormal numbers, which processors
/// are many times slower with.
inline float roundedToFloat(double x) {
    return static_cast<float>(std::fabs(x) < 1e-15 ? 0.0 : x);
}

/// x -> turn x + move, in single precision, as the kernel reads it: columns of the turn, then the
/// move. Behind that by how much positions are to be scaled before.
struct alignas(64) KernelMap {
    float column[4][4];

    const float& turn(std::size_t row, std::size_t at) const { return column[at][row]; }
    const float& move(std::size_t row) const { return column[3][row]; }
    const float& scale() const { return column[3][3]; }
};

/// An angle of which each vertex takes its share. The smaller it is, the fewer terms its sine
/// needs.
struct KernelAngle {
    /// Up to 0.34, 0.9, pi / 2, pi and 2 pi.
    enum Range : std::int32_t { kSmall, kMedium, kLarge, kHalved, kQuartered };
    const float& value; ///< radians; half the angle where the range is kHalved, a quarter where
                        ///< kQuartered
    std::int32_t range;

    double whole() const {
        return double(value) * (range == kQuartered ? 4.0 : range == kHalved ? 2.0 : 1.0);
    }
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
    float azimuthCosine[kMost], azimuthSine[kMost]; ///< of v in the joint's fixed frame
    float move[3][kMost]; ///< the joint's translation, in its frame; comes in with the bend ratio
    float growth[kMost];  ///< the joint's scale less 1; the same
    std::int32_t adjusted[kMost]; ///< these are not 0
    bool anyAdjusted;             ///< of all joints, whatever their number
};

/// A partial joint of a group's chain: its number, and the map from its frame to that of the next
/// partial joint outwards, or to rest space.
using KernelLink = ChainPlan::Link;

/// What the growth of a link's ratios along the skin does to directions along it, by the numbers
/// that GradientBlocks has of it.
struct KernelSlope {
    LinkTilt tilt;
    float bend;  ///< psi, in units of those numbers
    float twist; ///< phi, the same
    float step;  ///< 1, the same; set where the link is adjusted
};

/// The correctives of one joint on a range of a group's blocks, see Correctives.
struct KernelCorrection {
    const std::int16_t* shares; ///< of the range's first block: x, y, z of the block's vertices for
                                ///< each mode
    const std::int16_t* normalShares; ///< the same of normals; null where they have none
    std::size_t blockShares;          ///< from a block's shares to the next one's
    const std::int16_t* tilts; ///< of the range's first block: along u and v for each mode; null
                               ///< where the model has not both normal correctives and gradients
    const float* tiltUnits;    ///< of each block
    std::size_t firstBlock;    ///< of the call's
    std::size_t blockCount;
    std::size_t modes;
    const float* weights;       ///< of each mode, for its shares
    const float* normalWeights; ///< for its shares of normals
};

/// All vertices of one group, with the constants that they have in common.
struct KernelCall {
    const BlockRow* rows;
    const BlockRow* tangentRows; ///< SkinModelAccess::blocks(); where tangents is not null
    std::size_t vertexCount;
    const KernelJoints* joints;
    const KernelMap* outs;
    std::size_t linkCount;   ///< partial links
    const KernelLink* links; ///< outermost first
    const KernelMap* lead;   ///< applied first; null where the blocks are in a joint's frame

    /// Whether a link's joint is moved or scaled, or joints further out are scaled.
    bool isAdjusted(const KernelLink& link) const {
        return joints->anyAdjusted &&
               (joints->adjusted[link.joint] != 0 || outs[link.out].scale() != 1.0f);
    }

    const KernelCorrection* corrections; ///< what is added to rest positions before all else
    std::size_t correctionCount;
    const KernelMap* correctionFrame; ///< turns it into the blocks' frame; null: rest space
    /// GradientBlocks' rows, for normals and tangents of the deformed surface; null: they turn as
    /// their vertices do.
    const std::int16_t* gradients;
    const BlockAcross* across; ///< GradientBlocks'; where gradients is not null
    const KernelSlope* slopes; ///< of each of `links`
    std::size_t lastSlope;     ///< of the outermost link that tilts normals
    float* positions;          ///< x, y, z of the group's first vertex
    float* normals;            ///< may be null
    float* tangents;           ///< x, y, z, w; may be null; null where normals is
    std::size_t room;          ///< vertices from there on that may be overwritten, >= vertexCount
    const std::uint32_t* scatter; ///< vertex of each row, where output is not in order; else null
};

/// Deforms a group with the best instructions that the machine has.
///
/// Without scatter, up to `room` vertices may be written beyond the group's: call in the groups'
/// order. With it, the outputs are those of vertex 0.
void runKernel(const KernelCall& call) noexcept;

} // namespace osgSkin
