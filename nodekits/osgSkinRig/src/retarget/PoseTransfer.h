// SPDX-License-Identifier: MIT
#pragma once

#include "retarget/MotionSteps.h"
#include "retarget/Posture.h"
#include "retarget/RetargetTarget.h"

#include <osgSkinRig/RestSkeleton>

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

#include <optional>
#include <vector>

namespace osgSkin {

/// Transfers poses of a motion's skeleton to a rig by world orientations, one at a time; see
/// retarget(). Twists are left to HingeTwist.
class PoseTransfer {
public:
    /// \param motion skeleton in its zero pose
    /// \param rig at rest
    /// \param map of their joints; it must outlive this
    /// \param standing what the rotations are counted from; it must outlive this
    PoseTransfer(const RestSkeleton& motion, const RestSkeleton& rig, const JointPairs& map,
                 const StandingPose& standing);
    PoseTransfer(const PoseTransfer&) = delete;
    PoseTransfer& operator=(const PoseTransfer&) = delete;

    /// Lets collar bones follow the arms, if a motion does not move them.
    void followArms(const Motion& motion) { _collars.emplace(_body, motion); }

    /// Takes a pose.
    /// \param local rotations of the motion's joints, from its zero pose
    /// \param root position of its root
    void drive(const glm::dquat* local, const glm::dvec3& root);

    /// The rig's local rotations in that pose.
    /// \param local set, [rig joint]
    void getRotations(glm::dquat* local) const;

    /// The position of the rig's root in that pose, before it is put on the floor; see RootPath.
    glm::dvec3 place() { return back() * _root.place(_motionRoot, _motionWorld, _world); }

    /// Remembers that pose for RootPath::finish().
    void addToPath() { _root.add(_motionRoot, _motionWorld, _world); }

    /// From the upright space, in which the rest is, to the rig's.
    glm::dquat back() const { return glm::conjugate(_frames.rigUpright); }
    const UprightFrames& frames() const { return _frames; }
    const RetargetTarget& body() const { return _body; }
    const std::vector<glm::dquat>& alignment() const { return _alignment; } ///< see alignBones()
    const FootRoll& feetRoll() const { return _feetRoll; }
    RootPath& root() { return _root; }
    MeasureFeet::Posed rigPose() const { return {_root.rigPositions(), _world}; }
    MeasureFeet::Posed motionPose() const { return {_root.motionPositions(), _motionWorld}; }

private:
    PoseTransfer(const RestSkeleton& motion, const RestSkeleton& rig, const RestSkeleton& zero,
                 const JointPairs& map, const StandingPose& standing);

    const RestSkeleton _motion; ///< in its own zero pose
    const StandingPose& _standing;
    const UprightFrames _frames;
    const RestSkeleton _uprightRig, _uprightMotion; ///< the motion's in the pose counted from
    const RetargetTarget _body;
    const std::vector<glm::dquat> _alignment;
    std::optional<CollarBones> _collars;
    FootRoll _feetRoll;
    RootPath _root;
    glm::dvec3 _motionRoot{0.0};
    std::vector<glm::dquat> _motionWorld, _world;
};

} // namespace osgSkin
