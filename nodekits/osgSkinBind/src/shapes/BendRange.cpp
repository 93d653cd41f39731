// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapes/BendRange.h"

#include <osgSkin/GlmTypes>

#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <cmath>

namespace osgSkin {
namespace {

/// Angles in degrees. How far a hinge goes beyond straight and to the sides.
constexpr double kBeyondStraight = 12.0;
constexpr double kSideways = 30.0;
/// Between the angles that a hinge is bent sideways at, too; between knots; between samples.
constexpr double kSidewaysStep = 30.0;
/// How far a hinge turns about the limb, and between samples of that.
constexpr double kTurn = 32.0;
constexpr double kTurnStep = 16.0;
/// Share of the range of a coordinate in which it is not clamped.
constexpr double kNotClamped = 0.9;
constexpr double kRoundKnotStep = 20.0;
constexpr double kSampleStep = 15.0;
constexpr double kRoundSampleStep = 10.0;
constexpr int kDirections = 12;

double sineOfHalf(double degrees) {
    return std::sin(glm::radians(0.5 * degrees));
}

double degreesOf(double sineOfHalfAngle) {
    return glm::degrees(2.0 * std::asin(sineOfHalfAngle));
}

/// Evenly from `from` to `to`, at most `step` apart.
std::vector<double> steps(double from, double to, double step) {
    const int count = std::max(1, static_cast<int>(std::ceil((to - from) / step - 1e-9)));
    std::vector<double> result;
    for (int i = 0; i <= count; ++i) result.push_back(from + (to - from) * i / count);
    return result;
}

void setHinge(const glm::dvec3& axis, double mostFlexion, double knotStep, ShapedJoint& joint) {
    const double atRest = glm::degrees(std::atan2(
        glm::dot(glm::cross(joint.above, joint.bone), axis), glm::dot(joint.above, joint.bone)));
    const double most = std::clamp(mostFlexion - atRest, 30.0, 170.0);
    const double least = -std::clamp(kBeyondStraight + atRest, 15.0, 90.0);
    CorrectiveJoint& functions = joint.functions;
    functions.basis = CorrectiveJoint::Basis::Hinge;
    functions.axis = axis;
    functions.low = {sineOfHalf(least), -sineOfHalf(kSideways)};
    functions.high = {sineOfHalf(most), sineOfHalf(kSideways)};
    for (const double angle : steps(least, most, knotStep))
        functions.knots.push_back(sineOfHalf(angle));
}

glm::dvec3 perpendicular(const glm::dvec3& across, const glm::dvec3& w) {
    const glm::dvec3 result = across - glm::dot(across, w) * w;
    const double length = glm::length(result);
    return length > 1e-3 * glm::length(across) ? result / length : anyPerpendicular(w);
}

void setRound(double mostFlexion, const glm::dvec3& across, ShapedJoint& joint) {
    CorrectiveJoint& functions = joint.functions;
    const double most = sineOfHalf(mostFlexion);
    functions.basis = CorrectiveJoint::Basis::Round;
    functions.axis = perpendicular(across, joint.twistAxis);
    functions.low = glm::dvec2(-most);
    functions.high = glm::dvec2(most);
    for (const double angle : steps(0.0, mostFlexion, kRoundKnotStep))
        functions.knots.push_back(sineOfHalf(angle) * sineOfHalf(angle));
}

} // namespace

void setBendRange(const std::optional<glm::dvec3>& mainAxis, const glm::dvec3& across,
                  ShapedJoint& joint, double mostFlexion, double knotStep) {
    if (mainAxis)
        setHinge(*mainAxis, mostFlexion, knotStep, joint);
    else
        setRound(mostFlexion, across, joint);
}

void setBallRange(const glm::dvec3& across, ShapedJoint& joint, double mostSwing) {
    CorrectiveJoint& functions = joint.functions;
    functions.basis = CorrectiveJoint::Basis::Ball;
    functions.axis = perpendicular(across, joint.twistAxis);
    functions.low = glm::dvec2(-sineOfHalf(mostSwing));
    functions.high = -functions.low;
}

void setTurnedHinge(ShapedJoint& joint) {
    CorrectiveJoint& functions = joint.functions;
    functions.basis = CorrectiveJoint::Basis::TurnedHinge;
    double low = functions.low.y, high = functions.high.y;
    for (const BendTwist& bend : turnedBends(joint)) {
        const double y = functions.coordinates(bend.bendAxis, bend.bendAngle, joint.twistAxis).y;
        low = std::min(low, y / kNotClamped);
        high = std::max(high, y / kNotClamped);
    }
    functions.low.y = low;
    functions.high.y = high;
}

std::vector<BendTwist> turnedBends(const ShapedJoint& joint) {
    const CorrectiveJoint& functions = joint.functions;
    std::vector<BendTwist> bends;
    for (const double angle :
         steps(degreesOf(functions.low.x), degreesOf(functions.high.x), kSampleStep)) {
        if (std::abs(angle) < 1.0) continue;
        const glm::dquat bent = glm::angleAxis(glm::radians(angle), joint.hinge);
        for (const double turn : steps(-kTurn, kTurn, kTurnStep))
            bends.push_back(splitBendTwist(glm::angleAxis(glm::radians(turn), joint.above) * bent *
                                               glm::angleAxis(glm::radians(-turn), joint.bone),
                                           joint.twistAxis));
    }
    return bends;
}

std::vector<glm::dvec2> bendSamples(const ShapedJoint& joint) {
    const CorrectiveJoint& functions = joint.functions;
    std::vector<glm::dvec2> samples;
    if (functions.basis == CorrectiveJoint::Basis::Hinge) {
        const double least = degreesOf(functions.low.x), most = degreesOf(functions.high.x);
        for (const double angle : steps(least, most, kSampleStep))
            if (std::abs(angle) > 1.0) samples.emplace_back(sineOfHalf(angle), 0.0);
        for (const double angle : steps(least, most, kSidewaysStep))
            for (const double side : {functions.low.y, functions.high.y}) {
                const glm::dvec2 xy(sineOfHalf(angle), 0.75 * side);
                samples.push_back(xy * std::min(1.0, 0.99 / glm::length(xy)));
            }
        return samples;
    }
    for (const double angle : steps(0.0, degreesOf(functions.high.x), kRoundSampleStep))
        for (int i = 0; angle > 0.0 && i < kDirections; ++i) {
            const double direction = 2.0 * glm::pi<double>() * i / kDirections;
            samples.push_back(sineOfHalf(angle) *
                              glm::dvec2(std::cos(direction), std::sin(direction)));
        }
    return samples;
}

} // namespace osgSkin
