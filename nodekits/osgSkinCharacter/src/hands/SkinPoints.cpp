// SPDX-License-Identifier: GPL-3.0-or-later
#include "hands/SkinPoints.h"

#include <algorithm>
#include <limits>

namespace osgSkin {

SkinPoints SkinPoints::spread(std::size_t most) const {
    if (size() <= most) return *this;
    // Fine meshes are thinned out first: the loop below takes time for each point and sample.
    const std::size_t step = std::max<std::size_t>(1, size() / 20000);
    SkinPoints result;
    std::vector<double> far(size(), std::numeric_limits<double>::infinity());
    std::size_t next = 0;
    while (result.size() < most) {
        result.add(places[next], normals[next], joints[next]);
        const glm::dvec3 last = places[next];
        double largest = 0.0;
        for (std::size_t i = 0; i < size(); i += step) {
            const glm::dvec3 d = places[i] - last;
            far[i] = std::min(far[i], glm::dot(d, d));
            if (far[i] <= largest) continue;
            largest = far[i];
            next = i;
        }
        if (largest <= 0.0) break; // only copies are left
    }
    return result;
}

SkinPoints SkinPoints::averaged(std::size_t most) const {
    SkinPoints result = spread(most);
    const SkinPoints samples = result;
    std::vector<glm::dvec3> placeSums(samples.size(), glm::dvec3(0.0)), normalSums = placeSums;
    std::vector<double> counts(samples.size(), 0.0);
    for (std::size_t i = 0; i < size(); ++i) {
        double least = std::numeric_limits<double>::infinity();
        std::size_t nearest = 0;
        for (std::size_t k = 0; k < samples.size(); ++k) {
            const glm::dvec3 d = samples.places[k] - places[i];
            const double square = glm::dot(d, d);
            if (samples.joints[k] != joints[i] || !(square < least)) continue;
            least = square;
            nearest = k;
        }
        if (!(least < std::numeric_limits<double>::infinity())) continue;
        placeSums[nearest] += places[i];
        normalSums[nearest] += normals[i];
        counts[nearest] += 1.0;
    }
    for (std::size_t k = 0; k < samples.size(); ++k) {
        const double length = glm::length(normalSums[k]);
        if (!(length > 0.0)) continue;
        result.places[k] = placeSums[k] / counts[k];
        result.normals[k] = normalSums[k] / length;
    }
    return result;
}

} // namespace osgSkin
