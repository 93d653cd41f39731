// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapes/FastTargets.h"

#include "limbs/HermiteRatio.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace osgSkin {
namespace {

/// What is left of a bulge, in radii.
constexpr double kBulgeLeft = 0.005;

/// How deep inside the fold skin swells, in radii from the bone: outside it does not.
constexpr double kSwellFrom = -0.5;
constexpr double kSwellFull = 0.3;

/// Gap between the skins on both sides of a fold, far from the joint, and how softly they meet; in
/// radii.
constexpr double kGap = 0.1;
constexpr double kSoftness = 0.08;

/// Angles between which the press sets in, in degrees.
constexpr double kPressFrom = 45.0;
constexpr double kPressFull = 75.0;

/// The same of the crease, and how far from the joint's plane it reaches, in radii.
constexpr double kCreaseFrom = 80.0;
constexpr double kCreaseFull = 120.0;
constexpr double kCreaseCore = 0.1;
constexpr double kCreaseEdge = 0.5;

/// The larger of the two, rounded off where they are nearly the same.
double softMax(double a, double b, double width) {
    return 0.5 * (a + b + std::sqrt((a - b) * (a - b) + width * width));
}

/// 0 up to an angle, 1 from another on; both later where the limb is bent at rest.
double since(const FoldShape& fold, double from, double full) {
    return hermiteRatio((fold.angle - std::max(from, fold.angleAtRest)) / (full - from));
}

/// Away from the joint along the bone that a vertex lies beside: the two meet in the bisector
/// plane.
glm::dvec3 boneOf(const FoldShape& fold, const glm::dvec3& posed) {
    return glm::dot(fold.above + fold.bone, posed) < 0.0 ? -fold.above : fold.bone;
}

} // namespace

glm::dvec3 clampBulge(const FoldShape& fold, const glm::dvec3& rest, const glm::dvec3& posed) {
    const bool onParent = glm::dot(fold.above + fold.bone, posed) < 0.0;
    const glm::dvec3 m = onParent ? -fold.above : fold.bone;
    const glm::dvec3 m0 = onParent ? -fold.above : fold.boneRest;
    const double z = std::max(glm::dot(m, posed), 0.0);
    const double z0 = std::max(glm::dot(m0, rest), 0.0);
    const double d = std::sqrt(std::max(glm::dot(posed, posed) - z * z, 0.0));
    const double d0 = std::sqrt(std::max(glm::dot(rest, rest) - z0 * z0, 0.0));
    const double t = std::max(d - d0, 0.0);
    if (!(t > 0.0)) return posed;
    const double k = t * t / ((t + kBulgeLeft * fold.radius) * d);
    return (1.0 - k) * posed + k * z * m;
}

double depthIn(const FoldShape& fold, const glm::dvec3& posed) {
    const glm::dvec3 inwards = fold.bone - fold.above;
    const glm::dvec3 m = boneOf(fold, posed);
    // Across the bone: along it, its outer side, too, comes to lie inwards of the joint.
    const glm::dvec3 across = inwards - glm::dot(m, inwards) * m;
    const double length = glm::length(across);
    return length < 1e-6 ? 0.0 : glm::dot(across, posed) / (length * fold.radius);
}

glm::dvec3 swell(const FoldShape& fold, const glm::dvec3& posed, double share) {
    const glm::dvec3 m = boneOf(fold, posed);
    const glm::dvec3 radial = posed - std::max(glm::dot(m, posed), 0.0) * m;
    const double depth = depthIn(fold, posed);
    return posed + share * hermiteRatio((depth - kSwellFrom) / (kSwellFull - kSwellFrom)) * radial;
}

glm::dvec3 pressFold(const FoldShape& fold, const glm::dvec3& rest, const glm::dvec3& posed) {
    const double onset = since(fold, kPressFrom, kPressFull);
    const glm::dvec3 sum = fold.above + fold.bone, inwards = fold.bone - fold.above;
    if (!(onset > 0.0) || glm::length(sum) < 1e-3 || glm::length(inwards) < 1e-3) return posed;
    const glm::dvec3 n = glm::normalize(sum);
    const double r = fold.radius;
    const double h0 = glm::dot(rest, glm::normalize(fold.above + fold.boneRest));
    const double h = glm::dot(posed, n);
    const double limit = kGap * r * h0 / (std::abs(h0) + r);
    const double childs = softMax(h, limit, kSoftness * r);
    const double parents = -softMax(-h, -limit, kSoftness * r);
    const double side = hermiteRatio(0.5 + h0 / (0.5 * r));
    // The crease itself lies between both sides: else it pricks the one that is pressed upon it.
    const double deep = since(fold, kCreaseFrom, kCreaseFull) *
                        (1.0 - hermiteRatio((std::abs(h0) / r - kCreaseCore) / kCreaseEdge));
    const double pressed = glm::mix(glm::mix(parents, childs, side), limit, deep);
    const double inside = hermiteRatio(0.2 + 2.0 * glm::dot(glm::normalize(inwards), posed) / r);
    return posed + onset * inside * (pressed - h) * n;
}

} // namespace osgSkin
