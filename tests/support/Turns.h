// SPDX-License-Identifier: MIT
#pragma once

#include <osgSkin/Binding>

#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/mat4x4.hpp>

#include <random>
#include <vector>

namespace test {

inline glm::dvec3 randomUnit(std::mt19937_64& random) {
    std::normal_distribution<double> normal;
    glm::dvec3 v;
    do v = {normal(random), normal(random), normal(random)};
    while (glm::length(v) < 1e-3);
    return glm::normalize(v);
}

inline glm::dquat randomRotation(std::mt19937_64& random) {
    std::normal_distribution<double> normal;
    return glm::normalize(
        glm::dquat(normal(random), normal(random), normal(random), normal(random)));
}

/// Skinning matrices G_j from each joint's own rotation about its centre: G_j = G_parent * D_j.
inline std::vector<glm::dmat4> skinningFrom(const std::vector<osgSkin::BoundJoint>& joints,
                                            const std::vector<glm::dquat>& turns,
                                            const glm::dvec3& rootOffset = glm::dvec3(0.0)) {
    std::vector<glm::dmat4> skinning;
    for (std::size_t j = 0; j < joints.size(); ++j) {
        const glm::dmat4 turn = glm::translate(glm::dmat4(1.0), joints[j].centre) *
                                glm::mat4_cast(turns[j]) *
                                glm::translate(glm::dmat4(1.0), -joints[j].centre);
        skinning.push_back(joints[j].parent < 0
                               ? glm::translate(glm::dmat4(1.0), rootOffset) * turn
                               : skinning[static_cast<std::size_t>(joints[j].parent)] * turn);
    }
    return skinning;
}

} // namespace test
