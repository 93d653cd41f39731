// SPDX-License-Identifier: MIT
#include "reference/CountedFrom.h"

#include <osgSkinRig/ForwardKinematics>

namespace osgSkin {

Motion countedFrom(const Motion& motion, const std::vector<glm::dquat>& world,
                   const glm::dvec3& root) {
    Motion result = motion;
    std::vector<glm::dvec3> positions;
    worldPositions(motion.skeleton, world, root, positions);
    for (std::size_t j = 0; j < world.size(); ++j) {
        RestJoint& joint = result.skeleton.joints[j];
        if (joint.tip) joint.tip = positions[j] + world[j] * (*joint.tip - joint.centre);
        joint.centre = positions[j];
        joint.frame = glm::normalize(world[j] * joint.frame);
    }
    std::vector<glm::dquat> turned;
    for (std::size_t f = 0; f < motion.frames; ++f) {
        worldRotations(motion.skeleton, &motion.rotation(f, 0), turned);
        for (std::size_t j = 0; j < world.size(); ++j)
            turned[j] = glm::normalize(turned[j] * glm::conjugate(world[j]));
        for (std::size_t j = 0; j < world.size(); ++j) {
            const int parent = result.skeleton.joints[j].parent;
            result.rotations[f * world.size() + j] =
                parent < 0
                    ? turned[j]
                    : glm::normalize(glm::conjugate(turned[std::size_t(parent)]) * turned[j]);
        }
    }
    return result;
}

} // namespace osgSkin
