// SPDX-License-Identifier: MIT
#include "assimp/SceneBind.h"

#include "assimp/AssimpScene.h"

#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace osgSkin {
namespace {

bool isInvertible(const aiMatrix4x4& m) {
    const double determinant = glm::determinant(glm::dmat3(toGlm(m)));
    return std::isfinite(determinant) && determinant != 0.0;
}

} // namespace

SceneBind::SceneBind(const aiScene& scene) {
    std::vector<const aiNode*> open{scene.mRootNode};
    _parent[scene.mRootNode] = nullptr;
    while (!open.empty()) {
        const aiNode* node = open.back();
        open.pop_back();
        const aiNode* above = _parent.at(node);
        _nodes.push_back(node);
        _byName.emplace(nameOf(*node), node);
        _depth[node] = above != nullptr ? _depth.at(above) + 1 : 0;
        _isBone[node] = false;
        const glm::dmat4 local = toGlm(node->mTransformation);
        _posed[node] = above != nullptr ? _posed.at(above) * local : local;
        for (unsigned c = node->mNumChildren; c > 0; --c) {
            open.push_back(node->mChildren[c - 1]);
            _parent[open.back()] = node;
        }
    }

    // Skins that reach further up come first: the others follow the bones that they share.
    std::vector<std::pair<int, unsigned>> skins;
    for (unsigned m = 0; m < scene.mNumMeshes; ++m)
        if (const aiBone* top = topmost(*scene.mMeshes[m]))
            skins.emplace_back(_depth.at(find(nameOf(*top))), m);
    std::sort(skins.begin(), skins.end());
    for (const auto& [depth, m] : skins) bindSkin(*scene.mMeshes[m], _skins[m]);

    for (const aiNode* node : _nodes)
        if (_bind.count(node) == 0) _bind[node] = bindFromAbove(*node);
}

const aiNode* SceneBind::find(const std::string& name) const {
    const auto found = _byName.find(name);
    return found == _byName.end() ? nullptr : found->second;
}

glm::dmat4 SceneBind::mesh(const aiNode& node, unsigned meshIndex) const {
    const auto skin = _skins.find(meshIndex);
    return skin == _skins.end() ? _bind.at(&node) : skin->second;
}

const aiBone* SceneBind::topmost(const aiMesh& mesh) const {
    const aiBone* result = nullptr;
    int least = 0;
    for (unsigned b = 0; b < mesh.mNumBones; ++b) {
        const aiNode* node = find(nameOf(*mesh.mBones[b]));
        if (node == nullptr || !isInvertible(mesh.mBones[b]->mOffsetMatrix)) continue;
        const int depth = _depth.at(node);
        if (result != nullptr && depth >= least) continue;
        result = mesh.mBones[b];
        least = depth;
    }
    return result;
}

glm::dmat4 SceneBind::bindFromAbove(const aiNode& node) const {
    glm::dmat4 result(1.0);
    const aiNode* above = &node;
    while (above != nullptr && _bind.count(above) == 0) {
        result = toGlm(above->mTransformation) * result;
        above = _parent.at(above);
    }
    return above == nullptr ? result : _bind.at(above) * result;
}

void SceneBind::bindSkin(const aiMesh& mesh, glm::dmat4& toScene) {
    const aiBone* reference = topmost(mesh);
    for (unsigned b = 0; b < mesh.mNumBones; ++b)
        if (_bind.count(find(nameOf(*mesh.mBones[b]))) != 0 &&
            isInvertible(mesh.mBones[b]->mOffsetMatrix)) {
            reference = mesh.mBones[b];
            break;
        }
    const aiNode* standing = find(nameOf(*reference));
    toScene = bindFromAbove(*standing) * toGlm(reference->mOffsetMatrix);
    for (unsigned b = 0; b < mesh.mNumBones; ++b) {
        const aiNode* node = find(nameOf(*mesh.mBones[b]));
        if (node == nullptr || !isInvertible(mesh.mBones[b]->mOffsetMatrix)) continue;
        _isBone[node] = true;
        _bind.emplace(node, toScene * glm::inverse(toGlm(mesh.mBones[b]->mOffsetMatrix)));
    }
}

std::string nameOf(const aiNode& node) {
    return {node.mName.C_Str(), node.mName.length};
}

std::string nameOf(const aiBone& bone) {
    return {bone.mName.C_Str(), bone.mName.length};
}

} // namespace osgSkin
