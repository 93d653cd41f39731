// SPDX-License-Identifier: MIT
//
// Included by DeformKernel.cpp once for each instruction set.
#if defined(OSGSKIN_KERNELTURNS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef OSGSKIN_KERNELTURNS_INL_H
#undef OSGSKIN_KERNELTURNS_INL_H
#else
#define OSGSKIN_KERNELTURNS_INL_H
#endif

#include <hwy/highway.h>

#include "deform/DeformKernel.h"

HWY_BEFORE_NAMESPACE();
namespace osgSkin {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using D = hn::CappedTag<float, kBlock>;
using V = hn::Vec<D>;

HWY_INLINE V constant(const float& x) {
    return hn::Set(D(), x);
}

/// c[0] + c[1] t + c[2] t^2 + ...
template <std::size_t kTerms>
HWY_INLINE V polynomial(V t, const float (&c)[kTerms]) {
    const D d;
    V sum = hn::Set(d, c[kTerms - 1]);
    for (std::size_t i = kTerms - 1; i-- > 0;) sum = hn::MulAdd(t, sum, hn::Set(d, c[i]));
    return sum;
}

/// Minimax polynomials for sin(h) / h and (cos(h) - 1) / h^2 in h^2; exact at 0, for the rest pose.
/// Errors of sine and cosine: 1.6e-9 and 8.2e-8 up to 0.34, 4.1e-9 and 9.5e-8 up to 0.9, 3.3e-9 and
/// 5.3e-8 up to pi / 2.
constexpr float kSmallSine[] = {9.9999996659e-01f, -1.6666435335e-01f, 8.2932794990e-03f};
constexpr float kSmallCosine[] = {-4.9999203090e-01f, 4.1443658191e-02f};
constexpr float kMediumSine[] = {9.9999995910e-01f, -1.6666599225e-01f, 8.3303291252e-03f,
                                 -1.9344750883e-04f};
constexpr float kMediumCosine[] = {-4.9999762882e-01f, 4.1648854914e-02f, -1.3507828553e-03f};
constexpr float kLargeSine[] = {9.9999997659e-01f, -1.6666647633e-01f, 8.3328997978e-03f,
                                -1.9800896183e-04f, 2.5904852963e-06f};
constexpr float kLargeCosine[] = {-4.9999932288e-01f, 4.1663989297e-02f, -1.3855925896e-03f,
                                  2.3194355375e-05f};

/// Doubles an angle given by sine and cosine.
HWY_INLINE void twice(V& sine, V& cosine) {
    const V s = sine;
    const V both = hn::Add(s, s);
    sine = hn::Mul(both, cosine);
    cosine = hn::NegMulAdd(both, s, hn::Set(D(), 1.0f));
}

/// Sine and cosine of ratio * angle. The range is the angle's, the same for a whole group: no range
/// reduction per vertex, and no more terms than needed.
HWY_INLINE void sineCosine(const KernelAngle& angle, V ratio, V& sine, V& cosine) {
    const V one = hn::Set(D(), 1.0f);
    const V h = hn::Mul(ratio, constant(angle.value));
    const V t = hn::Mul(h, h);
    if (HWY_LIKELY(angle.range == KernelAngle::kSmall)) {
        sine = hn::Mul(h, polynomial(t, kSmallSine));
        cosine = hn::MulAdd(t, polynomial(t, kSmallCosine), one);
    } else if (HWY_LIKELY(angle.range == KernelAngle::kMedium)) {
        sine = hn::Mul(h, polynomial(t, kMediumSine));
        cosine = hn::MulAdd(t, polynomial(t, kMediumCosine), one);
    } else {
        sine = hn::Mul(h, polynomial(t, kLargeSine));
        cosine = hn::MulAdd(t, polynomial(t, kLargeCosine), one);
        if (angle.range >= KernelAngle::kHalved) twice(sine, cosine);
        if (HWY_UNLIKELY(angle.range == KernelAngle::kQuartered)) twice(sine, cosine);
    }
}

/// Subtracts v's azimuth from the twist: rest data is in the fixed frame, not in (v, w x v, w).
HWY_INLINE void subtractAzimuth(const KernelCall& call, const KernelLink& link, V& sine,
                                V& cosine) {
    const V old = cosine;
    const V of = constant(call.joints->azimuthCosine[link.joint]);
    const V by = constant(call.joints->azimuthSine[link.joint]);
    cosine = hn::MulAdd(old, of, hn::Mul(sine, by));
    sine = hn::MulSub(sine, of, hn::Mul(old, by));
}

/// Rotates (a, b) in its plane.
HWY_INLINE void rotate2D(V sine, V cosine, V& a, V& b) {
    const V old = a;
    a = hn::MulSub(cosine, a, hn::Mul(sine, b));
    b = hn::MulAdd(sine, old, hn::Mul(cosine, b));
}

HWY_INLINE V turnedRow(const KernelMap& map, std::size_t row, V x, V y, V z) {
    return hn::MulAdd(
        constant(map.turn(row, 2)), z,
        hn::MulAdd(constant(map.turn(row, 1)), y, hn::Mul(constant(map.turn(row, 0)), x)));
}

HWY_INLINE void turn(const KernelMap& map, V& x, V& y, V& z) {
    const V a = turnedRow(map, 0, x, y, z);
    const V b = turnedRow(map, 1, x, y, z);
    z = turnedRow(map, 2, x, y, z);
    x = a;
    y = b;
}

HWY_INLINE V movedRow(const KernelMap& map, std::size_t row, V x, V y, V z) {
    return hn::MulAdd(
        constant(map.turn(row, 2)), z,
        hn::MulAdd(constant(map.turn(row, 1)), y,
                   hn::MulAdd(constant(map.turn(row, 0)), x, constant(map.move(row)))));
}

HWY_INLINE void apply(const KernelMap& map, V& x, V& y, V& z) {
    const V a = movedRow(map, 0, x, y, z);
    const V b = movedRow(map, 1, x, y, z);
    z = movedRow(map, 2, x, y, z);
    x = a;
    y = b;
}

HWY_INLINE void scaleBy(V factor, V& x, V& y, V& z) {
    x = hn::Mul(x, factor);
    y = hn::Mul(y, factor);
    z = hn::Mul(z, factor);
}

/// Applies the joint's translation and scale, which come in with the bend, about its centre, the
/// frame's origin.
HWY_INLINE void adjust(const KernelCall& call, const KernelLink& link, V bendRatio, V& x, V& y,
                       V& z) {
    const KernelJoints& joints = *call.joints;
    const V factor = hn::MulAdd(bendRatio, constant(joints.growth[link.joint]), hn::Set(D(), 1.0f));
    x = hn::MulAdd(bendRatio, constant(joints.move[0][link.joint]), hn::Mul(factor, x));
    y = hn::MulAdd(bendRatio, constant(joints.move[1][link.joint]), hn::Mul(factor, y));
    z = hn::MulAdd(bendRatio, constant(joints.move[2][link.joint]), hn::Mul(factor, z));
    scaleBy(constant(call.outs[link.out].scale()), x, y, z);
}

} // namespace HWY_NAMESPACE
} // namespace osgSkin
HWY_AFTER_NAMESPACE();

#endif
