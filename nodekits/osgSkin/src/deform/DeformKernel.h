// SPDX-License-Identifier: MIT
#pragma once

#include "deform/PosedChains.h"
#include "model/CorrectiveBlocks.h"
#include "model/GradientBlocks.h"
#include "model/SkinBlocks.h"
#include "pose/CorrectiveWeights.h"

#include <cstddef>
#include <cstdint>

namespace osgSkin {

/// linkTilt() of consecutive links, without translations and scales: a bit for each.
struct LinkTilts {
    static constexpr std::size_t kMax = 1024;

    /// \param links of joints of the section
    /// \param reach of each of them
    /// \param count at most kMax
    void find(const ChainPlan::Link* links, const GradientBlocks::Reach* reach, std::size_t count,
              const KernelJoints& joints) noexcept;

    std::uint16_t bends[kMax / 16 + 1], twists[kMax / 16 + 1]; ///< padded by one

    /// The bits of `count` links, at most SkinModel::kMaxPartialInfluences.
    static std::uint32_t some(const std::uint16_t* bits, std::size_t first, std::size_t count) {
        const std::uint32_t from = bits[first / 16] | std::uint32_t(bits[first / 16 + 1]) << 16;
        return from >> first % 16 & ((1u << count) - 1);
    }
};

/// A partial joint of a group's chain: its number, and the map from its frame to that of the next
/// partial joint outwards, or to rest space.
using KernelLink = ChainPlan::Link;

/// Groups to deform, and their common arguments.
struct KernelRun {
    const SkinBlocks* blocks;
    const BlockRow* rows;            ///< the blocks', or these with morphed vertices
    const BlockRow* morphTilts;      ///< MorphedRest::tilts(); may be null
    const SkinBlocks::Group* groups; ///< the first one; for a part of a group, a copy
    std::size_t groupCount;
    std::size_t firstGroup;      ///< the index of the first one
    std::size_t skippedBlocks;   ///< the blocks of the first group before its part
    const BlockRow* tangentRows; ///< SkinModelAccess::blocks(); where tangents is not null
    const KernelJoints* joints;
    const KernelMap* outs;
    const CorrectiveBlocks* corrections;              ///< null where the model has none
    const CorrectiveWeights::Weights* const* weights; ///< of all joints that these groups name
    const GradientBlocks* gradients;                  ///< null: normals rotate as vertices do
    const LinkTilts* tilts;                           ///< of the plan's links from firstTilt on
    std::size_t firstTilt;
    const float* bendSlopes;      ///< psi of each joint, in units of the gradients
    const float* twistSlopes;     ///< phi, the same
    float slopeUnit;              ///< the unit of the gradients
    float* positions;             ///< x, y, z of vertex 0
    float* normals;               ///< may be null
    float* tangents;              ///< x, y, z, w; may be null; null where normals is
    std::size_t endVertex;        ///< without scatter: vertices before this one may be overwritten
    const std::uint32_t* scatter; ///< the model's order(); null where output is in order
};

/// A group and the constants of its vertices.
struct KernelCall {
    const BlockRow* rows;
    const BlockRow* tangentRows; ///< SkinModelAccess::blocks(); where tangents is not null
    std::size_t vertexCount;
    const KernelJoints* joints;
    const KernelMap* outs;
    std::size_t linkCount;   ///< partial links
    const KernelLink* links; ///< outermost first
    const KernelMap* lead;   ///< applied first; null where the blocks are in a joint's frame

    bool isTiltedByBend(const KernelLink& link) const {
        return (bendTilts >> (&link - links) & 1u) != 0;
    }
    bool isTiltedByTwist(const KernelLink& link) const {
        return (twistTilts >> (&link - links) & 1u) != 0;
    }

    /// Whether a link's joint is translated or scaled, or joints further out are scaled.
    bool isAdjusted(const KernelLink& link) const {
        return joints->anyAdjusted &&
               (joints->adjusted[link.joint] != 0 || outs[link.out].scale() != 1.0f);
    }

    const CorrectedBlocks* corrections; ///< added to rest positions first
    std::size_t correctionCount;
    const CorrectiveWeights::Weights* const* weights; ///< by CorrectedBlocks::joint; null: nothing
    std::size_t firstBlock;      ///< the index in the group of the call's first block
    const KernelMap* shareFrame; ///< rotates sums of shares to the blocks' frame; null: none needed
    const KernelMap* normalShareFrame; ///< the same for shares of normals
    const BlockRow* morphTilts;        ///< of the call's first block; null: nothing
    /// GradientBlocks' rows; null: normals and tangents rotate as their vertices do.
    const std::int16_t* gradients;
    const BlockAcross* across;           ///< GradientBlocks'; where gradients is not null
    std::uint32_t bendTilts, twistTilts; ///< LinkTilts of `links`
    std::size_t lastSlope;               ///< the outermost link that tilts normals
    const float* bendSlopes;             ///< psi of each joint, in units of `gradients`
    const float* twistSlopes;            ///< phi, the same
    float slopeUnit;                     ///< the unit of the gradients
    float* positions;                    ///< x, y, z of the group's first vertex
    float* normals;                      ///< may be null
    float* tangents;                     ///< x, y, z, w; may be null; null where normals is
    std::size_t room; ///< vertices from there on that may be overwritten; >= vertexCount
    const std::uint32_t* scatter; ///< the vertex of each row; null where output is in order
};

/// Deforms groups. Without scatter, it may overwrite vertices behind the groups', up to
/// `endVertex`: call it in the groups' order.
using Kernel = void (*)(const KernelRun& run);

/// The kernel for runs with or without normals, tangents and gradients; the latter two need
/// normals.
Kernel kernelFor(bool normals, bool tangents, bool surface) noexcept;

} // namespace osgSkin
