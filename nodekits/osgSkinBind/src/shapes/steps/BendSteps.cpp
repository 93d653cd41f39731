// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapes/steps/BendSteps.h"

#include <glm/gtc/constants.hpp>
#include <glm/trigonometric.hpp>

#include <cmath>

namespace osgSkin {
namespace {

/// So many axes, each as far as a joint can turn, degrees.
constexpr int kAxes = 8, kMostBend = 176, kBendStep = 4;

/// Coordinates that are clamped by less count as in range.
constexpr double kHardlyClamped = 0.02;

BendSteps::Bend bendAt(const ShapedJoint& joint, const CorrectiveJoint& functions,
                       const glm::dvec2& xy) {
    BendSteps::Bend result{joint.bendAt(xy), {}};
    functions.weights(xy, result.weights.data());
    return result;
}

} // namespace

BendSteps::BendSteps(const ShapedJoint& joint, const CorrectiveJoint& functions) {
    for (int i = 0; i < kAxes; ++i) {
        const double direction = glm::pi<double>() * i / kAxes;
        const glm::dvec2 way(std::cos(direction), std::sin(direction));
        const glm::dvec3 axis = joint.bendAt(way * 0.5).bendAxis;
        for (int degrees = -kMostBend; degrees < kMostBend; degrees += kBendStep) {
            const glm::dvec2 from = std::sin(glm::radians(0.5 * degrees)) * way,
                             to = std::sin(glm::radians(0.5 * (degrees + 1))) * way;
            _steps.push_back({bendAt(joint, functions, from), bendAt(joint, functions, to), axis,
                              glm::distance(functions.clamped(to), to) < kHardlyClamped});
        }
    }
}

double BendSteps::rigid() {
    return 2.0 * std::sin(glm::radians(0.5));
}

} // namespace osgSkin
