// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <vector>

namespace osgSkin {

/// Number of quadratic B-splines over ascending knots, the first and the last of which count three
/// times; 0 where there are fewer than two knots.
std::size_t splineCount(const std::vector<double>& knots) noexcept;

/// The values at x, which is taken to lie within the knots, of the three splines that are not 0
/// there.
///
/// \param knots at least two
/// \return which is the first of them
std::size_t splinesAt(const std::vector<double>& knots, double x, double (&values)[3]) noexcept;

/// All splines' values at x, which is taken to lie within the knots; splineCount() of them. They
/// add up to 1.
void evaluateSplines(const std::vector<double>& knots, double x, double* values) noexcept;

} // namespace osgSkin
