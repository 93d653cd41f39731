// SPDX-License-Identifier: MIT
#pragma once

#include "Subject.h"

#include <osgSkinRig/RestSkeleton>

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

#include <cstddef>
#include <string>
#include <vector>

namespace quality {

/// A pose that is composed joint by joint. Bodies stand with +y up and face +z; their left is +x.
/// Joints that the rig lacks are ignored. All angles are in degrees.
class BodyPose {
public:
    /// The rest pose.
    /// \param rig must outlive this
    explicit BodyPose(const osgSkin::RestSkeleton& rig);

    /// Rotates a joint about an axis of its parent's frame, after its rotation so far.
    BodyPose& rotate(const std::string& joint, const glm::dvec3& axis, double degrees);

    /// Points a joint's bone in a direction of the body's space by the shortest rotation. Pose its
    /// parents first.
    ///
    /// \param joint the bone's joint
    /// \param direction of any length
    /// \param roll about that direction afterwards
    BodyPose& aim(const std::string& joint, const glm::dvec3& direction, double roll = 0.0);

    /// Twists a joint about a bone at rest, before its rotation so far.
    /// \param joint to twist
    /// \param degrees of the twist
    /// \param along the joint whose bone is the axis; empty: the joint's own
    BodyPose& twist(const std::string& joint, double degrees, const std::string& along = {});

    /// Bends only an elbow or a knee, so that its two bones enclose an angle. Knees bend about the
    /// x axis, elbows about their axis at rest.
    /// \param joint elbow or knee
    /// \param flexion 0 if both bones are in line
    BodyPose& flex(const std::string& joint, double flexion);

    /// The rotation of a joint relative to its parent; unit.
    glm::dquat& local(std::size_t joint) { return _local[joint]; }

    /// The unit direction of a joint's bone at rest: to its first child, or else to its tip.
    glm::dvec3 bone(const std::string& joint) const;

    /// G_j of each joint of the rig.
    std::vector<glm::dmat4> skinning() const;

private:
    glm::dquat world(int joint) const;

    const osgSkin::RestSkeleton* _rig;
    std::vector<glm::dquat> _local;
};

/// The first child of a joint, or -1.
int firstChild(const osgSkin::RestSkeleton& rig, int joint);

/// A pose that is hard to skin, and a camera for it.
struct DemandingPose {
    NamedPose pose;
    std::string centre;        ///< the joint in the middle of the picture
    double height;             ///< of the picture, relative to the body's
    double azimuth, elevation; ///< of the camera, degrees; 0, 0 is in front of the body
};

/// Twenty-four poses, with the joint names of the CMU rig.
std::vector<DemandingPose> demandingPoses(const osgSkin::RestSkeleton& rig);

/// Hips and knees bent by 90 degrees.
BodyPose sittingPose(const osgSkin::RestSkeleton& rig);

} // namespace quality
