// SPDX-License-Identifier: MIT
#include "retarget/MotionSteps.h"

#include <osgSkinRig/ForwardKinematics>

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace osgSkin {
namespace {

/// A body whose hips rest lower than this share of its legs' length is sitting.
constexpr double kSits = 0.9;

/// Height of the hips above the lowest point of the legs; for a sitting body, as if it stood; 0
/// without legs.
double hipHeight(const SkeletonTree& tree, const BodyParts& parts, int hips) {
    if (!parts.stands) return 0.0;
    const double atRest = tree.centre(hips).y - parts.lowest;
    double standing = 0.0;
    for (int j : parts.ankles) {
        double leg = tree.centre(j).y - parts.lowest; // below the ankle
        for (int above = tree.joint(j).parent;
             above >= 0 && parts.isLimb[static_cast<std::size_t>(above)];
             j = above, above = tree.joint(j).parent)
            leg += glm::distance(tree.centre(j), tree.centre(above));
        standing = std::max(standing, leg + tree.centre(hips).y - tree.centre(j).y);
    }
    return atRest < kSits * standing ? standing : atRest;
}

/// How far above its lowest position, in hip heights, a foot still counts as standing: walking feet
/// roll over heel and toes, and a motion's feet have another shape than the rig's.
constexpr double kContactBand = 0.06;

/// Largest distance from the origin at a motion's start, in hip heights: more than any stage's
/// width.
constexpr double kFar = 5.0;

/// How far the feet may be off the rig's floor, in hip heights, where both files have the same one.
constexpr double kSameFloor = 0.25;

/// How much nearer to the hips' height than at rest the lower foot of one who stands may be, in hip
/// heights. Who never stands, as in a flip, tells no floor.
constexpr double kCrouch = 0.25;

/// The median height of the feet in the samples in which they stand, so that samples in the air or
/// on a ladder, or a single noisy one, do not count.
double floorHeight(std::vector<double> feet, double band) {
    std::sort(feet.begin(), feet.end());
    const double lowest = feet[feet.size() / 20];
    const auto end = std::upper_bound(feet.begin(), feet.end(), lowest + band);
    return feet[static_cast<std::size_t>(end - feet.begin()) / 2];
}

} // namespace

RootPath::RootPath(const RetargetTarget& body, std::optional<double> bodyScale)
    : _body(body), _isSameBody(bodyScale.has_value()) {
    // The hips, or else the first joint that has a driver.
    const int joints = static_cast<int>(body.rig.rest().joints.size());
    while (_rigHips < joints && body.driver(_rigHips) != 0) ++_rigHips;
    if (_rigHips == joints)
        for (_rigHips = 0; body.driver(_rigHips) < 0;) ++_rigHips;
    _motionHips = body.driver(_rigHips);
    _rigHeight = hipHeight(body.rig, body.rigParts, _rigHips);
    const double motionHeight = hipHeight(body.motion, body.motionParts, _motionHips);
    // Without legs below the hips there is no height to compare: keep the motion's unit.
    if (_rigHeight > 1e-6 * body.rig.reach() && motionHeight > 1e-6 * body.motion.reach())
        _scale = bodyScale.value_or(_rigHeight / motionHeight);
    // In the motion's zero pose the rig is at its rest position.
    _offset = body.rig.centre(_rigHips) - _scale * body.motion.centre(_motionHips);
}

glm::dvec3 RootPath::place(const glm::dvec3& motionRoot, const std::vector<glm::dquat>& motionWorld,
                           const std::vector<glm::dquat>& rigWorld) {
    worldPositions(_body.motion.rest(), motionWorld, motionRoot, _motionPositions);
    _hips = _scale * _motionPositions[static_cast<std::size_t>(_motionHips)] + _offset;
    worldPositions(_body.rig.rest(), rigWorld, glm::dvec3(0.0), _rigPositions);
    const glm::dvec3 root = _hips - _rigPositions[static_cast<std::size_t>(_rigHips)];
    for (glm::dvec3& position : _rigPositions) position += root;
    return root;
}

void RootPath::add(const glm::dvec3& motionRoot, const std::vector<glm::dquat>& motionWorld,
                   const std::vector<glm::dquat>& rigWorld) {
    const glm::dvec3 root = place(motionRoot, motionWorld, rigWorld);
    if (_roots.empty()) _start = _hips - _body.rig.centre(_rigHips);
    _roots.push_back(root);
    if (_body.rigParts.feet.empty()) return;
    _feet.push_back(lowestFoot(rigWorld));
    const double hips = _hips.y - _body.rig.centre(_rigHips).y;
    _stands = _stands || hips - _feet.back() > -kCrouch * _rigHeight;
}

double RootPath::lowestFoot(const std::vector<glm::dquat>& rigWorld) const {
    double lowest = std::numeric_limits<double>::infinity();
    for (const int j : _body.rigParts.feet) {
        const auto index = static_cast<std::size_t>(j);
        const RestJoint& joint = _body.rig.joint(j);
        const glm::dvec3& position = _rigPositions[index];
        lowest = std::min(lowest, position.y - joint.centre.y);
        if (joint.tip) {
            const glm::dvec3 tip = position + rigWorld[index] * (*joint.tip - joint.centre);
            lowest = std::min(lowest, tip.y - joint.tip->y);
        }
    }
    return lowest;
}

void RootPath::startAtOrigin() {
    const glm::dvec3 along(_start.x, 0.0, _start.z);
    if (!(_rigHeight > 1e-6 * _body.rig.reach()) || glm::length(along) < kFar * _rigHeight) return;
    _movedToOrigin = true;
    _offset -= along;
    for (glm::dvec3& root : _roots) root -= along;
}

std::vector<glm::dvec3> RootPath::finish() {
    startAtOrigin();
    if (_feet.empty()) return std::move(_roots);
    const double rise = floorHeight(_feet, kContactBand * _rigHeight);
    const bool restsOnSameFloor = std::abs(_offset.y) < 0.01 * _rigHeight;
    if (_isSameBody && restsOnSameFloor && (std::abs(rise) < kSameFloor * _rigHeight || !_stands))
        return std::move(_roots);
    if (_isSameBody && restsOnSameFloor) _raised = -rise / _rigHeight;
    _offset.y -= rise;
    for (glm::dvec3& root : _roots) root.y -= rise;
    return std::move(_roots);
}

} // namespace osgSkin
