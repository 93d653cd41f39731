// SPDX-License-Identifier: MIT
#include <osgSkinRig/ForwardKinematics>

namespace osgSkin {

void worldRotations(const RestSkeleton& skeleton, const glm::dquat* local,
                    std::vector<glm::dquat>& world) {
    world.resize(skeleton.joints.size());
    for (std::size_t j = 0; j < world.size(); ++j) {
        const int parent = skeleton.joints[j].parent;
        world[j] = parent < 0 ? local[j]
                              : glm::normalize(world[static_cast<std::size_t>(parent)] * local[j]);
    }
}

void worldPositions(const RestSkeleton& skeleton, const std::vector<glm::dquat>& world,
                    const glm::dvec3& root, std::vector<glm::dvec3>& positions) {
    positions.resize(skeleton.joints.size());
    for (std::size_t j = 0; j < positions.size(); ++j) {
        const RestJoint& joint = skeleton.joints[j];
        if (joint.parent < 0) {
            positions[j] = root;
            continue;
        }
        const auto p = static_cast<std::size_t>(joint.parent);
        positions[j] = positions[p] + world[p] * (joint.centre - skeleton.joints[p].centre);
    }
}

} // namespace osgSkin
