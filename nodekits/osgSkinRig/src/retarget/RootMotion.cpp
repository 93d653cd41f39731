// SPDX-License-Identifier: MIT
#include "retarget/RootMotion.h"

#include <algorithm>
#include <limits>

namespace osgSkin {
namespace {

/// Height of the hips above the lowest point of the legs.
double hipHeight(const SkeletonTree& tree, int hips) {
    return tree.centre(hips).y - findBodyParts(tree).lowest;
}

/// How far above its lowest place, in hip heights, a foot still counts as standing: walking feet
/// roll over heel and toes, and a motion's feet have another shape than the rig's.
constexpr double contactBand = 0.06;

/// The middle height of the feet in the samples in which they stand. Samples in the air or on a
/// ladder have no say, nor has one noisy sample alone.
double floorHeight(std::vector<double> feet, double band) {
    std::sort(feet.begin(), feet.end());
    const double lowest = feet[feet.size() / 20];
    const auto end = std::upper_bound(feet.begin(), feet.end(), lowest + band);
    return feet[static_cast<std::size_t>(end - feet.begin()) / 2];
}

} // namespace

RootMotion::RootMotion(const SkeletonTree& rig, const SkeletonTree& motion,
                       const std::vector<int>& motionJoint)
    : _rig(rig), _motion(motion), _rigParts(findBodyParts(rig)) {
    while (motionJoint[static_cast<std::size_t>(_rigHips)] < 0) ++_rigHips;
    _motionHips = motionJoint[static_cast<std::size_t>(_rigHips)];
    _rigHeight = hipHeight(rig, _rigHips);
    const double motionHeight = hipHeight(motion, _motionHips);
    // Without legs below the hips there is no height to compare: keep the motion's unit.
    if (_rigHeight > 1e-6 * rig.reach() && motionHeight > 1e-6 * motion.reach())
        _scale = _rigHeight / motionHeight;
    // In the motion's zero pose the rig stands where it rests.
    _offset = rig.centre(_rigHips) - _scale * motion.centre(_motionHips);
}

void RootMotion::add(const glm::dvec3& motionRoot, const std::vector<glm::dquat>& motionWorld,
                     const std::vector<glm::dquat>& rigWorld) {
    worldPositions(_motion.rest(), motionWorld, motionRoot, _motionPlaces);
    const glm::dvec3 hips = _scale * _motionPlaces[static_cast<std::size_t>(_motionHips)] + _offset;

    worldPositions(_rig.rest(), rigWorld, glm::dvec3(0.0), _rigPlaces);
    const glm::dvec3 root = hips - _rigPlaces[static_cast<std::size_t>(_rigHips)];
    for (glm::dvec3& place : _rigPlaces) place += root;
    _roots.push_back(root);
    if (!_rigParts.feet.empty()) _feet.push_back(lowestFoot(rigWorld));
}

double RootMotion::lowestFoot(const std::vector<glm::dquat>& rigWorld) const {
    double lowest = std::numeric_limits<double>::infinity();
    for (const int j : _rigParts.feet) {
        const auto index = static_cast<std::size_t>(j);
        const RestJoint& joint = _rig.joint(j);
        const glm::dvec3& place = _rigPlaces[index];
        lowest = std::min(lowest, place.y - joint.centre.y);
        if (joint.tip) {
            const glm::dvec3 tip = place + rigWorld[index] * (*joint.tip - joint.centre);
            lowest = std::min(lowest, tip.y - joint.tip->y);
        }
    }
    return lowest;
}

std::vector<glm::dvec3> RootMotion::finish() {
    if (_feet.empty()) return std::move(_roots);
    const double rise = floorHeight(_feet, contactBand * _rigHeight);
    _offset.y -= rise;
    for (glm::dvec3& root : _roots) root.y -= rise;
    return std::move(_roots);
}

} // namespace osgSkin
