// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>

namespace osgSkin {

/// A number of two things each, in one of the processor's vectors, as Four is.
struct Two {
    using Vector = double __attribute__((vector_size(16)));
    using Mask = long long __attribute__((vector_size(16)));

    Vector v;

    double operator[](int lane) const noexcept { return v[lane]; }
};

inline Two two(double a, double b) noexcept {
    const Two::Vector v = {a, b};
    return {v};
}
inline Two both(double a) noexcept {
    return two(a, a);
}
inline Two operator+(const Two& a, const Two& b) noexcept {
    return {a.v + b.v};
}
inline Two operator-(const Two& a, const Two& b) noexcept {
    return {a.v - b.v};
}
inline Two operator*(const Two& a, const Two& b) noexcept {
    return {a.v * b.v};
}
inline Two operator/(const Two& a, const Two& b) noexcept {
    return {a.v / b.v};
}
inline Two sqrt(const Two& a) noexcept {
    return two(std::sqrt(a[0]), std::sqrt(a[1]));
}
inline Two abs(const Two& a) noexcept {
    return {a.v < 0.0 ? -a.v : a.v};
}

/// The angle of (x, y) from the x axis, -pi / 2 to pi / 2, to the last digits.
///
/// \param y as long as it is wide
/// \param x not below 0; not 0 where y is
inline Two angleOf(const Two& y, const Two& x) noexcept {
    const Two up = abs(y);
    // Into the middle half of an eighth of a turn: tan(a - pi / 4) = (tan a - 1) / (tan a + 1).
    const Two::Mask steep = up.v > x.v;
    const Two low{steep ? x.v : up.v}, high{steep ? up.v : x.v};
    const Two::Mask far = low.v > 0.41421356237309503 * high.v;
    const Two t{(far ? low.v - high.v : low.v) / (far ? low.v + high.v : high.v)};
    // Chebyshev's fit of atan(t) / t to t^2 there, within 4e-17.
    const Two z = t * t;
    Two sum = both(0.0211353731576932452);
    for (const double c : {-0.04348052215716462478, 0.05688349226809010479, -0.06640233930429408589,
                           0.07689953496306857756, -0.0909077307480841379, 0.1111110618045594522,
                           -0.1428571418097646683, 0.1999999999885511013, -0.3333333333332843857})
        sum = sum * z + both(c);
    Two angle = t + t * (z * sum);
    angle.v += far ? both(0.78539816339744831).v : both(0.0).v;
    angle.v = steep ? 1.5707963267948966 - angle.v : angle.v;
    return {y.v < 0.0 ? -angle.v : angle.v};
}

} // namespace osgSkin
