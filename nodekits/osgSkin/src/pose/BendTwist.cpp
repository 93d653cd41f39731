// SPDX-License-Identifier: MIT
#include <osgSkin/BendTwist>

#include "pose/PoseKernel.h"

#include <osgSkin/Error>
#include <osgSkin/GlmOsg>
#include <osgSkin/GlmTypes>

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace osgSkin {
namespace {

glm::dquat rotationAbout(const glm::dvec3& unitAxis, double angle) {
    return {std::cos(0.5 * angle), unitAxis * std::sin(0.5 * angle)};
}

/// The direction of u in the plane perpendicular to w; any such direction where u is 0.
glm::dvec3 perpendicularDirection(glm::dvec3 u, const glm::dvec3& w) {
    // A very short u may be mostly rounding error along w: scale it up, then remove that part.
    const double largest = std::max({std::abs(u.x), std::abs(u.y), std::abs(u.z)});
    if (!(largest > 0.0)) return anyPerpendicular(w);
    u /= largest;
    u -= w * glm::dot(u, w);
    const double length = glm::length(u);
    if (length < 1e-6) return anyPerpendicular(w);
    u /= length;
    return glm::normalize(u - w * glm::dot(u, w));
}

/// q and -q are the same rotation; of the two, the first non-zero number is to be positive.
bool isNegative(double a, double b, const glm::dvec3& c) {
    for (const double x : {a, b, c.x, c.y, c.z})
        if (x != 0.0) return x < 0.0;
    return false;
}

} // namespace

BendTwist splitUnit(const glm::dquat& q, const glm::dvec3& w) noexcept {
    BendTwist out;
    double c = q.w;
    const glm::dvec3 xyz(q.x, q.y, q.z);
    double s = glm::dot(xyz, w); // c + s w is the twist, unnormalised
    glm::dvec3 u = xyz - w * s;  // the part perpendicular to the bone
    if (isNegative(c, s, u)) {
        c = -c;
        s = -s;
        u = -u;
    }

    // The acos of eq. 2 loses digits near 0 and pi; the arc tangent of |u| = sin(psi / 2) and
    // n = cos(psi / 2) does not.
    const double n = std::sqrt(c * c + s * s);
    const double bendSine = glm::length(u);
    out.bendAngle = 2.0 * std::atan2(bendSine, n);
    if (n < 1e-12) {
        // Bend of pi: w becomes -w, and the twist is not determined.
        out.bendAxis = perpendicularDirection(u, w);
        return out;
    }
    // q times the inverse twist: its vector part is the bend axis of eq. 3, of length |u| n. A
    // short one has few digits.
    const glm::dvec3 axis = c * u + s * glm::cross(w, u);
    out.bendAxis = bendSine > 1e-3 ? axis / (bendSine * n) : perpendicularDirection(axis, w);
    out.twistAngle = 2.0 * std::atan2(s, c); // eq. 4
    return out;
}

bool trySplitBendTwist(const glm::dquat& q, const glm::dvec3& pole, BendTwist& out) noexcept {
    if (!isFinite(pole) || std::abs(glm::dot(pole, pole) - 1.0) > 1e-6) return false;
    const double largest = std::max({std::abs(q.w), std::abs(q.x), std::abs(q.y), std::abs(q.z)});
    if (!std::isfinite(q.w) || !isFinite({q.x, q.y, q.z}) || !(largest > 0.0)) return false;

    // Divide by the largest part first: squares of huge or tiny parts would overflow or vanish.
    const glm::dquat scaled = q / largest;
    out = splitUnit(scaled / std::sqrt(glm::dot(scaled, scaled)), glm::normalize(pole));
    return true;
}

BendTwist splitBendTwist(const glm::dquat& q, const glm::dvec3& pole) {
    BendTwist result;
    if (!trySplitBendTwist(q, pole, result))
        throw Error(
            "splitBendTwist: expected a finite quaternion that is not zero and a unit pole");
    return result;
}

BendTwist splitBendTwist(const osg::Quat& q, const osg::Vec3d& pole) {
    return splitBendTwist(toGlm(q), toGlm(pole));
}

bool trySplitBendTwist(const osg::Quat& q, const osg::Vec3d& pole, BendTwist& out) noexcept {
    return trySplitBendTwist(toGlm(q), toGlm(pole), out);
}

glm::dquat partialRotation(const BendTwist& split, const glm::dvec3& pole, double bendRatio,
                           double twistRatio) noexcept {
    return rotationAbout(split.bendAxis, bendRatio * split.bendAngle) *
           rotationAbout(pole, twistRatio * split.twistAngle);
}

osg::Quat partialRotation(const BendTwist& split, const osg::Vec3d& pole, double bendRatio,
                          double twistRatio) noexcept {
    return toOsg(partialRotation(split, toGlm(pole), bendRatio, twistRatio));
}

} // namespace osgSkin
