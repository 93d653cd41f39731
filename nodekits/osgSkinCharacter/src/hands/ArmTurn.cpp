// SPDX-License-Identifier: GPL-3.0-or-later
#include "hands/ArmTurn.h"

#include <osgSkinCharacter/ClearHands>

#include <glm/matrix.hpp>
#include <glm/trigonometric.hpp>

#include <algorithm>

namespace osgSkin {
namespace {

constexpr double kMargin = 0.01;  ///< arm lengths from the skin where turning begins
constexpr double kLeverage = 0.4; ///< arm lengths; shorter levers are not pulled in full
constexpr int kSteps = 8;

/// 0 below 0, and 1 in slope above `width`, smooth between.
double hinge(double x, double width) {
    return x >= width ? x - 0.5 * width : 0.5 * x * x / width;
}

double hingeSlope(double x, double width) {
    return std::min(x / width, 1.0);
}

glm::dquat fromVector(const glm::dvec3& rotation) {
    const double angle = glm::length(rotation);
    if (angle < 1e-12) return glm::normalize(glm::dquat(1.0, 0.5 * rotation));
    return {std::cos(0.5 * angle), std::sin(0.5 * angle) / angle * rotation};
}

/// The vector itself while it is short; all steps together never make more than
/// ClearedHands::kMostDegrees.
glm::dvec3 limited(const glm::dvec3& step) {
    const double share = glm::length(step) * kSteps / glm::radians(ClearedHands::kMostDegrees);
    return step / std::sqrt(1.0 + share * share);
}

} // namespace

ArmTurn::ArmTurn(const ArmPiece& arm, const std::vector<BodySurface>& surfaces,
                 const PosedJoints& atRest)
    : _arm(arm), _surfaces(surfaces), _margin(kMargin * arm.length) {
    _allowed.reserve(surfaces.size() * arm.skin.size());
    for (const BodySurface& surface : surfaces)
        for (std::size_t i = 0; i < arm.skin.size(); ++i) {
            const glm::dvec3 place = atRest.place(arm.skin.places[i], arm.skin.joints[i]);
            const double depth =
                surface.isNear(place, _margin) ? surface.depth(place).depth : -_margin;
            _allowed.push_back(std::max(depth, -_margin));
        }
    _fromJoint.resize(arm.skin.size());
}

glm::dvec3 ArmTurn::step(const glm::dquat& turn) const {
    // Each contact wants rotation . gradient = -depth; the deeper, the more it counts.
    glm::dmat3 normal(0.0);
    glm::dvec3 wanted(0.0);
    double weights = 0.0;
    for (std::size_t i = 0; i < _fromJoint.size(); ++i) {
        const glm::dvec3 lever = turn * _fromJoint[i];
        const glm::dvec3 place = _shoulder + lever;
        for (std::size_t s = 0; s < _surfaces.size(); ++s) {
            if (!_surfaces[s].isNear(place, _margin)) continue;
            const BodySurface::Depth at = _surfaces[s].depth(place);
            const double beyond = at.depth - _allowed[s * _fromJoint.size() + i];
            if (!(beyond > 0.0)) continue;
            const double depth = hinge(beyond, _margin) / _arm.length;
            const glm::dvec3 gradient =
                -hingeSlope(beyond, _margin) / _arm.length * glm::cross(lever, at.out);
            const double weight = depth;
            normal += weight * glm::outerProduct(gradient, gradient);
            wanted -= weight * depth * gradient;
            weights += weight;
        }
    }
    if (!(weights > 0.0)) return glm::dvec3(0.0);
    for (int k = 0; k < 3; ++k) normal[k][k] += weights * kLeverage * kLeverage;
    return limited(glm::inverse(normal) * wanted);
}

glm::dquat ArmTurn::find(const PosedJoints& pose) {
    _shoulder = pose.centres[_arm.upper];
    for (std::size_t i = 0; i < _fromJoint.size(); ++i)
        _fromJoint[i] = pose.place(_arm.skin.places[i], _arm.skin.joints[i]) - _shoulder;
    glm::dquat turn(1.0, 0.0, 0.0, 0.0);
    for (int k = 0; k < kSteps; ++k) {
        const glm::dvec3 further = step(turn);
        if (further == glm::dvec3(0.0)) break; // and so would all others be
        turn = glm::normalize(fromVector(further) * turn);
    }
    return turn;
}

} // namespace osgSkin
