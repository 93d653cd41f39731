// SPDX-License-Identifier: MIT
#pragma once

#include "chains/KernelJoints.h"
#include "chains/KernelMap.h"
#include "model/ChainPlan.h"
#include "model/SkinBlocks.h"
#include "pose/LinkTilt.h"

#include <cmath>
#include <cstddef>
#include <cstdint>

namespace osgSkin {

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
    const float* tilts; ///< of the range's first block: along u and v for each mode; null where the
                        ///< model has not both normal correctives and gradients
    std::size_t firstBlock; ///< of the call's
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
