// SPDX-License-Identifier: MIT
#include "assimp/MissingBones.h"

#include "assimp/SceneBind.h"
#include "text/FileText.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace osgSkin {
namespace {

bool isInvertible(const aiMatrix4x4& matrix) {
    const float determinant = matrix.Determinant();
    return std::isfinite(determinant) && determinant != 0.0f;
}

using Nodes = std::map<std::string, aiNode*>;

/// A scene's nodes by their names; of those called alike, the first from the top.
Nodes nodesOf(const aiScene& scene) {
    Nodes nodes;
    std::vector<aiNode*> open{scene.mRootNode};
    while (!open.empty()) {
        aiNode* node = open.back();
        open.pop_back();
        nodes.emplace(nameOf(*node), node);
        open.insert(open.end(), node->mChildren, node->mChildren + node->mNumChildren);
    }
    return nodes;
}

/// A mesh's bones without a node, and how much each shares with bones that have one.
class MissingBones {
public:
    MissingBones(const Nodes& nodes, const aiMesh& mesh) : _weightsOf(mesh.mNumVertices) {
        for (unsigned b = 0; b < mesh.mNumBones; ++b) {
            const aiBone& bone = *mesh.mBones[b];
            if (!isInvertible(bone.mOffsetMatrix)) continue;
            const auto found = nodes.find(nameOf(bone));
            _bones.push_back({&bone, found == nodes.end() ? nullptr : found->second, nullptr, 0.0});
        }
        const auto hasNode = [](const Bone& bone) { return bone.node != nullptr; };
        // Most meshes miss none.
        if (std::all_of(_bones.begin(), _bones.end(), hasNode)) _bones.clear();
        for (std::size_t b = 0; b < _bones.size(); ++b)
            forEachWeight(b, [&](unsigned vertex, double weight) {
                _weightsOf[vertex].push_back({b, weight});
            });
        for (std::size_t b = 0; b < _bones.size(); ++b)
            if (hasNode(_bones[b])) offer(b);
    }

    /// The bone that shares most with one that has a node; null where there is none.
    const aiBone* next(aiNode*& parent, const aiBone*& above) {
        std::size_t best = _bones.size();
        for (std::size_t b = 0; b < _bones.size(); ++b)
            if (_bones[b].node == nullptr && _bones[b].shared > 0.0 &&
                (best == _bones.size() || _bones[b].shared > _bones[best].shared))
                best = b;
        if (best == _bones.size()) return nullptr;
        above = _bones[best].above->bone;
        parent = _bones[best].above->node;
        _next = best;
        return _bones[best].bone;
    }

    /// Tells of the node that next()'s bone has now.
    void found(aiNode* node) {
        _bones[_next].node = node;
        offer(_next);
    }

private:
    struct Bone {
        const aiBone* bone;
        aiNode* node;
        const Bone* above; ///< of those with a node, the one that shares most
        double shared;     ///< with it: the sum of their weights' products
    };

    template <typename Use>
    void forEachWeight(std::size_t b, const Use& use) const {
        const aiBone& bone = *_bones[b].bone;
        for (unsigned w = 0; w < bone.mNumWeights; ++w)
            if (bone.mWeights[w].mVertexId < _weightsOf.size())
                use(bone.mWeights[w].mVertexId, double(bone.mWeights[w].mWeight));
    }

    /// Offers a bone that has a node to those that have none.
    void offer(std::size_t parent) {
        std::vector<double> shared(_bones.size(), 0.0);
        forEachWeight(parent, [&](unsigned vertex, double weight) {
            for (const auto& [other, share] : _weightsOf[vertex]) shared[other] += weight * share;
        });
        for (std::size_t b = 0; b < _bones.size(); ++b)
            if (_bones[b].node == nullptr && shared[b] > _bones[b].shared) {
                _bones[b].above = &_bones[parent];
                _bones[b].shared = shared[b];
            }
    }

    std::vector<Bone> _bones;
    std::vector<std::vector<std::pair<std::size_t, double>>> _weightsOf; ///< [vertex]
    std::size_t _next = 0;
};

} // namespace

void addMissingBones(aiScene& scene, const std::string& path) {
    Nodes nodes = nodesOf(scene);
    for (unsigned m = 0; m < scene.mNumMeshes; ++m) {
        if (scene.mMeshes[m]->mNumBones == 0) continue;
        MissingBones missing(nodes, *scene.mMeshes[m]);
        aiNode* parent = nullptr;
        const aiBone* above = nullptr;
        while (const aiBone* bone = missing.next(parent, above)) {
            auto* node = new aiNode; // the parent node takes it over
            node->mName = bone->mName;
            aiMatrix4x4 bind = bone->mOffsetMatrix;
            node->mTransformation = above->mOffsetMatrix * bind.Inverse();
            parent->addChildren(1, &node);
            nodes.emplace(nameOf(*node), node);
            missing.found(node);
            tellOf(path, "bone \"" + nameOf(*bone) +
                             "\" has weights and no place in the skeleton; it follows \"" +
                             nameOf(*above) + '"');
        }
    }
}

} // namespace osgSkin
