// SPDX-License-Identifier: MIT
#include "GaitFoot.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace mannequin {
namespace {

constexpr double kToeLimit = 32; // degrees; bend of the toes that a shoe allows

glm::dvec3 pitched(double pitch, const glm::dvec3& v) {
    return turn(pitch, {1, 0, 0}) * v;
}

/// Bend of the toes on the floor: they stay flat up to 18 degrees, then give way.
double bendOf(double pitch) {
    constexpr double kFlat = 18;
    if (pitch <= kFlat) return std::max(pitch, 0.0);
    const double room = kToeLimit - kFlat;
    return kFlat + room * (1 - std::exp(-(pitch - kFlat) / room));
}

double smoothStep(double x) {
    const double u = std::clamp(x, 0.0, 1.0);
    return u * u * u * (10 - 15 * u + 6 * u * u);
}

/// Slopes of a cubic spline with given slopes at its ends.
std::vector<glm::dvec3> splineSlopes(const std::vector<double>& t, const std::vector<glm::dvec3>& p,
                                     const glm::dvec3& first, const glm::dvec3& last) {
    const std::size_t n = t.size();
    std::vector<double> upper(n, 0.0);
    std::vector<glm::dvec3> slope(n, first);
    for (std::size_t i = 1; i + 1 < n; ++i) { // a tridiagonal system, eliminated forwards
        const double a = 1 / (t[i] - t[i - 1]), b = 1 / (t[i + 1] - t[i]);
        const glm::dvec3 right =
            3.0 * (a * a * (p[i] - p[i - 1]) + b * b * (p[i + 1] - p[i])) - a * slope[i - 1];
        const double pivot = 2 * (a + b) - a * upper[i - 1];
        upper[i] = b / pivot;
        slope[i] = right / pivot;
    }
    slope[n - 1] = last;
    for (std::size_t i = n - 1; i-- > 1;) slope[i] -= upper[i] * slope[i + 1];
    return slope;
}

} // namespace

ShoeShape::ShoeShape(const Skeleton& skeleton)
    : ankle(skeleton.joint("LeftFoot").centre), ball(skeleton.joint("LeftToeBase").centre) {
    glm::dvec3 forward = ball - ankle;
    forward.y = 0;
    forward = glm::normalize(forward);
    const glm::dvec3 below(ankle.x, 0, ankle.z);
    heel = below - forward * 0.044;
    tip = below + forward * 0.205;
}

FootPath::FootPath(const Skeleton& skeleton, FootCycle cycle,
                   const std::function<glm::dvec3(double)>& hip)
    : shoe_(skeleton), cycle_(std::move(cycle)) {
    constexpr double kStep = 1e-4;
    const auto slopeAt = [&](double phase) {
        return (grounded(phase + kStep).ankle - grounded(phase - kStep).ankle) / (2 * kStep);
    };
    const double thigh =
        glm::distance(skeleton.joint("LeftUpLeg").centre, skeleton.joint("LeftLeg").centre);
    const double shank = glm::distance(skeleton.joint("LeftLeg").centre, shoe_.ankle);
    times_ = {cycle_.toeOff};
    points_ = {grounded(cycle_.toeOff).ankle};
    for (const SwingKey& key : cycle_.swing) {
        const double upper = radians(key.thigh), lower = radians(key.thigh - key.knee);
        times_.push_back(key.phase);
        const glm::dvec3 from = hip(key.phase);
        points_.push_back({cycle_.across,
                           from.y - thigh * std::cos(upper) - shank * std::cos(lower),
                           from.z + thigh * std::sin(upper) + shank * std::sin(lower)});
    }
    times_.push_back(1);
    points_.push_back(grounded(0).ankle);
    slopes_ = splineSlopes(times_, points_, slopeAt(cycle_.toeOff), slopeAt(0));
}

FootPlacement FootPath::grounded(double phase) const {
    FootPlacement foot;
    foot.pitch = cycle_.pitch.at(phase);
    foot.toeBend = bendOf(foot.pitch);
    const double toes = foot.pitch - foot.toeBend; // pitch of the toes
    if (foot.pitch < 0)
        foot.ankle = shoe_.heel + pitched(foot.pitch, shoe_.ankle - shoe_.heel);
    else
        foot.ankle = shoe_.tip + pitched(toes, shoe_.ball - shoe_.tip) +
                     pitched(foot.pitch, shoe_.ankle - shoe_.ball);
    foot.ankle.x = cycle_.across;
    foot.ankle.z += cycle_.stride * (cycle_.passes - phase) - shoe_.ankle.z;
    return foot;
}

FootPlacement FootPath::at(double phase) const {
    const double t = phase - std::floor(phase);
    if (t <= cycle_.toeOff) return grounded(t);
    FootPlacement foot;
    foot.pitch = cycle_.pitch.at(t);
    foot.toeBend = bendOf(foot.pitch) * (1 - smoothStep((t - cycle_.toeOff) / 0.16));
    const auto next = std::upper_bound(times_.begin() + 1, times_.end() - 1, t);
    const auto i = static_cast<std::size_t>(next - times_.begin()) - 1;
    const double span = times_[i + 1] - times_[i], u = (t - times_[i]) / span, v = 1 - u;
    foot.ankle = v * v * (1 + 2 * u) * points_[i] + u * u * (1 + 2 * v) * points_[i + 1] +
                 span * u * v * (v * slopes_[i] - u * slopes_[i + 1]);
    return foot;
}

} // namespace mannequin
