// SPDX-License-Identifier: MIT
#include "rig/SampleGrid.h"

#include <algorithm>
#include <cmath>

namespace osgSkin {
namespace {

constexpr double kMinRate = 29.9; ///< 30, and NTSC's 29.97
constexpr int kMaxRate = 240, kFreeRate = 120;
constexpr double kMaxSteps = 1e15; ///< far more than anybody allows
constexpr double kOff = 0.05;      ///< of a step: times are rounded to milliseconds in some formats

/// Whether all keys stand on samples, seconds after the first.
bool fits(const std::vector<double>& keys, double rate) {
    return std::all_of(keys.begin(), keys.end(), [rate](double key) {
        return std::abs(key * rate - std::round(key * rate)) <= kOff;
    });
}

double rateOf(const std::vector<double>& keys) {
    const double own = static_cast<double>(keys.size() - 1) / keys.back(); // where keys are even
    const double multiple = own * std::max(1.0, std::ceil(kMinRate / own));
    if (fits(keys, multiple)) return multiple;
    for (int rate = 30; rate <= kMaxRate; ++rate)
        if (fits(keys, rate)) return rate;
    return kFreeRate;
}

} // namespace

SampleGrid::SampleGrid(std::vector<double> times) {
    std::sort(times.begin(), times.end());
    _first = times.front();
    const double span = times.back() - _first;
    if (!(span > 0.0)) return;
    for (double& time : times) time -= _first;
    // Tracks share their keys' times, but for rounding.
    const double same = 1e-6 * span;
    times.erase(std::unique(times.begin(), times.end(),
                            [same](double a, double b) { return b - a <= same; }),
                times.end());
    times.back() = span;
    const double steps = std::max(1.0, std::ceil(std::min(span * rateOf(times), kMaxSteps) - kOff));
    _samples = static_cast<std::size_t>(steps) + 1;
    _step = span / steps;
}

} // namespace osgSkin
