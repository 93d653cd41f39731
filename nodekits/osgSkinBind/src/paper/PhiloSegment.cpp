// SPDX-License-Identifier: GPL-3.0-or-later
#include "paper/PhiloSegment.h"

#include <algorithm>
#include <cmath>

namespace osgSkin {
namespace {

/// Newton's steps stay between bounds, so few are needed; more only where bisection has to help.
constexpr int kMostSteps = 100;
constexpr double kTolerance = 1e-14;

/// A point this near to one plane, for its distance to the other, is on it; in a wide wedge the
/// root grows without limit towards it.
constexpr double kNothing = 1e-60;

/// The condition on x, the cotangent of the angle at which the segment meets the upper plane.
///
/// A segment at that angle A has the length a / sin A + b / sin(A + angle), with the distances a
/// and b to the upper and lower plane: convex in A, so there is one minimum. Setting the derivative
/// to zero and writing it in x gives
///
///     a x (x s + c)^2 + b (x c - s) = 0,    s = sin(angle), c = cos(angle),
///
/// a cubic with one root where x >= 0 and x s + c > 0 (the segment meets both planes).
struct Cubic {
    double a, b, s, c;

    double value(double x) const {
        const double m = x * s + c;
        return a * x * m * m + b * (x * c - s);
    }
    double slope(double x) const {
        const double m = x * s + c;
        return a * m * (m + 2.0 * x * s) + b * c;
    }
};

double root(const Cubic& cubic) {
    // Below the root the value is negative, above it is positive.
    double low = std::max(0.0, -cubic.c / cubic.s);
    double high = 2.0 * low + 1.0;
    while (cubic.value(high) < 0.0) high *= 2.0;
    double x = 0.5 * (low + high);
    for (int step = 0; step < kMostSteps; ++step) {
        const double value = cubic.value(x);
        (value < 0.0 ? low : high) = x;
        const double slope = cubic.slope(x);
        double next = slope > 0.0 ? x - value / slope : low;
        if (!(next > low && next < high)) next = 0.5 * (low + high);
        if (std::abs(next - x) <= kTolerance * (1.0 + x)) return next;
        x = next;
    }
    return x;
}

} // namespace

double philoShare(double toUpper, double toLower, double angle) {
    const double sum = toUpper + toLower;
    if (!(toUpper > kNothing * sum)) return 0.0;
    if (!(toLower > kNothing * sum)) return 1.0;
    const double sine = std::sin(angle), cosine = std::cos(angle);
    if (!(sine > 1e-9)) return toUpper / sum;
    const Cubic cubic{toUpper / sum, toLower / sum, sine, cosine};
    // The parts of the segment are as a to b / (x s + c).
    const double lower = cubic.b / (root(cubic) * sine + cosine);
    return cubic.a / (cubic.a + lower);
}

} // namespace osgSkin
