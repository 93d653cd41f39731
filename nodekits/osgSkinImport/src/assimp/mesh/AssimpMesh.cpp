// SPDX-License-Identifier: MIT
#include "assimp/mesh/AssimpMesh.h"

#include "assimp/AssimpScene.h"
#include "assimp/SceneBind.h"
#include "assimp/SceneSkeleton.h"
#include "assimp/mesh/AnimatedAttachments.h"
#include "assimp/mesh/AssimpMaterials.h"
#include "assimp/mesh/PerVertexBindPose.h"
#include "assimp/mesh/Scenery.h"
#include "text/FileText.h"

#include <osgDB/FileNameUtils>

#include <assimp/scene.h>

#include <glm/matrix.hpp>

#include <cmath>
#include <set>
#include <string>
#include <vector>

namespace osgSkin {
namespace {

glm::dmat3 normalMatrixOf(const glm::dmat4& toScene) {
    return glm::transpose(glm::inverse(glm::dmat3(toScene)));
}

constexpr std::uint32_t kUnused = ~0u;

/// Where each vertex of a mesh comes to be if the first one is `first`; kUnused for those that no
/// face names. Meshes that share their vertices, as those of one body's materials do, each come
/// with all of them.
std::vector<std::uint32_t> placesOf(const aiMesh& source, std::size_t first,
                                    const std::string& where) {
    std::vector<std::uint32_t> result(source.mNumVertices, kUnused);
    for (unsigned f = 0; f < source.mNumFaces; ++f) {
        const aiFace& face = source.mFaces[f];
        if (face.mNumIndices < 3) continue; // points and lines
        for (unsigned k = 0; k < face.mNumIndices; ++k) {
            const unsigned v = face.mIndices[k];
            if (v >= source.mNumVertices)
                failFile(where, "face " + std::to_string(f) + " names vertex " + std::to_string(v) +
                                    ", expected less than " + std::to_string(source.mNumVertices));
            result[v] = 0;
        }
    }
    for (std::uint32_t& place : result) {
        if (place == kUnused) continue;
        if (first >= kUnused) failFile(where, "more vertices than 32-bit indices reach");
        place = static_cast<std::uint32_t>(first++);
    }
    return result;
}

/// Adds one mesh of the scene, in the scene's space: all of it by `toScene`, or where there are
/// some, each vertex by its own of `apart`.
void addMesh(const aiMesh& source, const glm::dmat4& toScene, const std::vector<glm::dmat4>& apart,
             const std::vector<std::uint32_t>& places, const AssimpMaterials& materials,
             CornerMesh& result) {
    for (unsigned v = 0; v < source.mNumVertices; ++v)
        if (places[v] != kUnused)
            result.mesh.positions.emplace_back((apart.empty() ? toScene : apart[v]) *
                                               glm::dvec4(toGlm(source.mVertices[v]), 1.0));

    const glm::dmat3 normalMatrix = normalMatrixOf(toScene);
    const bool mirrored = glm::determinant(glm::dmat3(toScene)) < 0.0;
    const unsigned set = materials.texCoordsOf(source);
    const bool hasTexCoords = source.HasTextureCoords(set);
    for (unsigned f = 0; f < source.mNumFaces; ++f) {
        const aiFace& face = source.mFaces[f];
        if (face.mNumIndices < 3) continue; // points and lines
        result.addFace(materials.indexOf(source));
        for (unsigned k = 0; k < face.mNumIndices; ++k) {
            // A mirrored face keeps its outside when its corners run the other way round.
            const unsigned v = face.mIndices[mirrored ? face.mNumIndices - 1 - k : k];
            glm::dvec3 normal(0.0);
            if (source.HasNormals())
                normal = (apart.empty() ? normalMatrix : normalMatrixOf(apart[v])) *
                         toGlm(source.mNormals[v]);
            glm::vec2 texCoord(0.0f);
            if (hasTexCoords)
                texCoord = {source.mTextureCoords[set][v].x, source.mTextureCoords[set][v].y};
            result.addCorner(places[v], glm::vec3(normal), texCoord);
            if (materials.hasColours()) result.colours.push_back(materials.colour(source, v));
        }
        result.hasTexCoords = result.hasTexCoords || hasTexCoords;
    }
}

/// Adds the weights of a mesh whose vertices are at `places`: its own, or where it has none, those
/// of a thing that hangs on the joint `above`.
void addWeights(const aiMesh& source, const aiNode* above, const std::vector<std::uint32_t>& places,
                const std::string& where, CornerMesh& result) {
    for (unsigned b = 0; b < source.mNumBones; ++b) {
        const aiBone& bone = *source.mBones[b];
        BoneWeights& weights = result.weightsOf(nameOf(bone));
        for (unsigned w = 0; w < bone.mNumWeights; ++w) {
            const aiVertexWeight& entry = bone.mWeights[w];
            if (entry.mVertexId >= source.mNumVertices || !std::isfinite(entry.mWeight) ||
                entry.mWeight < 0.0f)
                failFile(where, "bone " + inQuotes(nameOf(bone)) + ": weight " + std::to_string(w) +
                                    ", expected a vertex below " +
                                    std::to_string(source.mNumVertices) +
                                    " and a finite number of 0 or more");
            if (places[entry.mVertexId] != kUnused)
                weights.entries.push_back({places[entry.mVertexId], double(entry.mWeight)});
        }
    }
    if (source.mNumBones > 0 || above == nullptr) return;
    BoneWeights& weights = result.weightsOf(nameOf(*above));
    for (const std::uint32_t place : places)
        if (place != kUnused) weights.entries.push_back({place, 1.0});
}

/// The joints that meshes may hang on; none where nothing is skinned.
std::set<const aiNode*> jointsOfSkins(const aiScene& scene, const SceneBind& bind) {
    for (const aiNode* node : bind.nodes())
        if (bind.isBone(*node)) return jointNodes(scene, bind);
    return {};
}

void tellOfSome(const std::string& path, const std::set<std::string>& names,
                const std::string& what) {
    if (!names.empty())
        tellOf(path,
               std::to_string(names.size()) + what + ", \"" + *names.begin() + "\" among them");
}

} // namespace

CornerMesh readAssimpMesh(const std::string& path, const osgDB::Options* options) {
    Assimp::Importer importer;
    return readSceneMesh(readAssimpScene(importer, path, ReadLimits::of(options)), path, options);
}

CornerMesh readSceneMesh(const aiScene& scene, const std::string& path,
                         const osgDB::Options* options) {
    CornerMesh result;
    const AssimpMaterials materials(scene, path, options);
    result.stateSets = materials.stateSets();

    const SceneBind bind(scene);
    const std::set<const aiNode*> joints = jointsOfSkins(scene, bind);
    const Scenery scenery(scene, bind);
    const std::set<const aiNode*> moved = movedNodes(scene, bind);
    std::set<std::string> leftOut, unmoved;
    for (const aiNode* node : bind.nodes())
        for (unsigned m = 0; m < node->mNumMeshes; ++m) {
            const aiMesh& mesh = *scene.mMeshes[node->mMeshes[m]];
            const aiNode* above = node;
            while (above != nullptr && joints.count(above) == 0) above = bind.parent(*above);
            if (mesh.mNumBones == 0 && above == nullptr && scenery.has(*node, node->mMeshes[m])) {
                leftOut.insert(nameOf(*node));
                continue;
            }
            const aiNode* mover = mesh.mNumBones == 0 && above == nullptr ? node : nullptr;
            while (mover != nullptr && moved.count(mover) == 0) mover = bind.parent(*mover);
            if (mover != nullptr && !joints.empty()) unmoved.insert(nameOf(*node));
            const std::string where = path + ": mesh \"" + mesh.mName.C_Str() + "\"";
            const auto places = placesOf(mesh, result.mesh.positions.size(), where);
            const glm::dmat4 toScene = bind.mesh(*node, node->mMeshes[m]);
            addMesh(mesh, toScene, perVertexBindPose(mesh, toScene, bind), places, materials,
                    result);
            addWeights(mesh, above, places, where, result);
        }
    tellOfSome(path, leftOut, " things beside the figure are left out");
    tellOfSome(path, unmoved, " things that clips move beside the skeleton stand still");
    return result;
}

} // namespace osgSkin
