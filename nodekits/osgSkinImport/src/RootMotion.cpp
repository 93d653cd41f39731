// SPDX-License-Identifier: MIT
#include "RootMotion.h"

#include <algorithm>
#include <limits>

namespace osgSkin {
namespace {

/// Height of the hips above the lowest point of the legs.
double hipHeight(const SkeletonTree& tree, int hips) {
    return tree.centre(hips).y - findBodyParts(tree).lowest;
}

} // namespace

RootMotion::RootMotion(const SkeletonTree& rig, const SkeletonTree& motion,
                       const std::vector<int>& motionJoint)
    : _rig(rig), _motion(motion), _rigParts(findBodyParts(rig)) {
    while (motionJoint[static_cast<std::size_t>(_rigHips)] < 0) ++_rigHips;
    _motionHips = motionJoint[static_cast<std::size_t>(_rigHips)];
    const double rigHeight = hipHeight(rig, _rigHips);
    const double motionHeight = hipHeight(motion, _motionHips);
    // Without legs below the hips there is no height to compare: keep the motion's unit.
    if (rigHeight > 1e-6 * rig.reach() && motionHeight > 1e-6 * motion.reach())
        _scale = rigHeight / motionHeight;
}

void RootMotion::add(const glm::dvec3& motionRoot, const std::vector<glm::dquat>& motionWorld,
                     const std::vector<glm::dquat>& rigWorld) {
    worldPositions(_motion.rest(), motionWorld, motionRoot, _places);
    const glm::dvec3 way =
        _places[static_cast<std::size_t>(_motionHips)] - _motion.centre(_motionHips);
    const glm::dvec3 hips = _rig.centre(_rigHips) + _scale * way;

    worldPositions(_rig.rest(), rigWorld, glm::dvec3(0.0), _places);
    const glm::dvec3 root = hips - _places[static_cast<std::size_t>(_rigHips)];
    _roots.push_back(root);
    if (!_rigParts.feet.empty()) _feet.push_back(root.y + lowestFoot(rigWorld));
}

double RootMotion::lowestFoot(const std::vector<glm::dquat>& rigWorld) const {
    double lowest = std::numeric_limits<double>::infinity();
    for (const int j : _rigParts.feet) {
        const auto index = static_cast<std::size_t>(j);
        const RestJoint& joint = _rig.joint(j);
        const glm::dvec3& place = _places[index];
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
    // Not the very lowest: one noisy sample must not lift the whole clip.
    const auto low = _feet.begin() + static_cast<std::ptrdiff_t>(_feet.size() / 20);
    std::nth_element(_feet.begin(), low, _feet.end());
    for (glm::dvec3& root : _roots) root.y -= *low;
    return std::move(_roots);
}

} // namespace osgSkin
