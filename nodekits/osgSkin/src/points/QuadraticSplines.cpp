// SPDX-License-Identifier: MIT
#include "points/QuadraticSplines.h"

#include <algorithm>

namespace osgSkin {

std::size_t splineCount(const std::vector<double>& knots) noexcept {
    return knots.size() < 2 ? 0 : knots.size() + 1;
}

std::size_t splinesAt(const std::vector<double>& knots, double x, double (&values)[3]) noexcept {
    const std::size_t last = knots.size() - 1;
    x = std::clamp(x, knots.front(), knots.back());
    std::size_t span = 0;
    while (span + 1 < last && x >= knots[span + 1]) ++span;
    const auto knot = [&](std::size_t i, int shift) { // end knots count three times
        const auto at = static_cast<std::ptrdiff_t>(i) + shift;
        return knots[static_cast<std::size_t>(
            std::clamp<std::ptrdiff_t>(at, 0, static_cast<std::ptrdiff_t>(last)))];
    };
    // Cox and de Boor's recursion, from the one spline of degree 0 that is not 0 here.
    const double low = knot(span, 0), high = knot(span, 1);
    const double up = (x - low) / (high - low);
    const double before = knot(span, -1), behind = knot(span, 2);
    const double left = (high - x) / (high - before), right = (behind - x) / (behind - low);
    values[0] = left * (1.0 - up);
    values[1] = (1.0 - left) * (1.0 - up) + right * up;
    values[2] = (1.0 - right) * up;
    return span;
}

void evaluateSplines(const std::vector<double>& knots, double x, double* values) noexcept {
    const std::size_t count = splineCount(knots);
    if (count == 0) return;
    std::fill_n(values, count, 0.0);
    double three[3];
    const std::size_t first = splinesAt(knots, x, three);
    std::copy_n(three, 3, values + first);
}

} // namespace osgSkin
