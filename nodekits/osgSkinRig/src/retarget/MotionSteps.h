// SPDX-License-Identifier: MIT
#ifndef OSGSKINRIG_RETARGET_MOTIONSTEPS_H
#define OSGSKINRIG_RETARGET_MOTIONSTEPS_H

#include "retarget/RetargetTarget.h"

#include <osgSkinRig/Clip>
#include <osgSkinRig/FootSkate>
#include <osgSkinRig/JointRoles>
#include <osgSkinRig/Motion>
#include <osgSkinRig/RestSkeleton>

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

#include <cstddef>
#include <optional>
#include <vector>

namespace osgSkin {

/// The twist of `q` about a unit axis, -pi..pi, after removing the swing.
double twistAbout(const glm::dvec3& axis, const glm::dquat& q);

/// Corrects feet that a motion rolls upside down.
///
/// One or two markers decide how a foot is rolled about its own length, and some clips have it
/// upside down for seconds while the toes point in the right direction. No ankle does that, and
/// skin that follows collapses. A roll beyond 90 degrees from the shin's is mirrored at 90: 100
/// becomes 80, 180 becomes 0. So nothing jumps, and the toes keep their direction.
class FootRoll {
public:
    /// \param body the rig and its motion; it must outlive this
    /// \param alignment for each rig joint, from its rest bone to the motion's
    FootRoll(const RetargetTarget& body, const std::vector<glm::dquat>& alignment);

    /// Corrects the feet and rotates their descendants along.
    /// \param world rotations of the rig's joints from rest, one for each
    void straighten(std::vector<glm::dquat>& world);

    /// The number of poses so far in which a foot was upside down; 0 for other joints.
    std::size_t flippedFrames(std::size_t joint) const { return _flippedFrames[joint]; }

private:
    struct Foot {
        int joint;
        glm::dvec3 length; ///< unit, at rest: direction of the motion's foot
    };
    void rotate(int joint, const glm::dquat& by, std::vector<glm::dquat>& world) const;

    const SkeletonTree& _rig;
    std::vector<Foot> _feet;
    std::vector<std::size_t> _flippedFrames; ///< [joint]
};

/// Collar bones that follow the arms, where the motion does not move them.
///
/// People lift a shoulder when they lift the arm, and bring it forward with the arm. Of the arm's
/// rotation in the chest's frame, from halfway between hanging and level, a collar bone takes .22
/// about the vertical and .12 about the front, less what it takes at rest: so the rest pose stays.
/// Both numbers were fitted to scans of five people in nine poses, and move the shoulders of five
/// others nearer to theirs than collar bones that stay.
class CollarBones {
public:
    /// \param body the rig and its motion
    /// \param motion whose samples tell whether it moves its collar bones; a single sample moves
    ///        every collar bone that it has
    CollarBones(const RetargetTarget& body, const Motion& motion);

    /// Rotates them, and what hangs on them at rest.
    /// \param world rotations of the rig's joints from rest, one for each, as the motion drives them
    void follow(std::vector<glm::dquat>& world) const;

private:
    struct Collar {
        int chest, upperArm;
        std::vector<int> joints; ///< the collar bone, and what hangs on it at rest
        glm::dvec3 arm;          ///< direction of the upper arm at rest
        glm::dvec3 halfway;
        glm::dquat atRest; ///< what taken() gives for `arm`
    };
    glm::dquat taken(const Collar& collar, const glm::dvec3& arm) const;

    glm::dvec3 _front{0.0};
    std::vector<Collar> _collars;
};

/// Measures how far the rig's feet slide while the actor's feet are planted.
///
/// Feet are the rig's leg joints near the floor that the motion drives.
class MeasureFeet {
public:
    /// \param body the rig and its motion; it must outlive this
    explicit MeasureFeet(const RetargetTarget& body);

    /// Positions of a skeleton's joints in a sample, and their rotations from the zero pose.
    struct Posed {
        const std::vector<glm::dvec3>& positions;
        const std::vector<glm::dquat>& world;
    };

    /// Adds a sample.
    void add(const Posed& rig, const Posed& motion);

    /// The results, one per foot.
    /// \param frameTime seconds between samples
    /// \param scale of the root motion
    std::vector<FootSkate> finish(double frameTime, double scale) const;

private:
    struct Foot {
        int rigJoint, motionJoint;
        double rigLeg, motionLeg;
        BonePair ball;                       ///< from the ankle, at rest
        std::vector<glm::dvec3> rig, motion; ///< positions, [frame]
    };

    const RetargetTarget& _body;
    std::vector<Foot> _feet;
};

/// Transfers the root motion to a rig of another size, and puts the feet on the floor.
///
/// The root motion is that of the first rig joint that the motion drives (the hips), relative to
/// its position in the motion's zero pose and scaled by the ratio of hip heights. Heights are then
/// shifted by one number for the whole clip, so that the feet's lowest position is the floor that
/// the rig stands on at rest. A jump stays a jump: the shift is taken from the frames in which the
/// feet are lowest. A motion that begins far from the origin begins where the rig rests.
///
/// A motion of the rig's own skeleton keeps its heights, as a model's own clips do, if both have
/// the same size and nearly the same floor.
class RootPath {
public:
    /// \param body the rig and its motion; it must outlive this
    /// \param bodyScale see StandingPose
    RootPath(const RetargetTarget& body, std::optional<double> bodyScale);

    double scale() const { return _scale; }

    /// The position of the rig's root in one pose, before finish() puts it on the floor.
    /// \param motionRoot position of the motion's root
    /// \param motionWorld world orientations of the motion's joints
    /// \param rigWorld world orientations of the rig's joints
    glm::dvec3 place(const glm::dvec3& motionRoot, const std::vector<glm::dquat>& motionWorld,
                     const std::vector<glm::dquat>& rigWorld);

    /// Adds a sample: as place(), and remembers it for finish().
    void add(const glm::dvec3& motionRoot, const std::vector<glm::dquat>& motionWorld,
             const std::vector<glm::dquat>& rigWorld);

    /// Positions of the joints in the pose of the last call; the rig's before finish() puts it on
    /// the floor.
    const std::vector<glm::dvec3>& motionPositions() const { return _motionPositions; }
    const std::vector<glm::dvec3>& rigPositions() const { return _rigPositions; }

    /// The offset of the scaled root motion, after finish(): hips = scale * motion's hips +
    /// offset.
    const glm::dvec3& offset() const { return _offset; }

    /// The position of the rig's root in each sample.
    std::vector<glm::dvec3> finish();

    /// Whether finish() moved the motion to the origin.
    bool movedToOrigin() const { return _movedToOrigin; }

    /// How far finish() raised the body's own motion, whose floor is not the body's; hip heights.
    double raised() const { return _raised; }

private:
    void startAtOrigin();
    double lowestFoot(const std::vector<glm::dquat>& rigWorld) const;

    const RetargetTarget& _body;
    bool _isSameBody;
    bool _stands = false; ///< in a sample
    int _rigHips = 0;
    int _motionHips = 0;
    double _rigHeight = 0.0; ///< of the hips
    double _scale = 1.0;
    glm::dvec3 _offset{0.0};
    glm::dvec3 _hips{0.0};  ///< in the last pose
    glm::dvec3 _start{0.0}; ///< of the hips in the first sample, relative to rest
    bool _movedToOrigin = false;
    double _raised = 0.0;
    std::vector<glm::dvec3> _roots;
    std::vector<double> _feet; ///< height of the lowest foot above its rest height, [sample]
    std::vector<glm::dvec3> _motionPositions, _rigPositions;
};

/// Distributes excess twist of elbows and knees to the neighbouring joints.
///
/// An elbow or a knee is a hinge, and its twist about its own bone is close to 0 on a living body.
/// A motion whose zero pose has another elbow axis than the rig leaves up to 180 degrees there,
/// where skin collapses, and jumps as the angle changes its sign. A hinge keeps 90 degrees. The
/// excess goes to the joint above (shoulder or hip, about the upper bone) and to the one below
/// (wrist or ankle, about the hinge's bone), such that the larger of their two twists is as small
/// as possible. The bones' directions, the joints' positions and the world rotation of the hand or
/// foot with its descendants do not change.
///
/// Twists are unwrapped over the poses, so that none of the three angles jumps where the hinge's
/// twist runs through 180 degrees. Beyond 270 degrees the shorter angle is taken again.
class HingeTwist {
public:
    /// \param rig must outlive this
    /// \param roles of the rig's joints
    HingeTwist(const RestSkeleton& rig, const JointRoles& roles);

    /// Unwraps over a whole clip, around the middle one of its angles.
    /// \param clip of the rig; changed only in samples in which a hinge has more than 90 degrees
    /// \return for each joint, the number of samples in which its twist was distributed
    std::vector<std::size_t> share(Clip& clip) const;

    /// Continues from the pose before; the first has the shortest angles.
    /// \param local rotations of the rig's joints
    void shareNext(glm::dquat* local);

    /// The next pose is the first one.
    void restart();

private:
    struct Limb {
        std::size_t upper, hinge, end;
        std::vector<std::size_t> aboveHinge, aboveEnd; ///< joints between them, parents first
        glm::dvec3 last{0.0}; ///< twists of upper, hinge and end in the pose before
    };
    class LimbPose;

    const RestSkeleton& _rig;
    std::vector<Limb> _limbs;
};

} // namespace osgSkin

#endif
