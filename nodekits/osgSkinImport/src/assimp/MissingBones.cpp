// SPDX-License-Identifier: MIT
#include "assimp/MissingBones.h"

#include "assimp/SceneBind.h"

#include <osg/Notify>

#include <cmath>
#include <vector>

namespace osgSkin {
namespace {

bool isInvertible(const aiMatrix4x4& matrix) {
    const float determinant = matrix.Determinant();
    return std::isfinite(determinant) && determinant != 0.0f;
}

/// How much two bones hold the same vertices: the sum of their weights' products.
double sharedWeight(const aiBone& a, const aiBone& b, std::vector<double>& scratch) {
    double sum = 0.0;
    for (unsigned w = 0; w < a.mNumWeights; ++w)
        if (a.mWeights[w].mVertexId < scratch.size())
            scratch[a.mWeights[w].mVertexId] = double(a.mWeights[w].mWeight);
    for (unsigned w = 0; w < b.mNumWeights; ++w)
        if (b.mWeights[w].mVertexId < scratch.size())
            sum += double(b.mWeights[w].mWeight) * scratch[b.mWeights[w].mVertexId];
    for (unsigned w = 0; w < a.mNumWeights; ++w)
        if (a.mWeights[w].mVertexId < scratch.size()) scratch[a.mWeights[w].mVertexId] = 0.0;
    return sum;
}

struct Link {
    const aiBone* missing = nullptr;
    const aiBone* parent = nullptr;
    double weight = 0.0;
};

/// Of the mesh's bones without a node, the one that shares most with a bone that has one.
Link strongestLink(const aiScene& scene, const aiMesh& mesh) {
    Link best;
    std::vector<double> scratch(mesh.mNumVertices, 0.0);
    for (unsigned m = 0; m < mesh.mNumBones; ++m) {
        const aiBone& missing = *mesh.mBones[m];
        if (scene.mRootNode->FindNode(missing.mName) != nullptr ||
            !isInvertible(missing.mOffsetMatrix))
            continue;
        for (unsigned p = 0; p < mesh.mNumBones; ++p) {
            const aiBone& parent = *mesh.mBones[p];
            if (scene.mRootNode->FindNode(parent.mName) == nullptr ||
                !isInvertible(parent.mOffsetMatrix))
                continue;
            const double weight = sharedWeight(missing, parent, scratch);
            if (weight > best.weight) best = {&missing, &parent, weight};
        }
    }
    return best;
}

void addNode(aiScene& scene, const Link& link) {
    auto* node = new aiNode; // the parent node takes it over
    node->mName = link.missing->mName;
    aiMatrix4x4 bind = link.missing->mOffsetMatrix;
    node->mTransformation = link.parent->mOffsetMatrix * bind.Inverse();
    scene.mRootNode->FindNode(link.parent->mName)->addChildren(1, &node);
}

} // namespace

void addMissingBones(aiScene& scene, const std::string& path) {
    for (unsigned m = 0; m < scene.mNumMeshes; ++m)
        for (Link link = strongestLink(scene, *scene.mMeshes[m]); link.missing != nullptr;
             link = strongestLink(scene, *scene.mMeshes[m])) {
            addNode(scene, link);
            OSG_NOTICE << path << ": bone \"" << nameOf(*link.missing)
                       << "\" has weights and no place in the skeleton; it follows \""
                       << nameOf(*link.parent) << "\"" << std::endl;
        }
}

} // namespace osgSkin
