// SPDX-License-Identifier: MIT
#include "BareBody.h"

#include "BodyArm.h"
#include "BodyHead.h"
#include "BodyLeg.h"
#include "BodyTrunk.h"

#include <algorithm>

namespace mannequin {
namespace {

const RoundCone kTrunkBounds{{0, 0.98, -0.01}, {0, 1.40, -0.02}, 0.20, 0.20};
const RoundCone kHeadBounds{{0, 1.69, 0}, {0, 1.45, -0.03}, 0.15, 0.12};
const RoundCone kArmBounds{{0.19, 1.44, -0.03}, {0.70, 1.00, 0.04}, 0.10, 0.12};
const RoundCone kLegBounds{{0.09, 0.95, 0}, {0.14, 0.06, 0.05}, 0.13, 0.18};

} // namespace

BareBody::BareBody()
    : _trunk(sculptTrunk()), _head(sculptHead()), _arm(sculptArm()), _leg(sculptLeg()) {}

double BareBody::distance(const glm::dvec3& point) const {
    const glm::dvec3 other = mirrored(point);
    const double legs = smoothMin(distanceWithin(_leg, point, kLegBounds),
                                  distanceWithin(_leg, other, kLegBounds), 0.012);
    const double arms =
        std::min(distanceWithin(_arm, point, kArmBounds), distanceWithin(_arm, other, kArmBounds));
    double result = distanceWithin(_trunk, point, kTrunkBounds);
    result = smoothMin(result, distanceWithin(_head, point, kHeadBounds), 0.038);
    result = smoothMin(result, legs, 0.040);
    return smoothMin(result, arms, 0.035);
}

glm::dvec3 BareBody::lowerCorner() const {
    return {-0.86, -0.04, -0.24};
}
glm::dvec3 BareBody::upperCorner() const {
    return {0.86, 1.86, 0.30};
}

} // namespace mannequin
