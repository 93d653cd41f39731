// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapes/FastTargets.h"

#include "regions/HermiteRatio.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace osgSkin {
namespace {

/// What is left of a bulge, in radii.
constexpr double kBulgeLeft = 0.005;

/// Distance along the bone, in radii, from which on sections are restored wholly.
constexpr double kRestoreFull = 2.0;

/// Depths inside the fold between which widening sets in, in radii from the bone.
constexpr double kWidenFrom = -1.5;
constexpr double kWidenFull = -0.5;

/// Half the width of the transition from the parent's to the child's side, in radii.
constexpr double kSideWidth = 0.25;

/// Sine of the angle between the bones from which on a limb has an inner side.
constexpr double kMinFold = 0.1;

/// Gap between the skins on both sides of a fold, far from the joint, and how softly they meet; in
/// radii.
constexpr double kGap = 0.2;
constexpr double kSoftness = 0.2;

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

/// Signed distance at rest from the plane that bisects the joint; positive on the child's side.
double heightAtRest(const FoldShape& fold, const glm::dvec3& rest) {
    return glm::dot(rest, glm::normalize(fold.above + fold.boneRest));
}

/// Signed distance from the bisecting plane that pressed skin keeps.
double limitOf(const FoldShape& fold, const glm::dvec3& rest) {
    const double h0 = heightAtRest(fold, rest);
    return kGap * fold.radius * h0 / (std::abs(h0) + fold.radius);
}

/// About the smaller of `wish` and `room`, never more than either; both at least 0.
double limitedTo(double wish, double room) {
    if (!(room > 0.0)) return 0.0;
    const double t = wish / room, square = t * t;
    return wish / std::sqrt(std::sqrt(1.0 + square * square));
}

/// Distance from the bone at rest, mixed where both sides of the joint meet.
double distanceAtRest(const FoldShape& fold, const glm::dvec3& rest) {
    const auto from = [&](const glm::dvec3& bone) {
        const double z = std::max(glm::dot(bone, rest), 0.0);
        return std::sqrt(std::max(glm::dot(rest, rest) - z * z, 0.0));
    };
    return glm::mix(from(-fold.above), from(fold.boneRest), childShare(fold, rest));
}

/// A bone that skin is restored to.
struct RestoringBone {
    glm::dvec3 atRest; ///< unit, away from the joint
    glm::dvec3 posed;
    glm::dquat turn; ///< takes `atRest` to `posed`
    double side;     ///< 1 on the child's side of the joint, -1 on the parent's
};

/// Across the bone.
glm::dvec3 restoringMove(const FoldShape& fold, const RestoringBone& bone, const glm::dvec3& rest,
                         const glm::dvec3& clamped) {
    const glm::dvec3& m = bone.posed;
    const double z = glm::dot(m, clamped);
    const double share = hermiteRatio(z / (kRestoreFull * fold.radius));
    if (!(share > 0.0)) return glm::dvec3(0.0);
    const glm::dvec3 radial = bone.turn * (rest - glm::dot(bone.atRest, rest) * bone.atRest);
    glm::dvec3 move = share * (radial - (clamped - z * m));
    const glm::dvec3 inwards = fold.bone - fold.above;
    const glm::dvec3 across = inwards - glm::dot(m, inwards) * m;
    const double length = glm::length(across);
    if (length < kMinFold) return move;
    const glm::dvec3 inner = across / length;
    const double wish = glm::dot(inner, move);
    if (!(wish > 0.0)) return move;
    // Where the plane's normal leans towards the bone, `inner` leads to the plane.
    const glm::dvec3 normal = bone.side * fold.normal;
    const double room = (glm::dot(normal, clamped) - bone.side * limitOf(fold, rest)) /
                        std::max(-glm::dot(normal, inner), 1e-3);
    return move + (limitedTo(wish, room) - wish) * inner;
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

glm::dvec3 restoreSection(const FoldShape& fold, const glm::dvec3& rest, const glm::dvec3& clamped,
                          const glm::dquat& turn) {
    const double childs = childShare(fold, rest);
    const glm::dquat unit(1.0, 0.0, 0.0, 0.0);
    glm::dvec3 moved(0.0);
    if (childs > 0.0)
        moved += childs * restoringMove(fold, {fold.boneRest, fold.bone, turn, 1.0}, rest, clamped);
    if (childs < 1.0)
        moved += (1.0 - childs) *
                 restoringMove(fold, {-fold.above, -fold.above, unit, -1.0}, rest, clamped);
    return clamped + moved;
}

double childShare(const FoldShape& fold, const glm::dvec3& rest) {
    const double h0 = heightAtRest(fold, rest);
    return hermiteRatio(0.5 + 0.5 * h0 / (kSideWidth * fold.radius));
}

double depthIn(const FoldShape& fold, const glm::dvec3& posed) {
    const glm::dvec3 inwards = fold.bone - fold.above;
    const glm::dvec3 m = boneOf(fold, posed);
    // Across the bone: along it, its outer side, too, comes to lie inwards of the joint.
    const glm::dvec3 across = inwards - glm::dot(m, inwards) * m;
    const double length = glm::length(across);
    return length < 1e-6 ? 0.0 : glm::dot(across, posed) / (length * fold.radius);
}

glm::dvec3 widen(const FoldShape& fold, const glm::dvec3& rest, const glm::dvec3& posed,
                 double share, double most) {
    const glm::dvec3 axis = glm::cross(fold.above, fold.bone);
    const double sine = glm::length(axis);
    if (sine < kMinFold) return posed;
    const glm::dvec3 sideways = axis / sine;
    const double at = glm::dot(sideways, posed);
    const double z = std::max(glm::dot(boneOf(fold, posed), posed), 0.0);
    const double across = glm::dot(posed, posed) - z * z - at * at; // squared
    const double mostAcross = most * distanceAtRest(fold, rest);
    const double room = std::sqrt(std::max(mostAcross * mostAcross - across, 0.0)) - std::abs(at);
    const double inside =
        hermiteRatio((depthIn(fold, posed) - kWidenFrom) / (kWidenFull - kWidenFrom));
    const double move = limitedTo(share * inside * std::abs(at), room);
    return posed + std::copysign(move, at) * sideways;
}

glm::dvec3 pressFold(const FoldShape& fold, const glm::dvec3& rest, const glm::dvec3& posed) {
    const double onset = since(fold, kPressFrom, kPressFull);
    const glm::dvec3 sum = fold.above + fold.bone, inwards = fold.bone - fold.above;
    if (!(onset > 0.0) || glm::length(sum) < 1e-3 || glm::length(inwards) < 1e-3) return posed;
    const glm::dvec3& n = fold.normal;
    const double r = fold.radius;
    const double h0 = heightAtRest(fold, rest);
    const double h = glm::dot(posed, n);
    const double limit = limitOf(fold, rest);
    const double childs = softMax(h, limit, kSoftness * r);
    const double parents = -softMax(-h, -limit, kSoftness * r);
    const double side = childShare(fold, rest);
    // The crease itself lies between both sides: else it pricks the one that is pressed upon it.
    const double deep = since(fold, kCreaseFrom, kCreaseFull) *
                        (1.0 - hermiteRatio((std::abs(h0) / r - kCreaseCore) / kCreaseEdge));
    const double pressed = glm::mix(glm::mix(parents, childs, side), limit, deep);
    const double inside = hermiteRatio(0.2 + 2.0 * glm::dot(glm::normalize(inwards), posed) / r);
    return posed + onset * inside * (pressed - h) * n;
}

} // namespace osgSkin
