// SPDX-License-Identifier: MIT
#include <osgSkin/BendTwist>

#include <osgSkin/Error>
#include <osgSkin/GlmOsg>
#include <osgSkin/GlmTypes>

#include "pose/SplitUnit.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace osgSkin {
namespace {

glm::dquat rotationAbout(const glm::dvec3& unitAxis, double angle) {
    return {std::cos(0.5 * angle), unitAxis * std::sin(0.5 * angle)};
}

} // namespace

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
