// SPDX-License-Identifier: MIT
#include "assimp/mesh/Scenery.h"

#include "assimp/AssimpScene.h"

#include <glm/common.hpp>

#include <algorithm>

namespace osgSkin {
namespace {

constexpr double kLarger = 1.5; ///< than all skins together, to be no part of them

} // namespace

double Scenery::Box::size() const {
    const glm::dvec3 extent = high - low;
    return std::max({extent.x, extent.y, extent.z});
}

Scenery::Scenery(const aiScene& scene, const SceneBind& bind) : _scene(scene), _bind(bind) {
    for (const aiNode* node : bind.nodes())
        for (unsigned m = 0; m < node->mNumMeshes; ++m) {
            if (scene.mMeshes[node->mMeshes[m]]->mNumBones == 0) continue;
            const Box box = boxOf(*node, node->mMeshes[m]);
            if (!box.valid) continue;
            _skins.low = _skins.valid ? glm::min(_skins.low, box.low) : box.low;
            _skins.high = _skins.valid ? glm::max(_skins.high, box.high) : box.high;
            _skins.valid = true;
        }
}

bool Scenery::has(const aiNode& node, unsigned mesh) const {
    const Box box = boxOf(node, mesh);
    if (!_skins.valid || !box.valid) return false;
    if (box.size() > kLarger * _skins.size()) return true;
    for (int axis = 0; axis < 3; ++axis)
        if (box.low[axis] > _skins.high[axis] || box.high[axis] < _skins.low[axis]) return true;
    return false;
}

Scenery::Box Scenery::boxOf(const aiNode& node, unsigned mesh) const {
    const aiMesh& source = *_scene.mMeshes[mesh];
    const glm::dmat4 toScene = _bind.mesh(node, mesh);
    Box box;
    for (unsigned v = 0; v < source.mNumVertices; ++v) {
        const glm::dvec3 p(toScene * glm::dvec4(toGlm(source.mVertices[v]), 1.0));
        box.low = box.valid ? glm::min(box.low, p) : p;
        box.high = box.valid ? glm::max(box.high, p) : p;
        box.valid = true;
    }
    return box;
}

} // namespace osgSkin
