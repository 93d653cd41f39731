// SPDX-License-Identifier: MIT
//
// Compiled once for each instruction set, as DeformKernel is.
#include "bounds/BoundsKernel.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "bounds/BoundsKernel.cpp"
#include <hwy/foreach_target.h>
// Must follow foreach_target.h.
#include <hwy/highway.h>

#include "bounds/BlendedPieces-inl.h"

#include <limits>

HWY_BEFORE_NAMESPACE();
namespace osgSkin {
namespace HWY_NAMESPACE {

Box4 box(const BoundsProxy& proxy, const Pose& pose, JointMotion* room, const float* weights) {
    const JointMotions motions(proxy, pose, room);
    const PosedPieces pieces(proxy, motions);
    if (motions.isPlain()) return BlendedPieces(proxy, motions, weights).box(pieces);
    Box4 box{all(std::numeric_limits<float>::max()), all(-std::numeric_limits<float>::max())};
    for (const BoundsProxy::Block& block : proxy.blocks) {
        const BoundsProxy::Lanes corrected = correctedBy(proxy, block, weights);
        for (std::size_t lane = 0; lane < block.pieceCount; ++lane) {
            const Box4 of =
                pieces.turned(proxy.pieces[block.firstPiece + lane], corrected.lane[lane]);
            box.low = min(box.low, of.low);
            box.high = max(box.high, of.high);
        }
    }
    return box;
}

} // namespace HWY_NAMESPACE
} // namespace osgSkin
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace osgSkin {

HWY_EXPORT(box);

Box4 boxOf(const BoundsProxy& proxy, const Pose& pose, JointMotion* room,
           const float* weights) noexcept {
    return HWY_DYNAMIC_DISPATCH(box)(proxy, pose, room, weights);
}

} // namespace osgSkin
#endif
