// SPDX-License-Identifier: MIT
#include "retarget/FootContacts.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace osgSkin {
namespace {

constexpr double kLow = 0.05;           // leg lengths
constexpr double kSlow = 0.3;           // leg lengths a second
constexpr double kHalfWindow = 1 / 60.; // seconds: what samples jitter does not count as speed
constexpr double kShortest = 0.1;       // seconds

} // namespace

double standingHeight(const std::vector<glm::dvec3>& positions) {
    std::vector<double> heights;
    heights.reserve(positions.size());
    for (const glm::dvec3& position : positions) heights.push_back(position.y);
    const auto low = heights.begin() + static_cast<std::ptrdiff_t>(heights.size() / 20);
    std::nth_element(heights.begin(), low, heights.end());
    return *low;
}

std::vector<FootContact> findFootContacts(const std::vector<glm::dvec3>& positions,
                                          double frameTime, double floor, double leg) {
    const std::size_t end = positions.size();
    const auto reach = static_cast<std::size_t>(
        std::clamp(std::round(kHalfWindow / frameTime), 1.0, static_cast<double>(end)));
    const auto isPlanted = [&](std::size_t f) {
        if (positions[f].y > floor + kLow * leg) return false;
        const std::size_t before = f - std::min(f, reach);
        const std::size_t after = std::min(f + reach, end - 1);
        const double seconds = static_cast<double>(after - before) * frameTime;
        return glm::distance(positions[before], positions[after]) <= kSlow * leg * seconds;
    };
    std::vector<FootContact> result;
    for (std::size_t f = 0; f < end; ++f) {
        if (!isPlanted(f)) continue;
        const std::size_t first = f;
        while (f + 1 < end && isPlanted(f + 1)) ++f;
        if (static_cast<double>(f - first) * frameTime >= kShortest * (1.0 - 1e-9))
            result.push_back({first, f});
    }
    return result;
}

} // namespace osgSkin
