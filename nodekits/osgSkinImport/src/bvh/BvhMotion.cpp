// SPDX-License-Identifier: MIT
#include "bvh/BvhMotion.h"

#include "scene/RootJoint.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/trigonometric.hpp>

#include <utility>
#include <vector>

namespace osgSkin {
namespace {

glm::dquat rotationAbout(int axis, double degrees) {
    glm::dvec3 direction(0.0);
    direction[axis] = 1.0;
    return glm::angleAxis(glm::radians(degrees), direction);
}

glm::dquat localRotation(const BvhJoint& joint, const double* frame) {
    glm::dquat result(1.0, 0.0, 0.0, 0.0);
    const double* value = frame + joint.firstChannel;
    for (const BvhChannel& channel : joint.channels) {
        if (channel.isRotation) result = result * rotationAbout(channel.axis, *value);
        ++value;
    }
    return result;
}

glm::dvec3 localPosition(const BvhJoint& joint, const double* frame) {
    glm::dvec3 result = joint.offset;
    const double* value = frame + joint.firstChannel;
    for (const BvhChannel& channel : joint.channels) {
        if (!channel.isRotation) result[channel.axis] = *value;
        ++value;
    }
    return result;
}

/// The scale that enlarges a figure smaller than one unit to one unit; otherwise 1.
double unitScale(const BvhFile& file) {
    glm::dvec3 low(0.0), high(0.0);
    std::vector<glm::dvec3> centres;
    for (const BvhJoint& joint : file.joints) {
        const bool isHeldByFrames = joint.offset == glm::dvec3(0.0) && file.frames > 0;
        glm::dvec3 centre = isHeldByFrames ? localPosition(joint, file.frame(0)) : joint.offset;
        if (joint.parent < 0) centre = glm::dvec3(0.0);
        if (joint.parent >= 0) centre += centres[static_cast<std::size_t>(joint.parent)];
        centres.push_back(centre);
        low = glm::min(low, centre);
        high = glm::max(high, centre);
    }
    const double size = glm::distance(low, high);
    return size > 0.0 && size < 1.0 ? 1.0 / size : 1.0;
}

bool movesFrom(const BvhFile& file, std::size_t frame, const BvhJoint& joint,
               const glm::dvec3& atRest, double figure) {
    return isMoved(figure * localPosition(joint, file.frame(frame)), figure * atRest);
}

/// A joint's offset from its parent. Some exporters leave OFFSET zero and repeat the offset in the
/// position channels of every frame.
glm::dvec3 offsetOf(const BvhFile& file, const BvhJoint& joint, double figure) {
    if (joint.parent < 0 || !joint.hasPosition() || file.frames == 0 ||
        joint.offset != glm::dvec3(0.0))
        return joint.offset;
    const glm::dvec3 first = localPosition(joint, file.frame(0));
    for (std::size_t f = 1; f < file.frames; ++f)
        if (movesFrom(file, f, joint, first, figure)) return joint.offset;
    return first;
}

/// For each joint, whether its position channels move it from its offset.
std::vector<bool> findMovedJoints(const BvhFile& file) {
    std::vector<bool> result(file.joints.size(), false);
    const double figure = unitScale(file);
    for (std::size_t j = 0; j < result.size(); ++j) {
        const BvhJoint& joint = file.joints[j];
        if (!joint.hasPosition()) continue;
        const glm::dvec3 offset = offsetOf(file, joint, figure);
        for (std::size_t f = 0; f < file.frames && !result[j]; ++f)
            result[j] = movesFrom(file, f, joint, offset, figure);
    }
    return result;
}

} // namespace

RestSkeleton makeRestSkeleton(const BvhFile& file) {
    RestSkeleton result;
    const double figure = unitScale(file);
    std::vector<bool> isLeaf(file.joints.size(), true);
    for (const BvhJoint& joint : file.joints) {
        glm::dvec3 centre = offsetOf(file, joint, figure);
        if (joint.parent >= 0) {
            const auto parent = static_cast<std::size_t>(joint.parent);
            isLeaf[parent] = false;
            centre += result.joints[parent].centre;
        }
        result.joints.push_back({joint.name, joint.parent, centre, {}});
    }
    for (std::size_t j = 0; j < result.joints.size(); ++j)
        if (isLeaf[j] && file.joints[j].endSite)
            result.joints[j].tip = result.joints[j].centre + *file.joints[j].endSite;
    return result;
}

Motion makeMotion(const BvhFile& file, const std::string& path) {
    const RestSkeleton skeleton = makeRestSkeleton(file);
    const std::vector<bool> moved = findMovedJoints(file);
    const std::size_t root = rootMotionJoint(skeleton, moved);

    Motion motion;
    ReducedSkeleton carried(skeleton, root);
    warnUnusedMoves(skeleton, moved, carried, path);
    motion.skeleton = std::move(carried.rest);
    motion.frameTime = file.frameTime;
    motion.frames = file.frames;
    motion.rotations.reserve(file.frames * motion.skeleton.joints.size());
    motion.rootPositions.reserve(file.frames);
    std::vector<bool> isAbove(file.joints.size());
    for (const std::size_t j : carried.above) isAbove[j] = true;
    // World rotations of the root and the joints above it.
    std::vector<glm::dquat> world(file.joints.size());
    for (std::size_t f = 0; f < file.frames; ++f) {
        const double* frame = file.frame(f);
        glm::dvec3 position(0.0);
        glm::dquat above(1.0, 0.0, 0.0, 0.0);
        for (const std::size_t j : carried.above) {
            position += above * localPosition(file.joints[j], frame);
            world[j] = above = above * localRotation(file.joints[j], frame);
        }
        position += above * localPosition(file.joints[root], frame);
        for (const std::size_t j : carried.joints) {
            const glm::dquat local = localRotation(file.joints[j], frame);
            const int parent = file.joints[j].parent;
            if (j == root)
                motion.rotations.push_back(glm::normalize(world[j] = above * local));
            else if (isAbove[static_cast<std::size_t>(parent)])
                motion.rotations.push_back(glm::normalize(
                    glm::conjugate(world[root]) * world[static_cast<std::size_t>(parent)] * local));
            else
                motion.rotations.push_back(glm::normalize(local));
        }
        motion.rootPositions.push_back(position);
    }
    return motion;
}

} // namespace osgSkin
