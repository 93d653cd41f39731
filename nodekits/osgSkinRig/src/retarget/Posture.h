// SPDX-License-Identifier: MIT
#ifndef OSGSKINRIG_RETARGET_POSTURE_H
#define OSGSKINRIG_RETARGET_POSTURE_H

#include "retarget/RetargetTarget.h"

#include <osgSkinRig/JointRoles>
#include <osgSkinRig/Motion>
#include <osgSkinRig/RestSkeleton>
#include <osgSkinRig/Retarget>

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace osgSkin {

/// A body's posture in one pose, whatever the pose's axes.
struct Posture {
    glm::dvec3 up{0.0};     ///< unit, from the feet to the hips along the legs
    glm::dvec3 trunk{0.0};  ///< from the hips to the head, neck or shoulders
    glm::dvec3 hips{0.0};   ///< middle of both hip joints
    glm::dvec3 left{0.0};   ///< unit, from the right hip joint to the left one
    double leg = 0.0;       ///< length, hip to ankle along the bones
    double lowest = 0.0;    ///< along `up`: the lower ankle
    double knees = 0.0;     ///< degrees of flexion of the more bent knee
    double spread = 0.0;    ///< degrees between a leg and the middle of both
    double lean = 0.0;      ///< degrees between trunk and legs
    double tilt = 0.0;      ///< degrees that the hips are off level
    double elbows = 0.0;    ///< degrees of flexion of the more bent elbow; 0 without arms
    double asymmetry = 0.0; ///< degrees by which the arms hang differently; 0 without arms

    /// Whether the body stands: on straight legs, with the trunk over them.
    bool stands() const;

    /// The same, with the trunk leaning by any angle up to a right one.
    bool standsLeaning() const;

    /// Difference from a calibration pose, in which arms are straight and symmetric; 0 for such a
    /// pose.
    double untidiness() const;
};

/// The joints of an arm or a leg; -1 for missing ones.
struct LimbJoints {
    int upper = -1, lower = -1, end = -1;
    bool complete() const { return upper >= 0 && lower >= 0 && end >= 0; }
};
using LimbPair = std::array<LimbJoints, 2>; ///< left, right

/// The joints from which a body's posture is measured.
class PostureJoints {
public:
    /// \param roles of a skeleton's joints
    explicit PostureJoints(const JointRoles& roles);

    /// Whether both legs and a trunk are known.
    bool complete() const { return _complete; }

    /// The joint at the top of the trunk, if complete(): neck or head, else an upper arm.
    int top() const { return _top >= 0 ? _top : _arms[0].upper; }

    /// Nothing where a bone of the legs or the trunk has no length.
    /// \param positions of the skeleton's joints
    std::optional<Posture> measure(const std::vector<glm::dvec3>& positions) const;

private:
    LimbPair _legs, _arms;
    int _top = -1; ///< head, neck or chest
    bool _complete = false;
};

/// Detects a rig that lies while the actor stands: then the joints, or the up axes, do not match.
class StandingCheck {
public:
    /// \param rig roles of the rig's joints
    /// \param motion roles of the motion's joints
    StandingCheck(const JointRoles& rig, const JointRoles& motion);

    /// Adds a sample.
    /// \param rig positions of the rig's joints, +y up
    /// \param motion positions of the motion's joints, +y up
    void add(const std::vector<glm::dvec3>& rig, const std::vector<glm::dvec3>& motion);

    /// \throw osgSkin::Error where the rig's hips are as low as its feet in most of the samples in
    ///        which the actor's hips are above his feet
    void finish() const;

private:
    LimbPair _rig, _motion; ///< legs
    std::size_t _standing = 0, _lying = 0;
};

/// Relates a motion's skeleton to a rig that has the same joints: the same tree, but for further
/// joints of either between them, names except for a prefix and, in the joints' own frames
/// (RestJoint::frame), bones of the same directions. The poses at rest may differ, and then the
/// lengths.
struct SameSkeleton {
    double scale;    ///< from the motion's unit to the rig's
    bool restsAlike; ///< the motion's zero pose is the rig's rest pose
    bool isSameBody; ///< their bones have the same proportions

    /// [motion joint] the rotations that take the motion's zero pose to the rig's rest pose.
    std::vector<glm::dquat> toRigRest;

    /// Nothing where the skeletons differ.
    /// \param motionJoint [rig joint] which joint of the motion drives it, -1 for none
    static std::optional<SameSkeleton> find(const RestSkeleton& rig, const RestSkeleton& motion,
                                            const std::vector<int>& motionJoint);
};

/// Poses a rig that is the motion's skeleton: copies local rotations, and scales the root's
/// positions to the rig's unit.
class RotationCopy {
public:
    /// \param motion skeleton in its zero pose; it must outlive this, as the others
    /// \param rig at rest
    /// \param motionJoint [rig joint] which joint of the motion drives it, -1 for none
    /// \param same the relation of both skeletons
    RotationCopy(const RestSkeleton& motion, const RestSkeleton& rig,
                 const std::vector<int>& motionJoint, const SameSkeleton& same);

    /// \param local rotations of the motion's joints
    /// \param root position of its root
    /// \param rotations set to the rig's local ones, [rig joint]
    /// \return the position of the rig's root
    glm::dvec3 pose(const glm::dquat* local, const glm::dvec3& root, glm::dquat* rotations);

    const glm::dvec3& offset() const { return _offset; } ///< of the scaled root motion

private:
    std::size_t driver() const { return static_cast<std::size_t>(_motionJoint[_first]); }

    const RestSkeleton &_motion, &_rig;
    const std::vector<int>& _motionJoint;
    const SameSkeleton& _same;
    std::size_t _first = 0; ///< the rig's joint that the root motion moves
    glm::dvec3 _offset{0.0};
    std::vector<glm::dquat> _motionWorld, _world;
    std::vector<glm::dvec3> _motionPositions, _positions;
};

/// A pose of a skeleton, from which rotations are counted in place of its zero pose.
struct ZeroPose {
    std::vector<glm::dquat> world; ///< rotations of the joints there, from the zero pose
    glm::dvec3 root;               ///< position of the root joint there

    /// The skeleton in that pose.
    RestSkeleton applyTo(const RestSkeleton& skeleton) const;
};

/// The pose that a motion's rotations are made relative to, so that they can be applied to another
/// body: one in which its actor stands.
struct StandingPose {
    std::optional<ZeroPose> counted; ///< nothing where the motion's own zero pose serves

    /// Set where the rig is the motion's skeleton and neither rests standing: local rotations are
    /// copied.
    std::optional<SameSkeleton> copied;

    bool isSame = false; ///< whether the rig is the motion's skeleton

    /// From the motion's unit to the rig's, if they also have the same proportions.
    std::optional<double> bodyScale;

    std::vector<std::string> notes; ///< for the report
};

/// Finds that pose: the zero pose where the actor stands in it, by legs, trunk and hips; else the
/// rig's rest pose where the skeletons are the same; else the standing sample that is nearest to a
/// calibration pose, or a lying one, rotated upright. That sample is turned to the front of its
/// space (+z where y is up, -y where z is), so that headings remain the file's.
/// \param motion in any zero pose
/// \param rig at rest
/// \param map of their joints
/// \param stated the axis that is up in the motion's space, if the caller knows it
/// \throw osgSkin::Error where the actor stands in no sample
StandingPose findStandingPose(const Motion& motion, const RestSkeleton& rig, const JointPairs& map,
                              RetargetOptions::Up stated);

} // namespace osgSkin

#endif
