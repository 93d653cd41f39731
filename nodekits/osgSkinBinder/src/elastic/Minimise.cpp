// SPDX-License-Identifier: GPL-3.0-or-later
#include "elastic/Minimise.h"

#include <cmath>
#include <cstddef>
#include <deque>
#include <utility>
#include <vector>

namespace osgSkin::elastic {
namespace {

constexpr std::size_t kHistory = 8;
constexpr double kEnoughDescent = 1e-4; ///< share of the descent that the slope predicts
constexpr int kMaxHalvings = 20;
/// The preconditioner does not know that flesh keeps its volume, so its whole steps would
/// overshoot.
constexpr float kStepShare = 0.1f;

constexpr int kRestingSteps = 3; ///< number of successive small steps that count as rest

double dot(const Directions& a, const Directions& b) {
    return static_cast<double>(a.cwiseProduct(b).sum());
}

struct Pair {
    Directions step, change; ///< of the points and of the gradient
    double curvature = 0.0;
};

Directions direction(const Energy& energy, const std::deque<Pair>& pairs,
                     const Directions& gradient) {
    Directions q = gradient;
    std::vector<double> shares(pairs.size());
    for (std::size_t i = pairs.size(); i-- > 0;) {
        shares[i] = dot(pairs[i].step, q) / pairs[i].curvature;
        q -= static_cast<float>(shares[i]) * pairs[i].change;
    }
    Directions r = kStepShare * energy.precondition(q);
    for (std::size_t i = 0; i < pairs.size(); ++i) {
        const double share = shares[i] - dot(pairs[i].change, r) / pairs[i].curvature;
        r += static_cast<float>(share) * pairs[i].step;
    }
    return -r;
}

} // namespace

int minimise(const Energy& energy, Points& points, const MinimiseLimits& limits) {
    Points gradient(3, points.cols()), next = gradient, nextGradient = gradient;
    double value = 0.0;
    std::deque<Pair> pairs;
    int steps = 0;
    for (int resting = 0; steps < limits.mostSteps && resting < kRestingSteps; ++steps) {
        const bool renews = energy.renew && steps % limits.renewEvery == 0;
        if (renews) energy.renew(points);
        if (renews || steps == 0) value = energy.value(points, gradient);
        const Directions rounded = gradient.cast<float>();
        Directions way = direction(energy, pairs, rounded);
        double slope = dot(way, rounded);
        if (!(slope < 0.0)) { // the pairs are from another energy
            pairs.clear();
            way = direction(energy, pairs, rounded);
            slope = dot(way, rounded);
        }
        if (!(slope < 0.0)) break;
        double nextValue = 0.0, length = 1.0;
        int halvings = 0;
        for (; halvings < kMaxHalvings; ++halvings, length *= 0.5) {
            next = points + length * way.cast<double>();
            nextValue = energy.value(next, nextGradient);
            if (nextValue <= value + kEnoughDescent * length * slope) break;
        }
        if (halvings == kMaxHalvings) {
            if (pairs.empty()) break;
            pairs.clear();
            continue;
        }
        Pair pair{(next - points).cast<float>(), (nextGradient - gradient).cast<float>(), 0.0};
        pair.curvature = dot(pair.step, pair.change);
        const double square = static_cast<double>(pair.step.colwise().squaredNorm().maxCoeff());
        resting = square < limits.smallStep * limits.smallStep ? resting + 1 : 0;
        if (pair.curvature > 1e-12 * dot(pair.step, pair.step)) {
            pairs.push_back(std::move(pair));
            if (pairs.size() > kHistory) pairs.pop_front();
        }
        points.swap(next);
        gradient.swap(nextGradient);
        value = nextValue;
    }
    return steps;
}

} // namespace osgSkin::elastic
