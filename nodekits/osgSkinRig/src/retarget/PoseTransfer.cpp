// SPDX-License-Identifier: MIT
#include "retarget/PoseTransfer.h"

#include <osgSkin/GlmTypes>
#include <osgSkinRig/ForwardKinematics>

namespace osgSkin {
namespace {

/// Transforms the rotations to the space that `to` leads to.
void changeSpace(const glm::dquat& to, std::vector<glm::dquat>& rotations) {
    if (isIdentity(to)) return; // to the last bit
    for (glm::dquat& q : rotations) q = glm::normalize(to * q * glm::conjugate(to));
}

} // namespace

PoseTransfer::PoseTransfer(const RestSkeleton& motion, const RestSkeleton& rig,
                           const JointPairs& map, const StandingPose& standing)
    : PoseTransfer(motion, rig, standing.counted ? standing.counted->applyTo(motion) : motion, map,
                   standing) {}

PoseTransfer::PoseTransfer(const RestSkeleton& motion, const RestSkeleton& rig,
                           const RestSkeleton& zero, const JointPairs& map,
                           const StandingPose& standing)
    : _motion(motion), _standing(standing), _frames(findUprightFrames(rig, zero, map)),
      _uprightRig(rotated(rig, _frames.rigUpright)),
      _uprightMotion(rotated(zero, _frames.motionUpright)), _body(_uprightRig, _uprightMotion, map),
      _alignment(alignBones(_body)), _feetRoll(_body, _alignment),
      _root(_body, standing.bodyScale) {}

void PoseTransfer::drive(const glm::dquat* local, const glm::dvec3& root) {
    worldRotations(_motion, local, _motionWorld);
    if (_standing.counted)
        for (std::size_t j = 0; j < _motionWorld.size(); ++j)
            _motionWorld[j] =
                glm::normalize(_motionWorld[j] * glm::conjugate(_standing.counted->world[j]));
    changeSpace(_frames.motionUpright, _motionWorld);
    _motionRoot = _frames.motionUpright * root;

    _world.resize(_uprightRig.joints.size());
    for (std::size_t j = 0; j < _world.size(); ++j) {
        const int parent = _uprightRig.joints[j].parent;
        const int driver = _body.driver(static_cast<int>(j));
        if (driver >= 0)
            _world[j] = _motionWorld[static_cast<std::size_t>(driver)] * _alignment[j];
        else // at rest on its parent
            _world[j] = parent < 0 ? glm::dquat(1.0, 0.0, 0.0, 0.0)
                                   : _world[static_cast<std::size_t>(parent)];
    }
    if (_collars) _collars->follow(_world);
    _feetRoll.straighten(_world);
}

void PoseTransfer::getRotations(glm::dquat* local) const {
    const glm::dquat to = back();
    const bool isUpright = isIdentity(to);
    for (std::size_t j = 0; j < _world.size(); ++j) {
        const int parent = _uprightRig.joints[j].parent;
        local[j] = parent < 0
                       ? _world[j]
                       : glm::conjugate(_world[static_cast<std::size_t>(parent)]) * _world[j];
        if (!isUpright) local[j] = to * local[j] * glm::conjugate(to);
        local[j] = glm::normalize(local[j]);
    }
}

} // namespace osgSkin
