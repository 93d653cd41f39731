// SPDX-License-Identifier: MIT
#pragma once

#include "MannequinSkeleton.h"

#include <glm/gtc/quaternion.hpp>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include <string>
#include <vector>

namespace mannequin {

/// The rest skeleton in the depth-first order of a BVH file, with a lookup by joint name.
class Skeleton {
public:
    /// \param joints parents first
    explicit Skeleton(const std::vector<RestJoint>& joints = restSkeleton());

    const std::vector<RestJoint>& joints() const { return joints_; }

    /// \throw std::out_of_range if there is no such joint
    std::size_t index(const std::string& name) const;

    const RestJoint& joint(const std::string& name) const { return joints_[index(name)]; }

private:
    std::vector<RestJoint> joints_;
};

/// Rotations of the joints relative to the rest pose, each in its parent's space, and the root's
/// position.
struct Pose {
    glm::dvec3 root{0}; ///< world position of the joint Hips
    std::vector<glm::dquat> local;
};

/// Joints in world space: positions, and rotations relative to the rest pose.
struct WorldPose {
    std::vector<glm::dvec3> position;
    std::vector<glm::dquat> rotation;
    std::vector<glm::dvec3> tip; ///< a leaf's end site; for other joints, their own position
};

/// Forward kinematics.
WorldPose worldPose(const Skeleton& skeleton, const Pose& pose);

constexpr double radians(double degrees) {
    return degrees * 3.14159265358979323846 / 180;
}
constexpr double degrees(double radians) {
    return radians * 180 / 3.14159265358979323846;
}

/// Rotation about an axis of any length by an angle in degrees.
glm::dquat turn(double angle, const glm::dvec3& axis);

/// A yaw, followed by a tilt of the upright axis by `leanX` towards +X and `leanZ` towards +Z, all
/// in degrees.
glm::dquat stance(double yaw, double leanX, double leanZ);

/// A right-handed frame whose first axis is `first` and whose second lies in the half-plane of
/// `second`.
glm::dmat3 frameOf(const glm::dvec3& first, const glm::dvec3& second);

} // namespace mannequin
