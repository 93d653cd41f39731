// SPDX-License-Identifier: MIT
#include <osgSkinMotion/RotateBone>

#include "bones/TwoBone.h"

#include <osgSkin/GlmOsg>

#include <osg/Matrixd>

#include <algorithm>
#include <cmath>

namespace osgSkin {
namespace {

/// Below this sine two directions are taken as parallel.
constexpr double kParallel = 1e-6;

double angleBetween(const glm::dvec3& a, const glm::dvec3& b) {
    return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
}

/// The axis about which a larger angle bends the limb more.
glm::dvec3 bendAxis(const glm::dvec3& upper, const glm::dvec3& lower, const glm::dvec3& pole) {
    const glm::dvec3 along = unitOrZero(upper), bent = glm::cross(along, unitOrZero(lower));
    if (glm::length(bent) > kParallel) return unitOrZero(bent);
    const glm::dvec3 towardsPole = glm::cross(unitOrZero(pole), along);
    return glm::length(towardsPole) > kParallel ? unitOrZero(towardsPole) : anyPerpendicular(along);
}

/// The rotation about an axis that brings `from` as near to `to` as it can.
glm::dquat aboutAxis(const glm::dvec3& axis, const glm::dvec3& from, const glm::dvec3& to) {
    const glm::dvec3 a = from - axis * glm::dot(from, axis), b = to - axis * glm::dot(to, axis);
    if (glm::length(a) <= kParallel * glm::length(from) ||
        glm::length(b) <= kParallel * glm::length(to))
        return {1.0, 0.0, 0.0, 0.0};
    return glm::angleAxis(std::atan2(glm::dot(glm::cross(a, b), axis), glm::dot(a, b)), axis);
}

/// Places all bones below one by their own matrices.
void placeBelow(osgAnimation::Bone& bone) {
    for (unsigned int i = 0; i < bone.getNumChildren(); ++i) {
        auto* child = dynamic_cast<osgAnimation::Bone*>(bone.getChild(i));
        if (!child) continue;
        child->setMatrixInSkeletonSpace(child->getMatrix() * bone.getMatrixInSkeletonSpace());
        placeBelow(*child);
    }
}

} // namespace

void rotateBone(osgAnimation::Bone& bone, const osg::Quat& rotation) {
    osg::Matrixd placed = bone.getMatrixInSkeletonSpace();
    const osg::Vec3d joint = placed.getTrans();
    placed.postMultRotate(rotation);
    placed.setTrans(joint);
    const osgAnimation::Bone* parent = bone.getBoneParent();
    bone.setMatrix(parent ? placed * osg::Matrixd::inverse(parent->getMatrixInSkeletonSpace())
                          : placed);
    bone.setMatrixInSkeletonSpace(placed);
    placeBelow(bone);
}

bool lookAt(osgAnimation::Bone& bone, const osg::Vec3d& forward, const osg::Vec3d& target,
            double maxAngle) {
    const osg::Matrixd placed = bone.getMatrixInSkeletonSpace();
    const glm::dvec3 from = toGlm(osg::Matrixd::transform3x3(
        forward, osg::Matrixd(bone.getInvBindMatrixInSkeletonSpace()) * placed));
    const glm::dvec3 to = toGlm(target - placed.getTrans());
    if (!isFinite(from) || !isFinite(to) || !(glm::length(from) > 0.0) ||
        !(glm::length(to) > 0.0) || !(maxAngle >= 0.0))
        return false;
    const double angle = angleBetween(from, to);
    const glm::dvec3 unit = unitOrZero(from), axis = glm::cross(unit, unitOrZero(to));
    rotateBone(bone, toOsg(glm::angleAxis(std::min(angle, maxAngle),
                                          glm::length(axis) > kParallel ? unitOrZero(axis)
                                                                        : anyPerpendicular(unit))));
    return angle <= maxAngle;
}

LimbTurns reachTurns(const glm::dvec3& first, const glm::dvec3& middle, const glm::dvec3& end,
                     const glm::dvec3& target, const glm::dvec3& pole) {
    const glm::dvec3 upper = middle - first, lower = end - middle, toTarget = target - first;
    const double a = glm::length(upper), b = glm::length(lower), distance = glm::length(toTarget);
    LimbTurns result;
    if (!(a > 0.0) || !(b > 0.0) || !std::isfinite(a + b + distance) || !isFinite(pole))
        return result;
    const double reached = std::clamp(distance, std::abs(a - b), a + b);
    result.reaches = std::abs(reached - distance) <= 1e-9 * (a + b);

    // How far the lower bone turns from the upper one's direction.
    const LimbBend at = bendOf(a, b, reached);
    const double bend = std::atan2(at.beside, at.along) + std::atan2(at.beside, reached - at.along);
    result.lower = glm::angleAxis(bend - angleBetween(upper, lower), bendAxis(upper, lower, pole));

    const glm::dvec3 bent = upper + result.lower * lower;
    if (!(distance > 0.0) || glm::length(bent) <= kParallel * (a + b)) return result;
    result.upper = shortestRotation(bent, toTarget);
    if (glm::length(pole) > 0.0)
        result.upper = aboutAxis(toTarget / distance, result.upper * upper, pole) * result.upper;
    return result;
}

LimbRotations reachRotations(const osg::Vec3d& first, const osg::Vec3d& middle,
                             const osg::Vec3d& end, const osg::Vec3d& target,
                             const osg::Vec3d& pole) {
    const LimbTurns turns =
        reachTurns(toGlm(first), toGlm(middle), toGlm(end), toGlm(target), toGlm(pole));
    return {toOsg(turns.lower), toOsg(turns.upper), turns.reaches};
}

bool reach(osgAnimation::Bone& upper, osgAnimation::Bone& lower, osgAnimation::Bone& end,
           const osg::Vec3d& target, const osg::Vec3d& pole) {
    const auto joint = [](const osgAnimation::Bone& bone) {
        return osg::Matrixd(bone.getMatrixInSkeletonSpace()).getTrans();
    };
    const LimbRotations limb = reachRotations(joint(upper), joint(lower), joint(end), target, pole);
    rotateBone(lower, limb.lower);
    rotateBone(upper, limb.upper);
    return limb.reaches;
}

} // namespace osgSkin
