// SPDX-License-Identifier: MIT
#include <osgSkinMotion/RotateBone>

#include <osg/Math>
#include <osg/Matrixd>

#include <algorithm>
#include <cmath>

namespace osgSkin {
namespace {

/// Below this sine two directions are taken as parallel.
constexpr double kParallel = 1e-6;

bool isFinite(const osg::Vec3d& v) {
    return std::isfinite(v.x()) && std::isfinite(v.y()) && std::isfinite(v.z());
}

osg::Vec3d unit(osg::Vec3d v) {
    v.normalize(); // 0 stays
    return v;
}

double angleBetween(const osg::Vec3d& a, const osg::Vec3d& b) {
    return std::atan2((a ^ b).length(), a * b);
}

osg::Vec3d anyPerpendicular(const osg::Vec3d& direction) {
    const osg::Vec3d axis = std::abs(direction.x()) < 0.5 * direction.length()
                                ? osg::Vec3d(1, 0, 0)
                                : osg::Vec3d(0, 1, 0);
    return unit(direction ^ axis);
}

osg::Quat shortestArc(const osg::Vec3d& from, const osg::Vec3d& to) {
    osg::Quat rotation;
    rotation.makeRotate(from, to);
    return rotation;
}

/// The axis about which a larger angle bends the limb more.
osg::Vec3d bendAxis(const osg::Vec3d& upper, const osg::Vec3d& lower, const osg::Vec3d& pole) {
    const osg::Vec3d bent = unit(upper) ^ unit(lower);
    if (bent.length() > kParallel) return unit(bent);
    const osg::Vec3d towardsPole = unit(pole) ^ unit(upper);
    return towardsPole.length() > kParallel ? unit(towardsPole) : anyPerpendicular(upper);
}

/// The rotation about an axis that brings `from` as near to `to` as it can.
osg::Quat aboutAxis(const osg::Vec3d& axis, const osg::Vec3d& from, const osg::Vec3d& to) {
    const osg::Vec3d a = from - axis * (from * axis), b = to - axis * (to * axis);
    if (a.length() <= kParallel * from.length() || b.length() <= kParallel * to.length()) return {};
    return osg::Quat(std::atan2((a ^ b) * axis, a * b), axis);
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
    const osg::Vec3d from = osg::Matrixd::transform3x3(
        forward, osg::Matrixd(bone.getInvBindMatrixInSkeletonSpace()) * placed);
    const osg::Vec3d to = target - placed.getTrans();
    if (!isFinite(from) || !isFinite(to) || !(from.length() > 0.0) || !(to.length() > 0.0) ||
        !(maxAngle >= 0.0))
        return false;
    const double angle = angleBetween(from, to);
    osg::Vec3d axis = unit(from) ^ unit(to);
    if (axis.length() <= kParallel) axis = anyPerpendicular(from);
    rotateBone(bone, osg::Quat(std::min(angle, maxAngle), unit(axis)));
    return angle <= maxAngle;
}

LimbRotations reachRotations(const osg::Vec3d& first, const osg::Vec3d& middle,
                             const osg::Vec3d& end, const osg::Vec3d& target,
                             const osg::Vec3d& pole) {
    const osg::Vec3d upper = middle - first, lower = end - middle, toTarget = target - first;
    const double a = upper.length(), b = lower.length(), distance = toTarget.length();
    if (!(a > 0.0) || !(b > 0.0) || !std::isfinite(a + b + distance) || !isFinite(pole)) return {};
    LimbRotations result;
    const double reached = std::clamp(distance, std::abs(a - b), a + b);
    result.reaches = std::abs(reached - distance) <= 1e-9 * (a + b);

    // By the law of cosines: how far the lower bone turns from the upper one's direction.
    const double bend =
        std::acos(std::clamp((reached * reached - a * a - b * b) / (2.0 * a * b), -1.0, 1.0));
    result.lower = osg::Quat(bend - angleBetween(upper, lower), bendAxis(upper, lower, pole));

    const osg::Vec3d bent = upper + result.lower * lower;
    if (!(distance > 0.0) || bent.length() <= kParallel * (a + b)) return result;
    result.upper = shortestArc(bent, toTarget);
    if (pole.length2() > 0.0) // OSG's product rotates by the left factor first
        result.upper = result.upper * aboutAxis(unit(toTarget), result.upper * upper, pole);
    return result;
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
