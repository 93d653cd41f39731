// SPDX-License-Identifier: MIT
#pragma once

#include "model/SkinBlocks.h"
#include "pose/LinkTilt.h"

#include <cmath>
#include <cstddef>
#include <cstdint>

namespace osgSkin {

/// A constant four times over, so that 128-bit instructions can read it as an operand. Rounding
/// errors are taken as 0: their products would be denormal numbers, which processors are many times
/// slower with.
struct alignas(16) Splat {
    float value[4];

    /// What a constant is as a float.
    static float rounded(double x) {
        const double kept = std::fabs(x) < 1e-15 ? 0.0 : x;
        return static_cast<float>(kept);
    }

    void set(float x) {
        for (float& v : value) v = x;
    }

    Splat& operator=(double x) {
        set(rounded(x));
        return *this;
    }
};

/// x -> turn x + move, in single precision, as the kernel reads it.
struct KernelMap {
    Splat turn[3][3]; ///< [row][column]
    Splat move[3];
};

/// An angle of which each vertex takes its share. The smaller it is, the fewer terms its sine
/// needs.
struct KernelAngle {
    /// Up to 0.34, 0.9, pi / 2, pi and 2 pi.
    enum Range { kSmall, kMedium, kLarge, kHalved, kQuartered };
    Splat value; ///< radians; half the angle where the range is kHalved, a quarter where kQuartered
    Range range;

    KernelAngle& operator=(double angle) {
        const double size = angle < 0.0 ? -angle : angle;
        range = size <= 0.34     ? kSmall
                : size <= 0.9    ? kMedium
                : size <= 1.5708 ? kLarge
                : size <= 3.1416 ? kHalved
                                 : kQuartered;
        value = range == kQuartered ? 0.25 * angle : range == kHalved ? 0.5 * angle : angle;
        return *this;
    }
    double whole() const {
        return double(value.value[0]) * (range == kQuartered ? 4.0 : range == kHalved ? 2.0 : 1.0);
    }
};

/// One partial joint of a group's chain in the present pose.
///
/// In the frame (v, w x v, w) about the joint centre, with bend axis v and twist axis w, the
/// partial turn is a turn in the plane of the first two axes (by the twist) followed by one in the
/// plane of the last two (by the bend).
struct KernelLink {
    KernelAngle bend;  ///< psi
    KernelAngle twist; ///< phi
    bool adjusted;     ///< the joint is moved or scaled, or joints further out are scaled
    Splat move[3];     ///< the joint's translation, in its frame; comes in with the bend ratio
    Splat growth;      ///< the joint's scale less 1; the same
    Splat outScale;    ///< of positions, before `out`
    KernelMap out; ///< from this frame to that of the next partial joint outwards, or rest space
};

/// What the growth of a link's ratios along the skin does to directions along it, by the numbers
/// that GradientBlocks has of it.
struct KernelSlope {
    LinkTilt tilt;
    Splat bend;  ///< psi, in units of those numbers
    Splat twist; ///< phi, the same
    Splat step;  ///< 1, the same; set where the link is adjusted
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
    std::size_t linkCount;   ///< partial links
    const KernelLink* links; ///< outermost first
    const KernelMap* lead;   ///< applied first; null where the blocks are in a joint's frame
    Splat leadScale;         ///< of positions, before lead
    bool leadScaled;         ///< leadScale is not 1; else it is not set
    Splat azimuthCosine;     ///< of v in that frame; where lead is null
    Splat azimuthSine;
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
