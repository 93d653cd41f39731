// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBINDER_REGIONS_HERMITERATIO_H
#define OSGSKINBINDER_REGIONS_HERMITERATIO_H

#include <algorithm>
#include <optional>

namespace osgSkin {

/// Eq. 5 (paper, section 3): the ratio at t between a region's upper boundary (0) and its lower one
/// (1), by the cubic Hermite polynomial that is flat at both. Exactly 0 for t <= 0, 1 for t >= 1.
inline double hermiteRatio(double t) {
    t = std::clamp(t, 0.0, 1.0);
    return t * t * (3.0 - 2.0 * t);
}

/// The upper and lower boundary of a bend or twist region (paper, Fig. 3): along a bone from the
/// joint's centre, in units of that bone's length, negative towards the parent.
struct BoundarySpan {
    double upper;
    double lower;
};

/// The boundaries that the author gave, else the defaults. If only one is given, and lies beyond
/// the other's default, the other keeps the default distance.
inline BoundarySpan chosenSpan(const std::optional<double>& upper,
                               const std::optional<double>& lower, const BoundarySpan& defaults) {
    BoundarySpan span{upper.value_or(defaults.upper), lower.value_or(defaults.lower)};
    if (span.upper < span.lower) return span;
    const double width = defaults.lower - defaults.upper;
    if (upper)
        span.lower = span.upper + width;
    else
        span.upper = span.lower - width;
    return span;
}

} // namespace osgSkin

#endif
