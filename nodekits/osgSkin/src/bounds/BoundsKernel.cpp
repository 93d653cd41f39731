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

FourBox box(const BoundsProxy& proxy, const Pose& pose, JointMotion* room,
            CorrectiveStray* corrections) {
    const JointMotions motions(proxy, pose, room);
    const PosedPieces pieces(proxy, motions, corrections);
    if (motions.isPlain()) return BlendedPieces(proxy, motions).box(pieces);
    FourBox box{all(std::numeric_limits<float>::max()), all(-std::numeric_limits<float>::max())};
    for (const BoundsProxy::Piece& piece : proxy.pieces) {
        const FourBox of = pieces.turned(piece, pieces.corrected(piece));
        box.low = min(box.low, of.low);
        box.high = max(box.high, of.high);
    }
    return box;
}

} // namespace HWY_NAMESPACE
} // namespace osgSkin
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace osgSkin {

HWY_EXPORT(box);

FourBox boxOf(const BoundsProxy& proxy, const Pose& pose, JointMotion* room,
              CorrectiveStray* corrections) noexcept {
    return HWY_DYNAMIC_DISPATCH(box)(proxy, pose, room, corrections);
}

} // namespace osgSkin
#endif
