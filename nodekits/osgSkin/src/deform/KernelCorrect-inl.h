// SPDX-License-Identifier: MIT
//
// Included by DeformKernel.cpp once for each instruction set.
#if defined(OSGSKIN_KERNELCORRECT_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef OSGSKIN_KERNELCORRECT_INL_H
#undef OSGSKIN_KERNELCORRECT_INL_H
#else
#define OSGSKIN_KERNELCORRECT_INL_H
#endif

#include <hwy/cache_control.h>
#include <hwy/highway.h>

#include "deform/DeformKernel.h"
#include "deform/KernelTurns-inl.h"

HWY_BEFORE_NAMESPACE();
namespace osgSkin {
namespace HWY_NAMESPACE {

HWY_INLINE V sharesAt(const std::int16_t* HWY_RESTRICT from) {
    const hn::Rebind<std::int16_t, D> d16;
    const hn::Rebind<std::int32_t, D> d32;
    return hn::ConvertTo(D(), hn::PromoteTo(d32, hn::Load(d16, from)));
}

/// How far ahead shares are asked for: the next ones lie behind, also those of other vertices.
constexpr std::size_t kSharesAhead = 1024;

/// Adds weight k times the k-th mode's shares for all modes; a block's rows lie side by side.
HWY_INLINE void addModes(const float* HWY_RESTRICT weights, std::size_t modes,
                         const std::int16_t* HWY_RESTRICT shares, V& x, V& y, V& z) {
    for (std::size_t k = 0; k < modes; ++k, shares += 3 * kBlock) {
        for (std::size_t i = 0; i < 3 * kBlock; i += 32) hwy::Prefetch(shares + kSharesAhead + i);
        const V weight = hn::Set(D(), weights[k]);
        x = hn::MulAdd(weight, sharesAt(shares), x);
        y = hn::MulAdd(weight, sharesAt(shares + kBlock), y);
        z = hn::MulAdd(weight, sharesAt(shares + 2 * kBlock), z);
    }
}

/// Adds the correctives to the rest positions of the vertices from `first` on, a vector of them.
HWY_INLINE void correct(const KernelCall& call, std::size_t first, V& x, V& y, V& z) {
    const std::size_t block = first / kBlock;
    V dx = hn::Zero(D()), dy = dx, dz = dx;
    bool any = false;
    for (std::size_t i = 0; i < call.correctionCount; ++i) {
        const KernelCorrection& of = call.corrections[i];
        const std::size_t at = block - of.firstBlock; // large where the block comes before
        if (at >= of.blockCount) continue;
        any = true;
        addModes(of.weights, of.modes, of.shares + at * of.blockShares + first % kBlock, dx, dy,
                 dz);
    }
    if (!any) return;
    if (call.correctionFrame) turn(*call.correctionFrame, dx, dy, dz);
    x = hn::Add(x, dx);
    y = hn::Add(y, dy);
    z = hn::Add(z, dz);
}

} // namespace HWY_NAMESPACE
} // namespace osgSkin
HWY_AFTER_NAMESPACE();

#endif
