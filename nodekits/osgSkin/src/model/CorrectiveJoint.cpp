// SPDX-License-Identifier: MIT
#include <osgSkin/CorrectiveJoint>

#include "model/QuadraticSplines.h"

#include <glm/geometric.hpp>

#include <cmath>

namespace osgSkin {
namespace {

/// Where the soft clamp leaves the straight line.
constexpr double kStraight = 0.9;
constexpr double kSoft = 1.0 - kStraight;

/// t for t <= kStraight, then towards 1 and never beyond: two continuous derivatives.
double softClamp(double t) noexcept {
    return t <= kStraight ? t : kStraight + kSoft * std::tanh((t - kStraight) / kSoft);
}

/// A coordinate as a share of what was sampled on its side; not negative.
double shareOf(double x, double low, double high) noexcept {
    return x > 0.0 ? x / high : x / low;
}

double clampedAlone(double x, double low, double high) noexcept {
    return softClamp(shareOf(x, low, high)) * (x > 0.0 ? high : low);
}

} // namespace

std::size_t CorrectiveJoint::functionCount() const noexcept {
    switch (basis) {
    case Basis::Hinge:
        return splineCount(knots) + 3;
    case Basis::Ball:
        return 9;
    case Basis::Round:
        return 7 * splineCount(knots);
    }
    return 0;
}

glm::dvec2 CorrectiveJoint::coordinates(const glm::dvec3& v, double psi,
                                        const glm::dvec3& w) const noexcept {
    const double sine = std::sin(0.5 * psi);
    return {sine * glm::dot(v, axis), sine * glm::dot(v, glm::cross(w, axis))};
}

glm::dvec2 CorrectiveJoint::clamped(glm::dvec2 xy) const noexcept {
    if (basis == Basis::Hinge)
        return {clampedAlone(xy.x, low.x, high.x), clampedAlone(xy.y, low.y, high.y)};
    const double r =
        glm::length(glm::dvec2(shareOf(xy.x, low.x, high.x), shareOf(xy.y, low.y, high.y)));
    return r <= kStraight ? xy : xy * (softClamp(r) / r);
}

void CorrectiveJoint::evaluate(glm::dvec2 clampedXy, Functions& phi) const noexcept {
    const double x = clampedXy.x, y = clampedXy.y;
    const std::size_t splines = splineCount(knots);
    switch (basis) {
    case Basis::Hinge: {
        double atRest[kMostKnots + 1];
        evaluateSplines(knots, x, phi.data());
        evaluateSplines(knots, 0.0, atRest);
        for (std::size_t i = 0; i < splines; ++i) phi[i] -= atRest[i];
        phi[splines] = y;
        phi[splines + 1] = x * y;
        phi[splines + 2] = y * y;
        return;
    }
    case Basis::Ball: {
        const double all[] = {x,         y,         x * x,     x * y,    y * y,
                              x * x * x, x * x * y, x * y * y, y * y * y};
        for (std::size_t i = 0; i < 9; ++i) phi[i] = all[i];
        return;
    }
    case Basis::Round: {
        double now[kMostKnots + 1], atRest[kMostKnots + 1];
        evaluateSplines(knots, x * x + y * y, now);
        evaluateSplines(knots, 0.0, atRest);
        for (std::size_t i = 0; i < splines; ++i) {
            double* of = &phi[7 * i];
            of[0] = now[i] - atRest[i];
            of[1] = now[i] * x;
            of[2] = now[i] * y;
            of[3] = now[i] * (x * x - y * y);
            of[4] = now[i] * 2.0 * x * y;
            of[5] = now[i] * x * (x * x - 3.0 * y * y);
            of[6] = now[i] * y * (3.0 * x * x - y * y);
        }
        return;
    }
    }
}

void CorrectiveJoint::weights(glm::dvec2 xy, double* beta) const noexcept {
    Functions phi;
    evaluate(clamped(xy), phi);
    const std::size_t functions = functionCount();
    const double* row = coefficients.data();
    for (std::size_t k = 0; k < modes; ++k, row += functions) {
        beta[k] = 0.0;
        for (std::size_t i = 0; i < functions; ++i) beta[k] += row[i] * phi[i];
    }
}

} // namespace osgSkin
