// SPDX-License-Identifier: MIT
//
// Included by DeformKernel.cpp once for each instruction set.
#if defined(OSGSKIN_KERNELSINE_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef OSGSKIN_KERNELSINE_INL_H
#undef OSGSKIN_KERNELSINE_INL_H
#else
#define OSGSKIN_KERNELSINE_INL_H
#endif

#include <hwy/highway.h>

#include "DeformKernel.h"

HWY_BEFORE_NAMESPACE();
namespace osgSkin {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using D = hn::CappedTag<float, kBlock>;
using V = hn::Vec<D>;

HWY_INLINE V constant(const Splat& splat) {
    const D d;
#if HWY_TARGET == HWY_SSSE3 || HWY_TARGET == HWY_SSE4
    return hn::Load(d, splat.value); // a memory operand: these targets have few registers
#else
    return hn::Set(d, splat.value[0]);
#endif
}

/// c[0] + c[1] t + c[2] t^2 + ...
template <std::size_t kTerms>
HWY_INLINE V polynomial(V t, const float (&c)[kTerms]) {
    const D d;
    V sum = hn::Set(d, c[kTerms - 1]);
    for (std::size_t i = kTerms - 1; i-- > 0;) sum = hn::MulAdd(t, sum, hn::Set(d, c[i]));
    return sum;
}

/// Minimax polynomials for sin(h) / h and (cos(h) - 1) / h^2 in h^2. Both are exact at 0, so that
/// the rest pose is the rest skin. Errors of sine and cosine: 1.6e-9 and 8.2e-8 up to 0.34, 4.1e-9
/// and 9.5e-8 up to 0.9, 3.3e-9 and 5.3e-8 up to pi / 2.
constexpr float kSmallSine[] = {9.9999996659e-01f, -1.6666435335e-01f, 8.2932794990e-03f};
constexpr float kSmallCosine[] = {-4.9999203090e-01f, 4.1443658191e-02f};
constexpr float kMediumSine[] = {9.9999995910e-01f, -1.6666599225e-01f, 8.3303291252e-03f,
                                 -1.9344750883e-04f};
constexpr float kMediumCosine[] = {-4.9999762882e-01f, 4.1648854914e-02f, -1.3507828553e-03f};
constexpr float kLargeSine[] = {9.9999997659e-01f, -1.6666647633e-01f, 8.3328997978e-03f,
                                -1.9800896183e-04f, 2.5904852963e-06f};
constexpr float kLargeCosine[] = {-4.9999932288e-01f, 4.1663989297e-02f, -1.3855925896e-03f,
                                  2.3194355375e-05f};

/// Sine and cosine of ratio * angle. The angle's range is the same for a whole group, so that each
/// vertex pays only for as many terms as its group needs, and no range reduction.
HWY_INLINE void sineCosine(const KernelAngle& angle, V ratio, V& sine, V& cosine) {
    const D d;
    const V one = hn::Set(d, 1.0f);
    const V h = hn::Mul(ratio, constant(angle.value));
    const V t = hn::Mul(h, h);
    if (HWY_LIKELY(angle.range == KernelAngle::kSmall)) {
        sine = hn::Mul(h, polynomial(t, kSmallSine));
        cosine = hn::MulAdd(t, polynomial(t, kSmallCosine), one);
    } else if (HWY_LIKELY(angle.range == KernelAngle::kMedium)) {
        sine = hn::Mul(h, polynomial(t, kMediumSine));
#if HWY_TARGET == HWY_SSSE3 || HWY_TARGET == HWY_SSE4
        cosine = hn::Sqrt(hn::NegMulAdd(sine, sine, one)); // has a port of its own; exact enough
#else
        cosine = hn::MulAdd(t, polynomial(t, kMediumCosine), one);
#endif
    } else {
        sine = hn::Mul(h, polynomial(t, kLargeSine));
        cosine = hn::MulAdd(t, polynomial(t, kLargeCosine), one);
        if (angle.range == KernelAngle::kHalved) {
            const V twice = hn::Add(sine, sine);
            const V half = sine;
            sine = hn::Mul(twice, cosine);
            cosine = hn::NegMulAdd(twice, half, one);
        }
    }
}

} // namespace HWY_NAMESPACE
} // namespace osgSkin
HWY_AFTER_NAMESPACE();

#endif
