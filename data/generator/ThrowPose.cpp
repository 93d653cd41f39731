// SPDX-License-Identifier: MIT
#include "ThrowPose.h"

#include <glm/geometric.hpp>

#include <cmath>
#include <stdexcept>

namespace mannequin {
namespace {

void appendBranch(const std::vector<RestJoint>& from, std::size_t i, int parent,
                  std::vector<RestJoint>& to) {
    const int place = static_cast<int>(to.size());
    to.push_back(from[i]);
    to.back().parent = parent;
    for (std::size_t child = i + 1; child < from.size(); ++child)
        if (from[child].parent == static_cast<int>(i)) appendBranch(from, child, place, to);
}

} // namespace

Skeleton::Skeleton(const std::vector<RestJoint>& joints) {
    appendBranch(joints, 0, -1, joints_);
}

std::size_t Skeleton::index(const std::string& name) const {
    for (std::size_t i = 0; i < joints_.size(); ++i)
        if (joints_[i].name == name) return i;
    throw std::out_of_range("no joint " + name);
}

WorldPose worldPose(const Skeleton& skeleton, const Pose& pose) {
    const std::vector<RestJoint>& joints = skeleton.joints();
    WorldPose world;
    for (std::size_t i = 0; i < joints.size(); ++i) {
        const RestJoint& joint = joints[i];
        if (joint.parent < 0) {
            world.position.push_back(pose.root);
            world.rotation.push_back(pose.local[i]);
        } else {
            const auto p = static_cast<std::size_t>(joint.parent);
            world.position.push_back(world.position[p] +
                                     world.rotation[p] * (joint.centre - joints[p].centre));
            world.rotation.push_back(world.rotation[p] * pose.local[i]);
        }
        const glm::dvec3 bone = joint.leaf ? joint.endSite - joint.centre : glm::dvec3(0);
        world.tip.push_back(world.position[i] + world.rotation[i] * bone);
    }
    return world;
}

glm::dquat turn(double angle, const glm::dvec3& axis) {
    return glm::angleAxis(radians(angle), glm::normalize(axis));
}

glm::dquat stance(double yaw, double leanX, double leanZ) {
    const double lean = std::hypot(leanX, leanZ);
    const glm::dquat heading = turn(yaw, {0, 1, 0});
    if (lean < 1e-9) return heading;
    return turn(lean, {leanZ, 0, -leanX}) * heading;
}

glm::dmat3 frameOf(const glm::dvec3& first, const glm::dvec3& second) {
    const glm::dvec3 x = glm::normalize(first);
    const glm::dvec3 z = glm::normalize(glm::cross(x, second));
    return {x, glm::cross(z, x), z};
}

} // namespace mannequin
