// SPDX-License-Identifier: GPL-3.0-or-later
#include "ratios/TwistProfile.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace osgSkin {
namespace {

/// Fractions of the region over which the rate of the twist fades in below the elbow, where the
/// skin is thick and its rows of vertices stand far apart, and out again above the wrist.
constexpr double kFadeIn = 0.4;
constexpr double kFadeOut = 0.15;

/// The limb's radius in stretches of the region; each takes the mean over skin within two of them.
constexpr std::size_t kStretches = 16;
using Radii = std::array<double, kStretches>;

Radii limbRadiiAlong(const WeldedMesh& mesh, const PlannedJoint& joint, const BoundarySpan& region,
                     const std::vector<double>& onBone, const std::vector<double>& beyond) {
    Radii sums{}, weights{};
    for (std::size_t v = 0; v < mesh.vertexCount(); ++v) {
        if (onBone[v] < 0.5 || beyond[v] > 0.5) continue;
        const glm::dvec3 d = mesh.positions[v] - joint.centre;
        const double along = glm::dot(d, joint.twistAxis);
        const double t = (along / joint.poleLength - region.upper) / (region.lower - region.upper);
        if (t < 0.0 || t > 1.0) continue;
        const double radius = glm::length(d - along * joint.twistAxis);
        for (std::size_t i = 0; i < kStretches; ++i) {
            const double away = std::abs(t * kStretches - (static_cast<double>(i) + 0.5));
            const double weight = std::max(0.0, 1.0 - 0.5 * away);
            sums[i] += weight * radius;
            weights[i] += weight;
        }
    }
    // A stretch without skin has the radius of the last one that has some.
    double last = 1.0;
    for (std::size_t i = kStretches; i-- > 0;)
        if (weights[i] > 0.0 && sums[i] > 0.0) last = sums[i] / weights[i];
    for (std::size_t i = 0; i < kStretches; ++i)
        sums[i] = last = weights[i] > 0.0 && sums[i] > 0.0 ? sums[i] / weights[i] : last;
    return sums;
}

double radiusAt(const Radii& radii, double t) {
    const double position = std::clamp(t * kStretches - 0.5, 0.0, kStretches - 1.0);
    const auto i = std::min(static_cast<std::size_t>(position), kStretches - 2);
    return radii[i] + (radii[i + 1] - radii[i]) * (position - static_cast<double>(i));
}

} // namespace

TwistProfile::TwistProfile(const WeldedMesh& mesh, const PlannedJoint& joint,
                           const BoundarySpan& region, const std::vector<double>& onBone,
                           const std::vector<double>& beyond) {
    const Radii radii = limbRadiiAlong(mesh, joint, region, onBone, beyond);
    for (std::size_t i = 0; i < kSteps; ++i) {
        const double t = (static_cast<double>(i) + 0.5) / kSteps;
        const double fade = std::min({1.0, t / kFadeIn, (1.0 - t) / kFadeOut});
        _ratio[i + 1] = _ratio[i] + fade / radiusAt(radii, t);
    }
    const double whole = _ratio.back();
    for (double& ratio : _ratio) ratio /= whole;
}

double TwistProfile::operator()(double t) const {
    const double position = std::clamp(t, 0.0, 1.0) * kSteps;
    const auto i = std::min(static_cast<std::size_t>(position), kSteps - 1);
    return _ratio[i] + (_ratio[i + 1] - _ratio[i]) * (position - static_cast<double>(i));
}

} // namespace osgSkin
