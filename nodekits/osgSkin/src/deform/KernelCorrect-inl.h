// SPDX-License-Identifier: MIT
//
// Included by DeformKernel.cpp once for each instruction set.
#if defined(OSGSKIN_KERNELCORRECT_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef OSGSKIN_KERNELCORRECT_INL_H
#undef OSGSKIN_KERNELCORRECT_INL_H
#else
#define OSGSKIN_KERNELCORRECT_INL_H
#endif

#include <hwy/highway.h>

#include "deform/DeformKernel.h"
#include "deform/KernelRotations-inl.h"

HWY_BEFORE_NAMESPACE();
namespace osgSkin {
namespace HWY_NAMESPACE {

HWY_INLINE V sharesAt(const std::int16_t* HWY_RESTRICT from) {
    const hn::Rebind<std::int16_t, D> d16;
    const hn::Rebind<std::int32_t, D> d32;
    return hn::ConvertTo(D(), hn::PromoteTo(d32, hn::Load(d16, from)));
}

HWY_INLINE V sharesAt(const float* HWY_RESTRICT from) {
    return hn::Load(D(), from);
}

/// Adds weight k times the shares of mode k, for all modes. Rows are adjacent, so the processor
/// prefetches them.
template <typename Share>
HWY_INLINE void addModes(const float* HWY_RESTRICT weights, std::size_t modes,
                         const Share* HWY_RESTRICT shares, V& x, V& y, V& z) {
    for (std::size_t k = 0; k < modes; ++k, shares += 3 * kBlock) {
        const V weight = hn::Set(D(), weights[k]);
        x = hn::MulAdd(weight, sharesAt(shares), x);
        y = hn::MulAdd(weight, sharesAt(shares + kBlock), y);
        z = hn::MulAdd(weight, sharesAt(shares + 2 * kBlock), z);
    }
}

/// The sum of the correctives of positions or normals, of a vector of vertices from `first` on, in
/// the blocks' frame.
/// \return false where it is 0
template <bool kOfNormals>
HWY_INLINE bool corrections(const KernelCall& call, std::size_t first, V& dx, V& dy, V& dz) {
    const std::size_t block = call.firstBlock + first / kBlock;
    dx = dy = dz = hn::Zero(D());
    bool any = false;
    for (std::size_t i = 0; i < call.correctionCount; ++i) {
        const CorrectedBlocks& of = call.corrections[i];
        const CorrectiveWeights::Weights* const weights = call.weights[of.joint];
        const std::size_t at = block - of.firstBlock; // large where the block comes before
        if (at >= of.blockCount || !weights) continue;
        const std::int16_t* shares = kOfNormals ? of.normalShares : of.shares;
        if (kOfNormals && !shares) continue;
        any = true;
        const std::size_t from = at * of.blockShares + first % kBlock;
        const float* scales = kOfNormals ? weights->normals.data() : weights->positions.data();
        if (!kOfNormals && of.turned)
            addModes(scales, of.modes, of.turned + from, dx, dy, dz);
        else
            addModes(scales, of.modes, shares + from, dx, dy, dz);
    }
    const KernelMap* const frame = kOfNormals ? call.normalShareFrame : call.shareFrame;
    if (any && frame) turn(*frame, dx, dy, dz);
    return any;
}

/// Adds the correctives to rest positions.
HWY_INLINE void correct(const KernelCall& call, std::size_t first, V& x, V& y, V& z) {
    V dx, dy, dz;
    if (!corrections<false>(call, first, dx, dy, dz)) return;
    x = hn::Add(x, dx);
    y = hn::Add(y, dy);
    z = hn::Add(z, dz);
}

HWY_INLINE V dot(V ax, V ay, V az, V bx, V by, V bz) {
    return hn::MulAdd(ax, bx, hn::MulAdd(ay, by, hn::Mul(az, bz)));
}

/// 1 / sqrt(square), to the last few bits.
HWY_INLINE V inverseRoot(V square) {
    const D d;
    const V safe = hn::Max(square, hn::Set(d, 1e-30f)); // padding has no normals
    const V guess = hn::ApproximateReciprocalSqrt(safe);
    const V half = hn::Mul(hn::Mul(hn::Set(d, 0.5f), safe), guess);
    return hn::Mul(guess, hn::NegMulAdd(half, guess, hn::Set(d, 1.5f)));
}

/// Loads the offsets that morph targets add to normals.
/// \pre call.morphTilts is not null
HWY_INLINE void morphTilts(const KernelCall& call, std::size_t first, V& dx, V& dy, V& dz) {
    const BlockRow* const rows = call.morphTilts + 3 * (first / kBlock);
    dx = hn::Load(D(), rows[0].lane + first % kBlock);
    dy = hn::Load(D(), rows[1].lane + first % kBlock);
    dz = hn::Load(D(), rows[2].lane + first % kBlock);
}

/// Adds correctives and morph targets to rest normals, keeps them unit, and keeps tangents
/// perpendicular.
template <bool kTangents>
HWY_INLINE void correctNormals(const KernelCall& call, std::size_t first, V& nx, V& ny, V& nz,
                               V& tx, V& ty, V& tz) {
    V dx, dy, dz;
    const bool any = corrections<true>(call, first, dx, dy, dz);
    if (call.morphTilts) {
        V mx, my, mz;
        morphTilts(call, first, mx, my, mz);
        dx = hn::Add(dx, mx);
        dy = hn::Add(dy, my);
        dz = hn::Add(dz, mz);
    } else if (!any) {
        return;
    }
    nx = hn::Add(nx, dx);
    ny = hn::Add(ny, dy);
    nz = hn::Add(nz, dz);
    scaleBy(inverseRoot(dot(nx, ny, nz, nx, ny, nz)), nx, ny, nz);
    if (!kTangents) return;
    const V off = dot(nx, ny, nz, tx, ty, tz);
    const V square = dot(tx, ty, tz, tx, ty, tz);
    tx = hn::NegMulAdd(off, nx, tx);
    ty = hn::NegMulAdd(off, ny, ty);
    tz = hn::NegMulAdd(off, nz, tz);
    scaleBy(hn::Mul(hn::Sqrt(square), inverseRoot(dot(tx, ty, tz, tx, ty, tz))), tx, ty, tz);
}

} // namespace HWY_NAMESPACE
} // namespace osgSkin
HWY_AFTER_NAMESPACE();

#endif
