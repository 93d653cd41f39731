// SPDX-License-Identifier: MIT
//
// Included once for each instruction set, through foreach_target.h.
#if defined(OSGSKIN_DOUBLES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef OSGSKIN_DOUBLES_INL_H
#undef OSGSKIN_DOUBLES_INL_H
#else
#define OSGSKIN_DOUBLES_INL_H
#endif

#include <hwy/highway.h>

#include <cstddef>

HWY_BEFORE_NAMESPACE();
namespace osgSkin {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// One number of each of up to four joints.
using DoubleTag = hn::CappedTag<double, 4>;
using Doubles = hn::Vec<DoubleTag>;
using DoubleMask = hn::Mask<DoubleTag>;

HWY_INLINE Doubles allOf(double x) {
    return hn::Set(DoubleTag(), x);
}

template <typename V>
HWY_INLINE V dot(const V (&a)[3], const V (&b)[3]) {
    return hn::MulAdd(a[2], b[2], hn::MulAdd(a[1], b[1], hn::Mul(a[0], b[0])));
}

template <typename V>
HWY_INLINE void cross(const V (&a)[3], const V (&b)[3], V (&to)[3]) {
    to[0] = hn::MulSub(a[1], b[2], hn::Mul(a[2], b[1]));
    to[1] = hn::MulSub(a[2], b[0], hn::Mul(a[0], b[2]));
    to[2] = hn::MulSub(a[0], b[1], hn::Mul(a[1], b[0]));
}

/// Loads four adjacent numbers per lane, transposed.
///
/// \param from one array per lane
HWY_INLINE void loadFour(const double* const* from, std::size_t at, Doubles (&to)[4]) {
    const DoubleTag d;
#if HWY_TARGET <= HWY_AVX2
    const Doubles a = hn::LoadU(d, from[0] + at), b = hn::LoadU(d, from[1] + at),
                  e = hn::LoadU(d, from[2] + at), f = hn::LoadU(d, from[3] + at);
    const Doubles even = hn::InterleaveLower(d, a, b), odd = hn::InterleaveUpper(d, a, b);
    const Doubles even2 = hn::InterleaveLower(d, e, f), odd2 = hn::InterleaveUpper(d, e, f);
    to[0] = hn::ConcatLowerLower(d, even2, even);
    to[1] = hn::ConcatLowerLower(d, odd2, odd);
    to[2] = hn::ConcatUpperUpper(d, even2, even);
    to[3] = hn::ConcatUpperUpper(d, odd2, odd);
#elif HWY_TARGET == HWY_SSSE3 || HWY_TARGET == HWY_SSE4
    for (std::size_t half = 0; half < 4; half += 2) {
        const Doubles a = hn::LoadU(d, from[0] + at + half), b = hn::LoadU(d, from[1] + at + half);
        to[half] = hn::InterleaveLower(d, a, b);
        to[half + 1] = hn::InterleaveUpper(d, a, b);
    }
#else
    for (std::size_t i = 0; i < 4; ++i) {
        double lanes[4];
        for (std::size_t lane = 0; lane < hn::Lanes(d); ++lane) lanes[lane] = from[lane][at + i];
        to[i] = hn::LoadU(d, lanes);
    }
#endif
}

/// Gathers row[at[lane]].
HWY_INLINE Doubles loadEach(const double* row, const int* at) {
    const DoubleTag d;
#if HWY_TARGET <= HWY_AVX2
    // About as fast as the gather instruction, and much faster where that is slow.
    return Doubles{_mm256_setr_pd(row[at[0]], row[at[1]], row[at[2]], row[at[3]])};
#else
    double lanes[4];
    for (std::size_t lane = 0; lane < hn::Lanes(d); ++lane) lanes[lane] = row[at[lane]];
    return hn::LoadU(d, lanes);
#endif
}

/// The angle of (x, y) from the x axis, -pi / 2 to pi / 2, to the last digits.
///
/// \param x not negative; not 0 where y is 0
template <typename V>
HWY_INLINE V angleOf(const V& y, const V& x) {
    const auto all = [](double number) HWY_ATTR { return hn::Set(hn::DFromV<V>(), number); };
    const V up = hn::Abs(y);
    // Into the middle half of an eighth of a turn: tan(a - pi / 4) = (tan a - 1) / (tan a + 1).
    const auto steep = hn::Gt(up, x);
    const V low = hn::Min(up, x), high = hn::Max(up, x);
    const auto beyond = hn::Gt(low, hn::Mul(all(0.41421356237309503), high));
    const V t = hn::Div(hn::IfThenElse(beyond, hn::Sub(low, high), low),
                        hn::IfThenElse(beyond, hn::Add(low, high), high));
    // Chebyshev's fit of atan(t) / t to t^2 there, within 4e-17; even and odd powers at a time.
    const V z = hn::Mul(t, t), zz = hn::Mul(z, z);
    const auto sum = [&](std::initializer_list<double> terms) HWY_ATTR {
        const double* c = terms.begin();
        V result = all(*c++);
        while (c != terms.end()) result = hn::MulAdd(result, zz, all(*c++));
        return result;
    };
    const V odd = sum({0.0211353731576932452, 0.05688349226809010479, 0.07689953496306857756,
                       0.1111110618045594522, 0.1999999999885511013});
    const V even = sum({-0.04348052215716462478, -0.06640233930429408589, -0.0909077307480841379,
                        -0.1428571418097646683, -0.3333333333332843857});
    V angle = hn::MulAdd(t, hn::Mul(z, hn::MulAdd(odd, z, even)), t);
    angle = hn::Add(angle, hn::IfThenElseZero(beyond, all(0.78539816339744831)));
    angle = hn::IfThenElse(steep, hn::Sub(all(1.5707963267948966), angle), angle);
    return hn::CopySign(angle, y);
}

} // namespace HWY_NAMESPACE
} // namespace osgSkin
HWY_AFTER_NAMESPACE();

#endif
