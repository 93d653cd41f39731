// SPDX-License-Identifier: MIT
//
// Included by DeformKernel.cpp once for each instruction set.
#if defined(OSGSKIN_KERNELSURFACE_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef OSGSKIN_KERNELSURFACE_INL_H
#undef OSGSKIN_KERNELSURFACE_INL_H
#else
#define OSGSKIN_KERNELSURFACE_INL_H
#endif

#include <hwy/highway.h>

#include "deform/DeformKernel.h"
#include "deform/KernelCorrect-inl.h"
#include "deform/KernelRotations-inl.h"

HWY_BEFORE_NAMESPACE();
namespace osgSkin {
namespace HWY_NAMESPACE {

/// A link's rows in a block of GradientBlocks.
enum SlopeRow : std::size_t { kBendAlongU, kBendAlongV, kTwistAlongU, kTwistAlongV, kSlopeRows };

/// The lanes of the vertices from `first` on in the gradients' blocks.
HWY_INLINE const std::int16_t* gradientLanes(const KernelCall& call, std::size_t first) {
    return call.gradients + first / kBlock * GradientBlocks::rowsPerBlock(call.linkCount) * kBlock +
           first % kBlock;
}

/// A link's gradient in one row, times `by`.
HWY_INLINE V slopeAt(const std::int16_t* HWY_RESTRICT slopes, SlopeRow row, const float& by) {
    return hn::Mul(sharesAt(slopes + row * kBlock), constant(by));
}

/// Adds to a direction along the skin what the gradient of a rotation's ratio adds in its plane,
/// with the vertex at (a, b); all before the rotation, or all after it.
HWY_INLINE void addSlope(V slope, V a, V b, V& alongA, V& alongB) {
    alongA = hn::NegMulAdd(slope, b, alongA);
    alongB = hn::MulAdd(slope, a, alongB);
}

/// The same for adjust(), before that is applied to the vertex.
HWY_INLINE void adjustAlong(const KernelCall& call, const KernelLink& link, V bendRatio, V step,
                            V x, V y, V z, V& alongX, V& alongY, V& alongZ) {
    const KernelJoints& joints = *call.joints;
    const V growth = constant(joints.growth[link.joint]);
    const V scale = constant(call.outs[link.out].scale());
    const V factor = hn::MulAdd(bendRatio, growth, hn::Set(D(), 1.0f));
    const auto along = [&](std::size_t axis, V at, V& to) HWY_ATTR {
        const V move = constant(joints.move[axis][link.joint]);
        to = hn::MulAdd(factor, to, hn::Mul(step, hn::MulAdd(growth, at, move)));
        to = hn::Mul(to, scale);
    };
    along(0, x, alongX);
    along(1, y, alongY);
    along(2, z, alongZ);
}

HWY_INLINE void cross(V ax, V ay, V az, V bx, V by, V bz, V& x, V& y, V& z) {
    x = hn::MulSub(ay, bz, hn::Mul(az, by));
    y = hn::MulSub(az, bx, hn::Mul(ax, bz));
    z = hn::MulSub(ax, by, hn::Mul(ay, bx));
}

/// Scales two directions by their largest coordinate, so that products do not overflow.
HWY_INLINE void bringIntoRange(V& ux, V& uy, V& uz, V& vx, V& vy, V& vz) {
    const D d;
    const V u = hn::Max(hn::Abs(ux), hn::Max(hn::Abs(uy), hn::Abs(uz)));
    const V v = hn::Max(hn::Abs(vx), hn::Max(hn::Abs(vy), hn::Abs(vz)));
    const V by = hn::Div(hn::Set(d, 1.0f), hn::Max(hn::Max(u, v), hn::Set(d, 1e-30f)));
    scaleBy(by, ux, uy, uz);
    scaleBy(by, vx, vy, vz);
}

/// The sum of the normal correctives along u and v.
/// \return false where it is 0
HWY_INLINE bool tilts(const KernelCall& call, std::size_t first, V& alongU, V& alongV) {
    const D d;
    alongU = alongV = hn::Zero(d);
    bool any = false;
    const std::size_t block = call.firstBlock + first / kBlock;
    for (std::size_t i = 0; i < call.correctionCount; ++i) {
        const CorrectedBlocks& of = call.corrections[i];
        const CorrectiveWeights::Weights* const weights = call.weights[of.joint];
        const std::size_t at = block - of.firstBlock; // large where the block comes before
        if (at >= of.blockCount || !weights || !of.tilts) continue;
        any = true;
        const float* HWY_RESTRICT from = of.tilts + at * 2 * of.modes * kBlock + first % kBlock;
        for (std::size_t k = 0; k < of.modes; ++k, from += 2 * kBlock) {
            const V weight = hn::Set(d, weights->normals[k]);
            alongU = hn::MulAdd(weight, hn::Load(d, from), alongU);
            alongV = hn::MulAdd(weight, hn::Load(d, from + kBlock), alongV);
        }
    }
    return any;
}

/// The directions u and v along the skin, tilted by correctives and morph targets: u - (d . u) n
/// and v - (d . v) n, with d their sum for the normal. Their cross product is along n + d, without
/// d's part along n.
HWY_INLINE void skinDirections(const KernelCall& call, std::size_t first, V nx, V ny, V nz, V& ux,
                               V& uy, V& uz, V& vx, V& vy, V& vz) {
    const D d;
    const float* across = call.across[first / kBlock].across;
    if (HWY_LIKELY(across[2] == kAlongFrame.across[2])) { // needs fewer steps
        vx = hn::Neg(ny);
        vy = nx;
        vz = hn::Zero(d);
        ux = hn::Mul(nx, nz);
        uy = hn::Mul(ny, nz);
        uz = hn::NegMulSub(ny, ny, hn::Mul(nx, nx));
    } else {
        cross(nx, ny, nz, hn::Set(d, across[0]), hn::Set(d, across[1]), hn::Set(d, across[2]), vx,
              vy, vz);
        cross(vx, vy, vz, nx, ny, nz, ux, uy, uz);
    }
    if (HWY_LIKELY(call.correctionCount == 0 && !call.morphTilts)) return;
    V alongU, alongV;
    const bool any = tilts(call, first, alongU, alongV);
    if (call.morphTilts) {
        V dx, dy, dz;
        morphTilts(call, first, dx, dy, dz);
        alongU = hn::Add(alongU, dot(dx, dy, dz, ux, uy, uz));
        alongV = hn::Add(alongV, dot(dx, dy, dz, vx, vy, vz));
    } else if (!any) {
        return;
    }
    ux = hn::NegMulAdd(alongU, nx, ux);
    uy = hn::NegMulAdd(alongU, ny, uy);
    uz = hn::NegMulAdd(alongU, nz, uz);
    vx = hn::NegMulAdd(alongV, nx, vx);
    vy = hn::NegMulAdd(alongV, ny, vy);
    vz = hn::NegMulAdd(alongV, nz, vz);
}

/// A tangent from its components along u and v, not yet of its length.
HWY_INLINE void combine(V alongU, V alongV, V ux, V uy, V uz, V vx, V vy, V vz, V& tx, V& ty,
                        V& tz) {
    tx = hn::MulAdd(alongU, ux, hn::Mul(alongV, vx));
    ty = hn::MulAdd(alongU, uy, hn::Mul(alongV, vy));
    tz = hn::MulAdd(alongU, uz, hn::Mul(alongV, vz));
}

} // namespace HWY_NAMESPACE
} // namespace osgSkin
HWY_AFTER_NAMESPACE();

#endif
