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

#include "bounds/BlendKernel-inl.h"
#include "bounds/PosedPieces-inl.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

HWY_BEFORE_NAMESPACE();
namespace osgSkin {
namespace HWY_NAMESPACE {

/// How far out of where the skin is about a box may reach and be good enough, in that one's size.
constexpr float kLoose = 0.03f;

/// Boxes of all pieces of skin in a plain pose, by linear blending: they tell which pieces need to
/// be looked at more closely.
class BlendedPieces {
public:
    /// \param proxy of the pose's model
    /// \param motions the pose's, which is plain
    /// \param weights CorrectiveStray's; null where there are no correctives
    BlendedPieces(const BoundsProxy& proxy, const JointMotions& motions,
                  const float* weights) noexcept;

    /// The box that holds all vertices: of the pieces' blended boxes, but where one reaches far out
    /// of where the skin is about, of what is known more closely of that piece.
    ///
    /// \param pieces of the same pose
    FourBox box(const PosedPieces& pieces) noexcept;

private:
    static constexpr std::size_t kMostBlocks =
        (BoundsProxy::kMost + BoundsProxy::kAtOnce - 1) / BoundsProxy::kAtOnce;

    /// Makes a piece's box smaller by what is known more closely, unless it is in `wanted`; that
    /// grows by it: as far out as the skin reaches anyway, others need not be looked at.
    void look(std::size_t block, std::size_t lane, const PosedPieces& pieces,
              BlendedBox& wanted) noexcept;

    const BoundsProxy& _proxy;
    std::array<BlendedBlock, kMostBlocks> _blocks;
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
    // Those that are missing are the first one again.
    const BoundsProxy::Piece& piece =
        _proxy.pieces[of.firstPiece + (lane < of.pieceCount ? lane : 0)];
    const FourBox turned = pieces.turned(piece, boxes.corrected.lane[lane]);
    for (int axis = 0; axis < 3; ++axis) {
        float& low = boxes.low[axis].lane[lane];
        float& high = boxes.high[axis].lane[lane];
        low = std::max(turned.low[axis], low);
        high = std::min(turned.high[axis], high);
        wanted.low[axis] = std::min(wanted.low[axis], low);
        wanted.high[axis] = std::max(wanted.high[axis], high);
    }
}

HWY_INLINE FourBox BlendedPieces::box(const PosedPieces& pieces) noexcept {
    BlendedBox wanted = _about;
    for (int axis = 0; axis < 3; ++axis) {
        const float loose = kLoose * (wanted.high[axis] - wanted.low[axis]);
        wanted.low[axis] -= loose;
        wanted.high[axis] += loose;
    }
    const std::size_t count = _proxy.blocks.size();
    std::array<std::uint8_t, kMostBlocks> outside;
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
