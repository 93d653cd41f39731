// SPDX-License-Identifier: MIT
#include "ThrowSpline.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace mannequin {
namespace {

double secant(const Key& a, const Key& b) {
    return (b.value - a.value) / (b.time - a.time);
}

/// Fritsch & Butland's slope: zero at a local extremum, else a weighted harmonic mean.
double monotoneSlope(const Key& a, const Key& b, const Key& c) {
    const double before = secant(a, b);
    const double after = secant(b, c);
    if (before * after <= 0) return 0;
    const double w1 = 2 * (c.time - b.time) + (b.time - a.time);
    const double w2 = (c.time - b.time) + 2 * (b.time - a.time);
    return (w1 + w2) / (w1 / before + w2 / after);
}

} // namespace

Channel::Channel(double softness, std::vector<Key> keys, double period)
    : softness_(softness), period_(period) {
    if (keys.empty()) throw std::invalid_argument("a channel needs a key");
    const auto unordered = [](const Key& a, const Key& b) { return b.time <= a.time; };
    if (std::adjacent_find(keys.begin(), keys.end(), unordered) != keys.end())
        throw std::invalid_argument("a channel's keys need rising times");
    if (keys.front().time < 0 || keys.back().time >= period)
        throw std::invalid_argument("a channel's keys must lie within one loop");
    for (int cycle = -1; cycle <= 1; ++cycle)
        for (const Key& key : keys) keys_.push_back({key.time + cycle * period, key.value});
    slopes_.assign(keys_.size(), 0.0);
    for (std::size_t i = 1; i + 1 < keys_.size(); ++i)
        slopes_[i] = monotoneSlope(keys_[i - 1], keys_[i], keys_[i + 1]);
}

double Channel::cubicAt(double time) const {
    const auto later = [](double t, const Key& key) { return t < key.time; };
    const auto next = std::upper_bound(keys_.begin(), keys_.end(), time, later);
    if (next == keys_.begin()) return keys_.front().value;
    if (next == keys_.end()) return keys_.back().value;
    const auto i = static_cast<std::size_t>(next - keys_.begin());
    const Key& a = keys_[i - 1];
    const Key& b = keys_[i];
    const double span = b.time - a.time;
    const double u = (time - a.time) / span;
    const double v = 1 - u;
    return v * v * (1 + 2 * u) * a.value + u * u * (1 + 2 * v) * b.value +
           span * u * v * (v * slopes_[i - 1] - u * slopes_[i]);
}

double Channel::at(double time) const {
    const double t = time - period_ * std::floor(time / period_);
    if (softness_ <= 0) return cubicAt(t);
    constexpr int kSide = 24;
    double sum = 0;
    double weights = 0;
    for (int i = -kSide + 1; i < kSide; ++i) {
        const double u = static_cast<double>(i) / kSide;
        const double weight = (1 - u * u) * (1 - u * u);
        sum += weight * cubicAt(t + u * softness_);
        weights += weight;
    }
    return sum / weights;
}

} // namespace mannequin
