// SPDX-License-Identifier: MIT
#include "reference/CopyRotations.h"

#include <osgSkinRig/ForwardKinematics>

#include <cstddef>

namespace osgSkin {

Clip copyRotations(const Motion& motion, const RestSkeleton& rig,
                   const std::vector<int>& motionJoint, const SameSkeleton& same,
                   glm::dvec3& offset) {
    std::size_t first = 0; // the joint that the root motion moves
    while (motionJoint[first] < 0) ++first;
    const auto driver = static_cast<std::size_t>(motionJoint[first]);
    offset = rig.joints[first].centre - same.scale * motion.skeleton.joints[driver].centre;

    Clip clip;
    clip.name = motion.name;
    clip.frameTime = motion.frameTime;
    clip.frames = motion.frames;
    clip.joints = rig.joints.size();
    std::vector<glm::dquat> motionWorld, world(clip.joints);
    std::vector<glm::dvec3> motionPositions, positions;
    for (std::size_t f = 0; f < motion.frames; ++f) {
        worldRotations(motion.skeleton, &motion.rotation(f, 0), motionWorld);
        for (std::size_t j = 0; j < clip.joints; ++j) {
            const int parent = rig.joints[j].parent;
            const glm::dquat above = parent < 0 ? glm::dquat(1.0, 0.0, 0.0, 0.0)
                                                : world[static_cast<std::size_t>(parent)];
            world[j] = above;
            if (motionJoint[j] >= 0) {
                const auto m = static_cast<std::size_t>(motionJoint[j]);
                world[j] = glm::normalize(motionWorld[m] * glm::conjugate(same.toRigRest[m]));
            }
            clip.rotations.push_back(glm::normalize(glm::conjugate(above) * world[j]));
        }
        worldPositions(motion.skeleton, motionWorld, motion.rootPositions[f], motionPositions);
        worldPositions(rig, world, glm::dvec3(0.0), positions);
        clip.rootPositions.push_back(same.scale * motionPositions[driver] + offset -
                                     positions[first]);
    }
    return clip;
}

} // namespace osgSkin
