// SPDX-License-Identifier: MIT
#include "assimp/SceneBind.h"

#include "assimp/AssimpScene.h"
#include "assimp/TrustedBones.h"

#include <glm/matrix.hpp>

#include <algorithm>
#include <utility>

namespace osgSkin {

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
    std::vector<std::vector<const aiBone*>> bones;
    std::vector<std::pair<int, unsigned>> skins;
    for (unsigned m = 0; m < scene.mNumMeshes; ++m) {
        const aiMesh& mesh = *scene.mMeshes[m];
        for (unsigned b = 0; b < mesh.mNumBones; ++b)
            if (const aiNode* node = find(nameOf(*mesh.mBones[b]))) _isBone[node] = true;
        bones.push_back(trustedBones(mesh, *this));
        if (const aiBone* top = topmost(bones.back()))
            skins.emplace_back(_depth.at(find(nameOf(*top))), m);
    }
    std::sort(skins.begin(), skins.end());
    for (const auto& [depth, m] : skins) bindSkin(bones[m], _skins[m]);

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

const aiBone* SceneBind::topmost(const std::vector<const aiBone*>& bones) const {
    const aiBone* result = nullptr;
    int least = 0;
    for (const aiBone* bone : bones) {
        const int depth = _depth.at(find(nameOf(*bone)));
        if (result != nullptr && depth >= least) continue;
        result = bone;
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

void SceneBind::bindSkin(const std::vector<const aiBone*>& bones, glm::dmat4& toScene) {
    const aiBone* reference = topmost(bones);
    for (const aiBone* bone : bones)
        if (_bind.count(find(nameOf(*bone))) != 0) {
            reference = bone;
            break;
        }
    const aiNode* standing = find(nameOf(*reference));
    toScene = bindFromAbove(*standing) * toGlm(reference->mOffsetMatrix);
    for (const aiBone* bone : bones)
        _bind.emplace(find(nameOf(*bone)), toScene * glm::inverse(toGlm(bone->mOffsetMatrix)));
}

std::string nameOf(const aiNode& node) {
    return {node.mName.C_Str(), node.mName.length};
}

std::string nameOf(const aiBone& bone) {
    return {bone.mName.C_Str(), bone.mName.length};
}

} // namespace osgSkin
