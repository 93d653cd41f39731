// SPDX-License-Identifier: MIT
#include "DualQuaternionBlend.h"

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include <cmath>
#include <stdexcept>

namespace compare {
namespace {

constexpr double kRigidTolerance = 1e-6;

bool isRigid(const glm::dmat4& m) {
    const glm::dmat3 r(m);
    const glm::dmat3 identity = glm::transpose(r) * r;
    for (int column = 0; column < 3; ++column) {
        if (!std::isfinite(m[3][column])) return false;
        for (int row = 0; row < 3; ++row)
            if (!(std::abs(identity[column][row] - (column == row ? 1.0 : 0.0)) < kRigidTolerance))
                return false;
    }
    return glm::determinant(r) > 0.0;
}

/// The vertex's joint of largest weight, the first one where several are equal.
std::uint32_t heaviest(const SkinWeights& weights, std::size_t v) {
    std::uint32_t best = weights.first[v];
    for (std::uint32_t i = best; i < weights.first[v + 1]; ++i)
        if (weights.entries[i].weight > weights.entries[best].weight) best = i;
    return weights.entries[best].joint;
}

DualQuaternion blend(const SkinWeights& weights, std::size_t v,
                     const std::vector<DualQuaternion>& joints) {
    const DualQuaternion& pivot = joints[heaviest(weights, v)];
    DualQuaternion sum{{0.0, 0.0, 0.0, 0.0}, {0.0, 0.0, 0.0, 0.0}};
    for (std::uint32_t i = weights.first[v]; i < weights.first[v + 1]; ++i) {
        const DualQuaternion& q = joints[weights.entries[i].joint];
        const double sign = glm::dot(pivot.real, q.real) < 0.0 ? -1.0 : 1.0;
        sum.real = sum.real + q.real * (sign * weights.entries[i].weight);
        sum.dual = sum.dual + q.dual * (sign * weights.entries[i].weight);
    }
    // Never zero: the pivot has the largest weight, and no other part points against it.
    const double length = glm::length(sum.real);
    return {sum.real * (1.0 / length), sum.dual * (1.0 / length)};
}

glm::dmat4 toMatrix(const DualQuaternion& q) {
    glm::dmat4 result = glm::mat4_cast(q.real);
    const glm::dquat translation = q.dual * glm::conjugate(q.real) * 2.0;
    result[3] = glm::dvec4(translation.x, translation.y, translation.z, 1.0);
    return result;
}

} // namespace

DualQuaternion toDualQuaternion(const glm::dmat4& rigid) {
    if (!isRigid(rigid))
        throw std::invalid_argument(
            "dual quaternion: expected a matrix that only turns and shifts");
    const glm::dquat real = glm::normalize(glm::quat_cast(glm::dmat3(rigid)));
    return {real, glm::dquat(0.0, glm::dvec3(rigid[3])) * real * 0.5};
}

std::vector<glm::dmat4> dualQuaternionBlendMatrices(const SkinWeights& weights,
                                                    const std::vector<glm::dmat4>& skinning) {
    weights.validate(skinning.size());
    std::vector<DualQuaternion> joints;
    joints.reserve(skinning.size());
    for (const glm::dmat4& matrix : skinning) joints.push_back(toDualQuaternion(matrix));
    std::vector<glm::dmat4> result;
    result.reserve(weights.vertexCount());
    for (std::size_t v = 0; v < weights.vertexCount(); ++v)
        result.push_back(toMatrix(blend(weights, v, joints)));
    return result;
}

std::vector<glm::dvec3> dualQuaternionBlend(const std::vector<glm::dvec3>& rest,
                                            const SkinWeights& weights,
                                            const std::vector<glm::dmat4>& skinning) {
    return transformPoints(dualQuaternionBlendMatrices(weights, skinning), rest);
}

} // namespace compare
