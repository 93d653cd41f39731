// SPDX-License-Identifier: MIT
//
// Compiled once for each instruction set, as DeformKernel is.
#include "bounds/BlendKernel.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "bounds/BlendKernel.cpp"
#include <hwy/foreach_target.h>
// Must follow foreach_target.h.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace osgSkin {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using PieceTag = hn::CappedTag<float, BoundsProxy::kAtOnce>;
using Pieces = hn::Vec<PieceTag>;

constexpr float kBlendRounding = 2e-6f; ///< of a coordinate: several roundings

/// The pieces' own maps, [column][axis], and how far vertices stray from those.
struct BlendedMaps {
    Pieces turn[3][3], move[3], more;
};

HWY_INLINE Pieces lanesOf(const BoundsProxy::Lanes& of, std::size_t first) {
    return hn::Load(PieceTag(), of.lane + first);
}

HWY_INLINE void addStrays(const BoundsProxy::Share& share, const JointMotion& joint,
                          std::size_t first, BlendedMaps& maps) {
    const PieceTag d;
    const float angle = joint.bend + joint.twist;
    maps.more = hn::MulAdd(hn::Set(d, joint.bend), lanesOf(share.bend, first), maps.more);
    maps.more = hn::MulAdd(hn::Set(d, joint.twist), lanesOf(share.twist, first), maps.more);
    maps.more = hn::MulAdd(hn::Set(d, angle * angle), lanesOf(share.square, first), maps.more);
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

void blend(const BoundsProxy& proxy, const JointMotions& motions, BlendedBlock* boxes) {
    const PieceTag d;
    const Pieces none = hn::Zero(d);
    for (const BoundsProxy::Block& block : proxy.blocks) {
        const BoundsProxy::Share* shares = proxy.shares.data() + block.firstShare;
        for (std::size_t first = 0; first < BoundsProxy::kAtOnce; first += hn::Lanes(d)) {
            BlendedMaps maps{{{none, none, none}, {none, none, none}, {none, none, none}},
                             {none, none, none},
                             hn::Add(lanesOf(block.corrected, first), hn::Set(d, proxy.rounding))};
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
                half = hn::Add(hn::Add(half, hn::Abs(z)), maps.more);
                half = hn::MulAdd(hn::Set(d, kBlendRounding), hn::Abs(centre), half);
                hn::Store(hn::Sub(centre, half), d, boxes->low[axis].lane + first);
                hn::Store(hn::Add(centre, half), d, boxes->high[axis].lane + first);
            }
        }
        ++boxes;
    }
}

} // namespace HWY_NAMESPACE
} // namespace osgSkin
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace osgSkin {

HWY_EXPORT(blend);

void blendBoxes(const BoundsProxy& proxy, const JointMotions& motions,
                BlendedBlock* boxes) noexcept {
    HWY_DYNAMIC_DISPATCH(blend)(proxy, motions, boxes);
}

} // namespace osgSkin
#endif
