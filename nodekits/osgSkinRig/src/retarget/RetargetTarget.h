// SPDX-License-Identifier: MIT
#ifndef OSGSKINRIG_RETARGET_DRIVENRIG_H
#define OSGSKINRIG_RETARGET_DRIVENRIG_H

#include "names/BodyParts.h"
#include "skeleton/SkeletonTree.h"

#include <osgSkinRig/JointRoles>
#include <osgSkinRig/RestSkeleton>
#include <osgSkinRig/Retarget>

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

#include <cstddef>
#include <optional>
#include <vector>

namespace osgSkin {

/// The length of the prefix that all joints' names share, as in "mixamorig:Hips".
std::size_t sharedPrefix(const RestSkeleton& skeleton);

/// Which motion joint drives which rig joint.
struct JointPairs {
    std::vector<int> motionJoint; ///< [rig joint], -1 for none
    JointRoles rig, motion;
};

/// Maps the rig's joints to the motion's. The caller's map comes first (an empty motion name leaves
/// the joint at rest), then, where both skeletons are of one body, the joint of equal name, then
/// the joint of the same role, then the joint of equal name, but for a prefix of all joints, unless
/// it is known to be another part of the body. Spines and necks with different numbers of joints
/// are matched end to end.
/// \throw osgSkin::Error where the map names a joint that is not there, or no joint matches.
JointPairs mapJoints(const RestSkeleton& rig, const RestSkeleton& motion,
                     const RetargetOptions& options);

/// A rig and the motion that drives it, with both skeletons upright (+y up) and facing the same
/// direction.
struct RetargetTarget {
    /// \param uprightRig must outlive this
    /// \param uprightMotion must outlive this
    /// \param joints driving joints and roles; must outlive this
    RetargetTarget(const RestSkeleton& uprightRig, const RestSkeleton& uprightMotion,
                   const JointPairs& joints)
        : rig(uprightRig), motion(uprightMotion), map(joints),
          rigParts(findBodyParts(rig, map.rig)), motionParts(findBodyParts(motion, map.motion)) {}

    /// The motion joint that drives rig joint `j`, -1 for none.
    int driver(int j) const { return map.motionJoint[static_cast<std::size_t>(j)]; }

    SkeletonTree rig, motion;
    const JointPairs& map;
    BodyParts rigParts, motionParts;
};

/// A bone in both skeletons, from the joint to its end in their zero poses.
struct BonePair {
    glm::dvec3 rig;
    glm::dvec3 motion;
};

/// The bone of rig joint `j`, which the motion drives: to a descendant that both skeletons have, or
/// else to each skeleton's own end. Nothing where either has no length.
std::optional<BonePair> findBone(const RetargetTarget& body, int j);

/// The directions of rig foot `j` and of its driver: from the ankle to the ball of the foot, or
/// those of the toes if the ball is straight below the ankle; zero where it is unknown.
/// \param bone of the foot, see findBone()
BonePair alongSoles(const RetargetTarget& body, int j, const BonePair& bone);

/// The rotations A that take the rig's rest bones to the motion's zero-pose bones, one per rig
/// joint.
///
/// Trunk joints are not aligned. A limb joint whose bone has no direction in either skeleton takes
/// its parent's rotation, so that it does not rotate against the limb.
std::vector<glm::dquat> alignBones(const RetargetTarget& body);

/// The roles of the motion's joints: its own, or else those of the rig's joints that they drive.
JointRoles motionRolesOf(const JointPairs& map);

/// Rotations from a rig's and a motion's space to a common upright one, found by both skeletons'
/// rest poses.
///
/// Up is BodyDirections::up(); left is from the right hip to the left one, or else from shoulder to
/// shoulder. Both need the roles of joints: without roles, +y is taken as up; without pairs, both
/// skeletons are taken to face the same direction.
struct UprightFrames {
    glm::dquat rigUpright{1.0, 0.0, 0.0, 0.0}; ///< from the rig's space to one with +y up

    /// From the motion's space to that one, so that both skeletons face the same direction.
    glm::dquat motionUpright{1.0, 0.0, 0.0, 0.0};
};

/// A skeleton without roles takes those of the joints that it is mapped to.
UprightFrames findUprightFrames(const RestSkeleton& rig, const RestSkeleton& motion,
                                const JointPairs& map);

/// The skeleton, rotated.
RestSkeleton rotated(const RestSkeleton& skeleton, const glm::dquat& rotation);

} // namespace osgSkin

#endif
