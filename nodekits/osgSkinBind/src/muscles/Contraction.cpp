// SPDX-License-Identifier: GPL-3.0-or-later
#include "muscles/Contraction.h"

#include <Eigen/Cholesky>

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace osgSkin {
namespace {

/// Distance of a muscle's pull from the joint's centre, in radii of the limb, and the length of
/// what shortens of it, in lengths of its bone.
constexpr double kMomentArm = 0.9;
constexpr double kFascicle = 0.5;

/// What it is stretched by at most.
constexpr double kMostStretch = 0.15;

constexpr int kSamples = 48;
constexpr double kRidge = 1e-6;

/// t, and from 3/4 on softly towards 1.
double softly(double t) {
    return t <= 0.75 ? t : 0.75 + 0.25 * std::tanh((t - 0.75) / 0.25);
}

} // namespace

double contractionAt(const Muscle& muscle, double psi) {
    const double length = kFascicle * glm::length(muscle.end - muscle.begin);
    const double pulled = muscle.shortens * kMomentArm * muscle.radius * psi / length;
    const double most = pulled > 0.0 ? 1.0 - kShortest : kMostStretch;
    const double lambda = 1.0 - std::copysign(most * softly(std::abs(pulled) / most), pulled);
    return (1.0 / lambda - 1.0) / (1.0 / kShortest - 1.0);
}

std::vector<double> contractionCoefficients(const Muscle& muscle) {
    const CorrectiveJoint& functions = muscle.functions;
    const auto count = Eigen::Index(functions.functionCount());
    Eigen::MatrixXd phi(kSamples + 1, count);
    Eigen::VectorXd wanted(kSamples + 1);
    CorrectiveJoint::Functions values;
    for (int s = 0; s <= kSamples; ++s) {
        const double x =
            functions.low.x + (functions.high.x - functions.low.x) * double(s) / kSamples;
        const glm::dvec2 clamped = functions.clamped({x, 0.0});
        functions.evaluate(clamped, values);
        for (Eigen::Index i = 0; i < count; ++i) phi(s, i) = values[std::size_t(i)];
        wanted[s] =
            contractionAt(muscle, 2.0 * std::asin(std::min(1.0, std::max(-1.0, clamped.x))));
    }
    Eigen::MatrixXd normal = phi.transpose() * phi;
    normal.diagonal().array() += kRidge;
    const Eigen::VectorXd fit = normal.ldlt().solve(phi.transpose() * wanted);
    return {fit.data(), fit.data() + fit.size()};
}

} // namespace osgSkin
