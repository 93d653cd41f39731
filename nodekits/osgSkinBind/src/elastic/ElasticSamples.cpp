// SPDX-License-Identifier: GPL-3.0-or-later
#include "elastic/ElasticSamples.h"

#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>
#include <glm/trigonometric.hpp>

#include <cmath>

namespace osgSkin {
namespace {

const double kLargestStep = glm::radians(15.0);
const double kSideways = glm::radians(20.0);

/// At these shares of the flexion from the rest pose a hinge is also bent sideways.
constexpr double kSidewaysAt[] = {0.4, 0.75, 1.0};

constexpr int kDirections = 8;
constexpr int kAngles = 3;

/// Angles from 0 (not counted) to `end` in equal steps.
void addSteps(double end, const glm::dvec3& axis, std::vector<glm::dquat>& samples) {
    const int steps = static_cast<int>(std::ceil(std::abs(end) / kLargestStep - 1e-9));
    for (int i = 1; i <= steps; ++i) samples.push_back(glm::angleAxis(end * i / steps, axis));
}

} // namespace

std::vector<glm::dquat> hingeSamples(const HingeRange& range, const glm::dvec3& pole) {
    const glm::dvec3 axis = glm::normalize(range.axis - pole * glm::dot(range.axis, pole));
    const double flex = range.mostFlexion - range.restFlexion;
    std::vector<glm::dquat> samples;
    addSteps(flex, axis, samples);
    addSteps(range.leastFlexion - range.restFlexion, axis, samples);
    for (const double share : kSidewaysAt)
        for (const double turn : {-kSideways, kSideways})
            samples.push_back(glm::angleAxis(share * flex, glm::angleAxis(turn, pole) * axis));
    for (const double turn : {-kSideways, kSideways})
        samples.push_back(glm::angleAxis(turn, glm::cross(pole, axis)));
    return samples;
}

std::vector<glm::dquat> ballSamples(const glm::dvec3& pole, double most) {
    const glm::dvec3 beside =
        std::abs(pole.x) < 0.7 ? glm::dvec3(1.0, 0.0, 0.0) : glm::dvec3(0.0, 1.0, 0.0);
    const glm::dvec3 first = glm::normalize(beside - pole * glm::dot(beside, pole));
    std::vector<glm::dquat> samples;
    for (int direction = 0; direction < kDirections; ++direction) {
        const double turn = 2.0 * glm::pi<double>() * direction / kDirections;
        const glm::dvec3 axis = glm::angleAxis(turn, pole) * first;
        for (int i = 1; i <= kAngles; ++i)
            samples.push_back(glm::angleAxis(most * i / kAngles, axis));
    }
    return samples;
}

} // namespace osgSkin
