// SPDX-License-Identifier: MIT
#pragma once

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include <algorithm>
#include <cstddef>
#include <vector>

namespace osgSkin {

/// A foot is planted while it is low and slow; a contact is a run of such samples.
struct ContactLimits {
    double height; ///< above the floor, leg lengths
    double speed;  ///< leg lengths a second; of cycles: shares of the figure's speed

    bool isPlanted(double heightAboveFloor, double footSpeed) const {
        return heightAboveFloor <= height && footSpeed <= speed;
    }
};

// The limits differ on purpose.
constexpr ContactLimits kMotionContact{0.05, 0.3};  ///< captured motions: markers float and jitter
constexpr ContactLimits kCycleContact{0.08, 0.35};  ///< of the ball, which rolls over the toes
constexpr ContactLimits kSpeedContact{0.04, 1e300}; ///< feet that show the figure's speed
constexpr ContactLimits kGroundContact{0.012,
                                       0.5}; ///< of the lowest point of a sole, frame by frame

/// The height of the floor below a foot, or below the lower one of two: a twentieth of the samples
/// may be lower, for files that begin with a pose of their own.
/// \param heights [sample], at least one
inline double floorBelow(std::vector<double> heights) {
    const auto low = heights.begin() + static_cast<std::ptrdiff_t>(heights.size() / 20);
    std::nth_element(heights.begin(), low, heights.end());
    return *low;
}

/// Consecutive samples; they continue at the first one after the last one of a loop.
struct SampleRun {
    std::size_t first = 0, count = 0;
};

/// The runs of samples in which a foot is planted, by their first samples.
/// \param isPlanted whether it is, in a sample
template <typename Planted>
std::vector<SampleRun> contactRuns(std::size_t samples, bool isLoop, const Planted& isPlanted) {
    std::vector<SampleRun> runs;
    for (std::size_t i = 0; i < samples; ++i) {
        if (!isPlanted(i)) continue;
        const std::size_t first = i;
        while (i + 1 < samples && isPlanted(i + 1)) ++i;
        runs.push_back({first, i - first + 1});
    }
    if (isLoop && runs.size() > 1 && runs.front().first == 0 &&
        runs.back().first + runs.back().count == samples) {
        runs.back().count += runs.front().count;
        runs.erase(runs.begin());
    }
    return runs;
}

/// How far a foot slides: its largest distance from where it was first.
/// \param placeOf its place in the k-th sample of the contact, without its height
template <typename Place>
double slideOf(std::size_t count, const Place& placeOf) {
    double most = 0.0;
    for (std::size_t k = 1; k < count; ++k)
        most = std::max(most, glm::distance(placeOf(k), placeOf(0)));
    return most;
}

} // namespace osgSkin
