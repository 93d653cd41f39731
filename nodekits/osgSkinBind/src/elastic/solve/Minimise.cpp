// SPDX-License-Identifier: GPL-3.0-or-later
#include "elastic/solve/Minimise.h"

#include <cmath>
#include <deque>
#include <vector>

namespace osgSkin::elastic {
namespace {

constexpr std::size_t kHistory = 8;
constexpr double kEnoughDescent = 1e-4; ///< of what the slope promises
constexpr int kMostHalvings = 20;
/// The preconditioner knows of the smaller part of the curvature: whole steps of its own overshoot.
constexpr double kCurvatureShare = 0.25;

constexpr int kRestingSteps = 3; ///< small steps in a row that count as rest

double dot(const Points& a, const Points& b) {
    return a.cwiseProduct(b).sum();
}

struct Pair {
    Points step, change; ///< of the points and of the gradient
    double curvature = 0.0;
};

Points direction(const Energy& energy, const std::deque<Pair>& pairs, const Points& gradient) {
    Points q = gradient;
    std::vector<double> shares(pairs.size());
    for (std::size_t i = pairs.size(); i-- > 0;) {
        shares[i] = dot(pairs[i].step, q) / pairs[i].curvature;
        q -= shares[i] * pairs[i].change;
    }
    Points r = kCurvatureShare * energy.precondition(q);
    for (std::size_t i = 0; i < pairs.size(); ++i)
        r += (shares[i] - dot(pairs[i].change, r) / pairs[i].curvature) * pairs[i].step;
    return -r;
}

} // namespace

MinimiseResult minimise(const Energy& energy, Points& points, const MinimiseLimits& limits) {
    MinimiseResult result;
    Points gradient(3, points.cols());
    double value = energy.value(points, gradient);
    std::deque<Pair> pairs;
    int resting = 0;
    for (; result.steps < limits.mostSteps && resting < kRestingSteps; ++result.steps) {
        if (energy.renew && result.steps % limits.renewEvery == 0) {
            energy.renew(points);
            value = energy.value(points, gradient);
        }
        Points way = direction(energy, pairs, gradient);
        double slope = dot(way, gradient);
        if (!(slope < 0.0)) { // the pairs are from another energy
            pairs.clear();
            way = direction(energy, pairs, gradient);
            slope = dot(way, gradient);
        }
        if (!(slope < 0.0)) {
            if (slope == 0.0) resting = kRestingSteps; // no gradient is left
            break;
        }
        Points next, nextGradient(3, points.cols());
        double nextValue = 0.0, length = 1.0;
        int halvings = 0;
        for (; halvings < kMostHalvings; ++halvings, length *= 0.5) {
            next = points + length * way;
            nextValue = energy.value(next, nextGradient);
            if (nextValue <= value + kEnoughDescent * length * slope) break;
        }
        if (halvings == kMostHalvings) {
            if (pairs.empty()) break;
            pairs.clear();
            continue;
        }
        Pair pair{next - points, nextGradient - gradient, 0.0};
        pair.curvature = dot(pair.step, pair.change);
        result.lastStep = std::sqrt(pair.step.colwise().squaredNorm().maxCoeff());
        resting = result.lastStep < limits.smallStep ? resting + 1 : 0;
        if (pair.curvature > 1e-12 * pair.step.squaredNorm()) {
            pairs.push_back(std::move(pair));
            if (pairs.size() > kHistory) pairs.pop_front();
        }
        points.swap(next);
        gradient.swap(nextGradient);
        value = nextValue;
    }
    result.converged = resting == kRestingSteps;
    return result;
}

} // namespace osgSkin::elastic
