// SPDX-License-Identifier: MIT
//
// Included by BoundsKernel.cpp once for each instruction set.
#if defined(OSGSKIN_BLENDEDPIECES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef OSGSKIN_BLENDEDPIECES_INL_H
#undef OSGSKIN_BLENDEDPIECES_INL_H
#else
#define OSGSKIN_BLENDEDPIECES_INL_H
#endif

#include <hwy/highway.h>

#include "bounds/PosedPieces-inl.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>

HWY_BEFORE_NAMESPACE();
namespace osgSkin {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using PieceTag = hn::CappedTag<float, BoundsProxy::kAtOnce>;
using Pieces = hn::Vec<PieceTag>;

constexpr float kBlendRounding = 2e-6f; ///< of a coordinate: several roundings

/// Boxes of a block's pieces, [axis].
struct BlendedBlock {
    BoundsProxy::Lanes low[3], high[3];
    BoundsProxy::Lanes corrected; ///< how far correctives move the pieces' vertices
};

/// A box's sides, [axis].
struct BlendedBox {
    float low[3], high[3];
};

/// The pieces' maps, [column][axis], and how far vertices deviate from those.
struct BlendedMaps {
    Pieces turn[3][3], move[3], more;
};

HWY_INLINE Pieces lanesOf(const BoundsProxy::Lanes& of, std::size_t first) {
    return hn::Load(PieceTag(), of.lane + first);
}

HWY_INLINE void addStrays(const BoundsProxy::Share& share, const JointMotion& joint,
                          std::size_t first, BlendedMaps& maps) {
    const PieceTag d;
    maps.more = hn::MulAdd(hn::Set(d, joint.bend), lanesOf(share.bend, first), maps.more);
    maps.more = hn::MulAdd(hn::Set(d, joint.twist), lanesOf(share.twist, first), maps.more);
    maps.more = hn::MulAdd(hn::Set(d, joint.square), lanesOf(share.square, first), maps.more);
}

HWY_INLINE void addWeighted(const BoundsProxy::Share& share, const JointMotion& joint,
                            std::size_t first, BlendedMaps& maps) {
    const PieceTag d;
    const Pieces weight = lanesOf(share.weight, first);
    for (int axis = 0; axis < 3; ++axis) {
        for (int column = 0; column < 3; ++column)
            maps.turn[column][axis] = hn::MulAdd(hn::Set(d, joint.map.column[column][axis]), weight,
                                                 maps.turn[column][axis]);
        maps.move[axis] =
            hn::MulAdd(hn::Set(d, joint.map.column[3][axis]), weight, maps.move[axis]);
    }
    addStrays(share, joint, first, maps);
}

HWY_INLINE Pieces turned(const BlendedMaps& maps, const BoundsProxy::Lanes (&x)[3], int axis,
                         std::size_t first, Pieces from) {
    for (int column = 0; column < 3; ++column)
        from = hn::MulAdd(lanesOf(x[column], first), maps.turn[column][axis], from);
    return from;
}

/// How far correctives move the vertices of a block's pieces.
///
/// \param weights see boxOf()
HWY_INLINE BoundsProxy::Lanes correctedBy(const BoundsProxy& proxy, const BoundsProxy::Block& block,
                                          const float* weights) {
    const PieceTag d;
    BoundsProxy::Lanes result;
    const BoundsProxy::Reach* const reaches = proxy.reaches.data() + block.firstReach;
    const std::size_t count = weights ? block.reachCount : 0;
    for (std::size_t first = 0; first < BoundsProxy::kAtOnce; first += hn::Lanes(d)) {
        Pieces sum = hn::Zero(d);
        for (std::size_t i = 0; i < count; ++i)
            sum = hn::MulAdd(hn::Set(d, weights[reaches[i].weight]),
                             lanesOf(reaches[i].length, first), sum);
        hn::Store(sum, d, result.lane + first);
    }
    return result;
}

/// A box that grows, in each lane.
struct Growing {
    Pieces low[3], high[3];

    HWY_INLINE Growing() {
        for (int axis = 0; axis < 3; ++axis) {
            low[axis] = hn::Set(PieceTag(), std::numeric_limits<float>::max());
            high[axis] = hn::Neg(low[axis]);
        }
    }
    HWY_INLINE void add(int axis, Pieces from, Pieces to) {
        low[axis] = hn::Min(low[axis], from);
        high[axis] = hn::Max(high[axis], to);
    }
    HWY_INLINE BlendedBox box() const {
        const PieceTag d;
        BlendedBox result;
        for (int axis = 0; axis < 3; ++axis) {
            result.low[axis] = hn::GetLane(hn::MinOfLanes(d, low[axis]));
            result.high[axis] = hn::GetLane(hn::MaxOfLanes(d, high[axis]));
        }
        return result;
    }
};

/// The boxes of a skin's pieces in a plain pose by linear blending, enlarged by how far vertices
/// may deviate (BoundsProxy).
///
/// \param weights see boxOf()
/// \param boxes set: one for each block
/// \return the box without the enlargement: about where the skin is
HWY_INLINE BlendedBox blendBoxes(const BoundsProxy& proxy, const JointMotions& motions,
                                 const float* weights, BlendedBlock* boxes) {
    const PieceTag d;
    const Pieces none = hn::Zero(d);
    Growing about;
    for (const BoundsProxy::Block& block : proxy.blocks) {
        const BoundsProxy::Share* shares = proxy.shares.data() + block.firstShare;
        boxes->corrected = correctedBy(proxy, block, weights);
        for (std::size_t first = 0; first < BoundsProxy::kAtOnce; first += hn::Lanes(d)) {
            BlendedMaps maps{{{none, none, none}, {none, none, none}, {none, none, none}},
                             {none, none, none},
                             hn::Add(lanesOf(boxes->corrected, first), hn::Set(d, proxy.rounding))};
            std::uint32_t i = 0;
            for (; i < block.weighted; ++i)
                addWeighted(shares[i], motions[shares[i].joint], first, maps);
            for (; i < block.shareCount; ++i)
                addStrays(shares[i], motions[shares[i].joint], first, maps);
            for (int axis = 0; axis < 3; ++axis) {
                const Pieces centre = turned(maps, block.centre, axis, first, maps.move[axis]);
                const Pieces x = turned(maps, block.axes[0], axis, first, none);
                const Pieces y = turned(maps, block.axes[1], axis, first, none);
                const Pieces z = turned(maps, block.axes[2], axis, first, none);
                Pieces half = hn::Sqrt(hn::MulAdd(x, x, hn::Mul(y, y)));
                half = hn::Add(half, hn::Abs(z));
                about.add(axis, hn::Sub(centre, half), hn::Add(centre, half));
                half = hn::Add(half, maps.more);
                half = hn::MulAdd(hn::Set(d, kBlendRounding), hn::Abs(centre), half);
                hn::Store(hn::Sub(centre, half), d, boxes->low[axis].lane + first);
                hn::Store(hn::Add(centre, half), d, boxes->high[axis].lane + first);
            }
        }
        ++boxes;
    }
    return about.box();
}

/// Finds the pieces that extend beyond a box.
///
/// \param count of the blocks
/// \param lanes set for each block: a bit for each such piece
HWY_INLINE void findOutside(const BlendedBlock* boxes, std::size_t count, const BlendedBox& box,
                            std::uint8_t* lanes) {
    const PieceTag d;
    for (const BlendedBlock* end = boxes + count; boxes != end; ++boxes, ++lanes) {
        unsigned int all = 0;
        for (std::size_t first = 0; first < BoundsProxy::kAtOnce; first += hn::Lanes(d)) {
            auto inside = hn::Ge(lanesOf(boxes->low[0], first), hn::Set(d, box.low[0]));
            for (int axis = 0; axis < 3; ++axis) { // false for NaN
                inside = hn::And(
                    inside, hn::Ge(lanesOf(boxes->low[axis], first), hn::Set(d, box.low[axis])));
                inside = hn::And(
                    inside, hn::Le(lanesOf(boxes->high[axis], first), hn::Set(d, box.high[axis])));
            }
            std::uint8_t bits[8];
            hn::StoreMaskBits(d, hn::Not(inside), bits);
            all |= static_cast<unsigned int>(bits[0]) << first;
        }
        *lanes = static_cast<std::uint8_t>(all);
    }
}

/// The box around all boxes.
HWY_INLINE BlendedBox boxAround(const BlendedBlock* boxes, std::size_t count) {
    Growing result;
    for (const BlendedBlock* end = boxes + count; boxes != end; ++boxes)
        for (std::size_t first = 0; first < BoundsProxy::kAtOnce; first += hn::Lanes(PieceTag()))
            for (int axis = 0; axis < 3; ++axis)
                result.add(axis, lanesOf(boxes->low[axis], first),
                           lanesOf(boxes->high[axis], first));
    return result.box();
}

/// How far a piece's box may extend beyond the approximate box of the skin, relative to its size.
constexpr float kLoose = 0.03f;

/// Boxes of all pieces in a plain pose, by linear blending; few of them need a closer bound.
class BlendedPieces {
public:
    /// \param proxy of the pose's model
    /// \param motions of a plain pose
    /// \param weights see boxOf()
    BlendedPieces(const BoundsProxy& proxy, const JointMotions& motions,
                  const float* weights) noexcept;

    /// The box around all vertices: around the blended boxes, or closer ones of pieces that extend
    /// far beyond the skin.
    ///
    /// \param pieces of the same pose
    Box4 box(const PosedPieces& pieces) noexcept;

private:
    static constexpr std::size_t kMaxBlocks =
        (BoundsProxy::kMost + BoundsProxy::kAtOnce - 1) / BoundsProxy::kAtOnce;

    /// Replaces a piece's box by a closer one unless it is inside `wanted`, and expands `wanted` by
    /// it: pieces within the skin's extent need no closer bound.
    void look(std::size_t block, std::size_t lane, const PosedPieces& pieces,
              BlendedBox& wanted) noexcept;

    const BoundsProxy& _proxy;
    std::array<BlendedBlock, kMaxBlocks> _blocks;
    BlendedBox _about; ///< where the skin is about
};

HWY_INLINE BlendedPieces::BlendedPieces(const BoundsProxy& proxy, const JointMotions& motions,
                                        const float* weights) noexcept
    : _proxy(proxy), _about(blendBoxes(proxy, motions, weights, _blocks.data())) {}

HWY_INLINE void BlendedPieces::look(std::size_t block, std::size_t lane, const PosedPieces& pieces,
                                    BlendedBox& wanted) noexcept {
    BlendedBlock& boxes = _blocks[block];
    bool isInside = true;
    for (int axis = 0; axis < 3; ++axis)
        isInside = isInside && boxes.low[axis].lane[lane] >= wanted.low[axis] &&
                   boxes.high[axis].lane[lane] <= wanted.high[axis];
    if (isInside) return;
    const BoundsProxy::Block& of = _proxy.blocks[block];
    // Unused lanes repeat the first piece.
    const BoundsProxy::Piece& piece =
        _proxy.pieces[of.firstPiece + (lane < of.pieceCount ? lane : 0)];
    const Box4 turned = pieces.turned(piece, boxes.corrected.lane[lane]);
    for (int axis = 0; axis < 3; ++axis) {
        float& low = boxes.low[axis].lane[lane];
        float& high = boxes.high[axis].lane[lane];
        low = std::max(turned.low[axis], low);
        high = std::min(turned.high[axis], high);
        wanted.low[axis] = std::min(wanted.low[axis], low);
        wanted.high[axis] = std::max(wanted.high[axis], high);
    }
}

HWY_INLINE Box4 BlendedPieces::box(const PosedPieces& pieces) noexcept {
    BlendedBox wanted = _about;
    for (int axis = 0; axis < 3; ++axis) {
        const float loose = kLoose * (wanted.high[axis] - wanted.low[axis]);
        wanted.low[axis] -= loose;
        wanted.high[axis] += loose;
    }
    const std::size_t count = _proxy.blocks.size();
    std::array<std::uint8_t, kMaxBlocks> outside;
    findOutside(_blocks.data(), count, wanted, outside.data());
    for (std::size_t block = 0; block < count; ++block)
        for (unsigned int lanes = outside[block], lane = 0; lanes != 0; lanes >>= 1, ++lane)
            if (lanes & 1u) look(block, lane, pieces, wanted);
    const BlendedBox all = boxAround(_blocks.data(), count);
    return {four(all.low[0], all.low[1], all.low[2], 0.0f),
            four(all.high[0], all.high[1], all.high[2], 0.0f)};
}

} // namespace HWY_NAMESPACE
} // namespace osgSkin
HWY_AFTER_NAMESPACE();

#endif
