// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapes/BentSkin.h"

#include "limbs/HermiteRatio.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <cmath>

namespace osgSkin {
namespace {

using Points = std::vector<glm::dvec3>;

/// By how much a limb swells at most to keep its volume.
constexpr double kMostSwelling = 0.036;

/// How far from the joint it does so, in radii: fully, and at all. Further up a thigh there is
/// another one beside it.
constexpr double kSwellsFully = 2.0;
constexpr double kSwellsNoMore = 4.0;

/// How deep inside a fold at the trunk bulges are still clamped, in radii of the limb.
constexpr double kTrunkDepth = 0.3;

/// What a limb at the trunk keeps of the volume that a bend gives it: about as much is lost in
/// other joints' folds.
constexpr double kGainKept = 0.5;

/// What the skin inside a fold counts against the outer one. Where a limb folds on a limb less:
/// the outer one is what everybody sees. Where it folds on the trunk more: nothing presses that
/// skin flat, and what leaks there from the shape outside would make it go through itself.
constexpr double kInsideLimbs = 0.1;
constexpr double kInsideTrunk = 20.0;

double degreesBetween(const glm::dvec3& a, const glm::dvec3& b) {
    return glm::degrees(std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b)));
}

FoldShape foldAt(const ShapedJoint& joint, const glm::dquat& turn) {
    const glm::dvec3 bone = turn * joint.bone;
    return {joint.above,
            joint.bone,
            bone,
            joint.radius,
            degreesBetween(joint.above, bone),
            degreesBetween(joint.above, joint.bone)};
}

Points between(Points from, const Points& to, double share) {
    for (std::size_t i = 0; i < from.size(); ++i) from[i] += share * (to[i] - from[i]);
    return from;
}

} // namespace

BentSkin::BentSkin(const ShapedJoint& joint, const BendTwist& bend)
    : _joint(joint), _fold(foldAt(joint, partialRotation(bend, joint.twistAxis, 1.0, 1.0))) {
    for (const ShapedJoint::Vertex& vertex : joint.vertices)
        _posed.push_back(joint.turnOf(vertex, bend) * vertex.from);
}

double BentSkin::volumeOf(const ShapedJoint& joint, const Points& points) {
    double volume = 0.0;
    for (const std::array<std::uint32_t, 3>& t : joint.triangles)
        volume += glm::dot(points[t[0]], glm::cross(points[t[1]], points[t[2]]));
    return volume;
}

Points BentSkin::targets(double volumeAtRest) const {
    return _joint.isAtTrunk() ? trunkTargets(volumeAtRest) : filledLimb(volumeAtRest);
}

Points BentSkin::limbTargets(double swelling) const {
    Points targets;
    for (std::size_t i = 0; i < _posed.size(); ++i) {
        const ShapedJoint::Vertex& vertex = _joint.vertices[i];
        glm::dvec3 target = clampBulge(_fold, vertex.from, _posed[i]);
        const double r = glm::length(vertex.from) / _joint.radius;
        const double near = 1.0 - hermiteRatio((r - kSwellsFully) / (kSwellsNoMore - kSwellsFully));
        target = pressFold(_fold, vertex.from, swell(_fold, target, swelling * near));
        targets.push_back(_posed[i] + vertex.limb * vertex.fade * (target - _posed[i]));
    }
    return targets;
}

/// What the clamp and the press take from the limb, and the bend itself, comes back as far as
/// swelling can give it: flesh does not vanish.
Points BentSkin::filledLimb(double volumeAtRest) const {
    Points lean = limbTargets(0.0);
    const double missing = volumeAtRest - volumeOf(_joint, lean);
    if (!(missing > 0.0)) return lean;
    const Points full = limbTargets(kMostSwelling);
    const double gained = volumeOf(_joint, full) - volumeOf(_joint, lean);
    return gained > 0.0 ? between(std::move(lean), full, std::min(1.0, missing / gained)) : lean;
}

/// No bulge outside; where that would cost volume that the bend has not given, less of it.
Points BentSkin::trunkTargets(double volumeAtRest) const {
    Points lean;
    for (std::size_t i = 0; i < _posed.size(); ++i) {
        const ShapedJoint::Vertex& vertex = _joint.vertices[i];
        const double outside =
            1.0 - hermiteRatio(0.5 + 0.5 * depthIn(_fold, _posed[i]) / kTrunkDepth);
        const glm::dvec3 target = clampBulge(_fold, vertex.from, _posed[i]);
        lean.push_back(_posed[i] + outside * vertex.limb * vertex.fade * (target - _posed[i]));
    }
    const double plain = volumeOf(_joint, _posed), now = volumeOf(_joint, lean);
    const double least = plain - (1.0 - kGainKept) * std::max(plain - volumeAtRest, 0.0);
    return now < least ? between(std::move(lean), _posed, (least - now) / (plain - now)) : lean;
}

std::vector<double> BentSkin::weights() const {
    const double inside = _joint.isAtTrunk() ? kInsideTrunk : kInsideLimbs;
    std::vector<double> weights;
    for (const glm::dvec3& x : _posed)
        weights.push_back(glm::mix(1.0, inside, hermiteRatio(0.5 + depthIn(_fold, x))));
    return weights;
}

} // namespace osgSkin
