// SPDX-License-Identifier: MIT
#include "assimp/mesh/PerVertexBindPose.h"

#include "assimp/AssimpScene.h"

#include <osgSkin/GlmOsg>

#include <assimp/scene.h>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <osg/BoundingBox>

#include <cmath>

namespace osgSkin {
namespace {

constexpr double kOff = 1e-3; ///< of the mesh's size: what files round their numbers by

glm::dvec3 placed(const glm::dmat4& matrix, const aiVector3D& vertex) {
    return glm::dvec3(matrix * glm::dvec4(toGlm(vertex), 1.0));
}

/// The length of the diagonal of a mesh's box in the scene.
double sizeOf(const aiMesh& mesh, const glm::dmat4& toScene) {
    osg::BoundingBoxd box;
    for (unsigned v = 0; v < mesh.mNumVertices; ++v)
        box.expandBy(toOsg(placed(toScene, mesh.mVertices[v])));
    return box.valid() ? 2.0 * box.radius() : 0.0;
}

bool counts(const aiMesh& mesh, const aiVertexWeight& entry) {
    return entry.mVertexId < mesh.mNumVertices && std::isfinite(entry.mWeight) &&
           entry.mWeight > 0.0f;
}

/// Where a bone takes the mesh: nowhere else where its matrix is none that could be.
glm::dmat4 placeBy(const aiBone& bone, const glm::dmat4& toScene, const SceneBind& bind) {
    const glm::dmat4 offset = toGlm(bone.mOffsetMatrix);
    const double volume = glm::determinant(glm::dmat3(offset));
    const aiNode* const node = bind.find(nameOf(bone));
    if (node == nullptr || !std::isfinite(volume) || volume == 0.0) return toScene;
    return bind.node(*node) * offset;
}

/// Calls `use` with each weight that counts, and where its bone takes the mesh.
template <typename Use>
void forEachWeight(const aiMesh& mesh, const glm::dmat4& toScene, const SceneBind& bind,
                   const Use& use) {
    for (unsigned b = 0; b < mesh.mNumBones; ++b) {
        const aiBone& bone = *mesh.mBones[b];
        const glm::dmat4 own = placeBy(bone, toScene, bind);
        for (unsigned w = 0; w < bone.mNumWeights; ++w)
            if (counts(mesh, bone.mWeights[w])) use(bone.mWeights[w], own);
    }
}

} // namespace

std::vector<glm::dmat4> perVertexBindPose(const aiMesh& mesh, const glm::dmat4& toScene,
                                          const SceneBind& bind) {
    const double most = kOff * sizeOf(mesh, toScene);
    bool isApart = false;
    forEachWeight(mesh, toScene, bind, [&](const aiVertexWeight& entry, const glm::dmat4& own) {
        const aiVector3D& vertex = mesh.mVertices[entry.mVertexId];
        isApart = isApart || glm::distance(placed(own, vertex), placed(toScene, vertex)) > most;
    });
    if (!isApart) return {};
    std::vector<glm::dmat4> result(mesh.mNumVertices, glm::dmat4(0.0));
    std::vector<double> sums(mesh.mNumVertices, 0.0);
    forEachWeight(mesh, toScene, bind, [&](const aiVertexWeight& entry, const glm::dmat4& own) {
        result[entry.mVertexId] += double(entry.mWeight) * own;
        sums[entry.mVertexId] += double(entry.mWeight);
    });
    for (unsigned v = 0; v < mesh.mNumVertices; ++v)
        result[v] = sums[v] > 0.0 ? result[v] / sums[v] : toScene;
    return result;
}

} // namespace osgSkin
