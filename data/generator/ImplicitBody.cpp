// SPDX-License-Identifier: MIT
#include "ImplicitBody.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace mannequin {

double distanceWithin(const Sculpture& part, const glm::dvec3& point, const RoundCone& bounds) {
    constexpr double kFar = 0.12; // metres from a part's bounds beyond which its shape is ignored
    const double d = bounds.distance(point);
    return d > kFar ? d : std::min(part.distance(point), 1.0);
}

glm::dvec3 ImplicitBody::gradient(const glm::dvec3& point) const {
    constexpr double kStep = 2e-4;
    glm::dvec3 result;
    for (int i = 0; i < 3; ++i) {
        glm::dvec3 step(0);
        step[i] = kStep;
        result[i] = (distance(point + step) - distance(point - step)) / (2 * kStep);
    }
    return result;
}

glm::dvec3 ImplicitBody::normal(const glm::dvec3& point) const {
    return glm::normalize(gradient(point));
}

glm::dvec3 ImplicitBody::projected(glm::dvec3 point) const {
    constexpr double kTolerance = 2e-6, kLongestStep = 0.01;
    for (int i = 0; i < 8; ++i) { // Newton's method: the field only approximates a distance
        const double d = distance(point);
        if (std::abs(d) < kTolerance) break;
        const glm::dvec3 slope = gradient(point);
        const double length = glm::length(slope);
        const double step = std::clamp(d / std::max(length, 0.3), -kLongestStep, kLongestStep);
        point -= slope * (step / length);
    }
    return point;
}

} // namespace mannequin
