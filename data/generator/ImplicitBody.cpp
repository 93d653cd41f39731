// SPDX-License-Identifier: MIT
#include "ImplicitBody.h"
#include "BodyArm.h"
#include "BodyHead.h"
#include "BodyLeg.h"
#include "BodyParts.h"
#include "BodyTrunk.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace mannequin {
namespace {

constexpr double kFar = 0.12; // metres from a part's bounds beyond which its shape is ignored

/// Distance to a part, or to its bounds if those are far away: there the field is only used to
/// skip empty space.
double bounded(const Sculpture& part, const glm::dvec3& point, const RoundCone& bounds) {
    const double d = bounds.distance(point);
    return d > kFar ? d : std::min(part.distance(point), 1.0);
}

const RoundCone kTrunkBounds{{0, 0.98, -0.01}, {0, 1.40, -0.02}, 0.20, 0.20};
const RoundCone kHeadBounds{{0, 1.69, 0}, {0, 1.45, -0.03}, 0.15, 0.12};
const RoundCone kArmBounds{{0.19, 1.44, -0.03}, {0.70, 1.00, 0.04}, 0.10, 0.12};
const RoundCone kLegBounds{{0.09, 0.95, 0}, {0.14, 0.06, 0.05}, 0.13, 0.18};

} // namespace

ImplicitBody::ImplicitBody()
    : _trunk(sculptTrunk()), _head(sculptHead()), _arm(sculptArm()), _leg(sculptLeg()) {}

double ImplicitBody::distance(const glm::dvec3& point) const {
    const glm::dvec3 other = mirrored(point);
    const double legs =
        smoothMin(bounded(_leg, point, kLegBounds), bounded(_leg, other, kLegBounds), 0.012);
    const double arms =
        std::min(bounded(_arm, point, kArmBounds), bounded(_arm, other, kArmBounds));
    double result = bounded(_trunk, point, kTrunkBounds);
    result = smoothMin(result, bounded(_head, point, kHeadBounds), 0.038);
    result = smoothMin(result, legs, 0.040);
    return smoothMin(result, arms, 0.035);
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

glm::dvec3 ImplicitBody::lowerCorner() const {
    return {-0.86, -0.04, -0.24};
}
glm::dvec3 ImplicitBody::upperCorner() const {
    return {0.86, 1.86, 0.30};
}

} // namespace mannequin
