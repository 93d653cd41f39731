// SPDX-License-Identifier: MIT
#include "scene/SourceScene.h"

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include <cmath>
#include <utility>

namespace osgSkin {

int SourceScene::addNode(std::string name, int parent, const glm::dmat4& matrix) {
    const int index = static_cast<int>(nodes.size());
    nodes.push_back({std::move(name), matrix, parent, {}, {}, {}});
    if (parent >= 0) nodes[static_cast<std::size_t>(parent)].children.push_back(index);
    return index;
}

std::set<std::string> boneNames(const SourceScene& scene) {
    std::set<std::string> result;
    for (const auto& mesh : scene.meshes)
        for (const SourceBone& bone : mesh->bones) result.insert(bone.name);
    return result;
}

glm::dquat rotationOf(const glm::dmat4& matrix) {
    glm::dmat3 axes(matrix);
    const double volume = glm::determinant(axes);
    if (!(std::abs(volume) > 0.0)) return {1.0, 0.0, 0.0, 0.0}; // singular: has no rotation
    axes[0] = glm::normalize(volume < 0.0 ? -axes[0] : axes[0]);
    axes[1] = glm::normalize(axes[1] - axes[0] * glm::dot(axes[0], axes[1]));
    axes[2] = glm::cross(axes[0], axes[1]);
    return glm::normalize(glm::quat_cast(axes));
}

NodeTransform decompose(const glm::dmat4& matrix) {
    glm::dmat4 unmirrored = matrix;
    NodeTransform result{glm::dvec3(matrix[3]), {1.0, 0.0, 0.0, 0.0}, glm::dvec3(1.0)};
    for (int axis = 0; axis < 3; ++axis) result.scale[axis] = glm::length(glm::dvec3(matrix[axis]));
    if (glm::determinant(glm::dmat3(matrix)) < 0.0) {
        result.scale.x = -result.scale.x;
        unmirrored[0] = -unmirrored[0];
    }
    result.rotation = rotationOf(unmirrored);
    return result;
}

} // namespace osgSkin
