// SPDX-License-Identifier: MIT
#include "assimp/NodeNames.h"

#include "assimp/SceneBind.h"
#include "text/UniqueName.h"

#include <osgDB/FileNameUtils>

#include <algorithm>
#include <map>
#include <vector>

namespace osgSkin {
namespace {

using NodesOfName = std::map<std::string, std::vector<aiNode*>>;

NodesOfName nodesByName(const aiScene& scene) {
    NodesOfName result;
    std::vector<aiNode*> open{scene.mRootNode};
    while (!open.empty()) {
        aiNode* node = open.back();
        open.pop_back();
        result[nameOf(*node)].push_back(node);
        for (unsigned c = node->mNumChildren; c > 0; --c) open.push_back(node->mChildren[c - 1]);
    }
    return result;
}

/// Where a bone's name is that of a mesh's node and the name with Assimp's counter that of a node
/// without a mesh, the bone was called so first.
void exchangeWithTwin(const std::string& bone, NodesOfName& nodes) {
    const auto found = nodes.find(bone), twin = nodes.find(bone + "001");
    if (found == nodes.end() || twin == nodes.end() || found->second.size() != 1 ||
        twin->second.size() != 1)
        return;
    aiNode &held = *found->second.front(), &free = *twin->second.front();
    if (held.mNumMeshes == 0 || free.mNumMeshes > 0) return;
    std::swap(held.mName, free.mName);
    std::swap(found->second, twin->second);
}

} // namespace

std::set<std::string> boneNames(const aiScene& scene) {
    std::set<std::string> result;
    for (unsigned m = 0; m < scene.mNumMeshes; ++m)
        for (unsigned b = 0; b < scene.mMeshes[m]->mNumBones; ++b)
            result.insert(nameOf(*scene.mMeshes[m]->mBones[b]));
    return result;
}

void separateNames(aiScene& scene, const std::string& path) {
    NodesOfName nodes = nodesByName(scene);
    if (osgDB::getLowerCaseFileExtension(path) == "fbx")
        for (const std::string& bone : boneNames(scene)) exchangeWithTwin(bone, nodes);
    UniqueNames taken;
    for (const auto& [name, same] : nodes) taken.take(name);
    for (auto& [name, same] : nodes) {
        const auto meant = std::find_if(same.begin(), same.end(),
                                        [](const aiNode* node) { return node->mNumMeshes == 0; });
        const aiNode* keeper = meant == same.end() ? same.front() : *meant;
        for (aiNode* node : same)
            if (node != keeper) node->mName = taken.unique(name);
    }
}

} // namespace osgSkin
