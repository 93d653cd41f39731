// SPDX-License-Identifier: MIT
#include "assimp/SceneBind.h"

#include "assimp/AssimpScene.h"
#include "assimp/TrustedBones.h"

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace osgSkin {

namespace {

constexpr double kOneScale = 0.01;               ///< relative
constexpr double kOnePlace = 0.01;               ///< of the bones' extent
constexpr double kMinPosed = glm::radians(1.0);  ///< that a pose turns a bone by
constexpr double kMaxPosed = glm::radians(45.0); ///< more is another axis up, if nothing else tells
constexpr double kStraight = 1e-3;
constexpr double kFarthestPosed = 0.5; ///< of the extent, that a pose moves a bone

double scaleOf(const glm::dmat4& m) {
    return std::cbrt(std::abs(glm::determinant(glm::dmat3(m))));
}

double angleOf(const glm::dmat3& turn) {
    return std::acos(std::clamp((turn[0][0] + turn[1][1] + turn[2][2] - 1.0) / 2.0, -1.0, 1.0));
}

/// Whether a space's axes are the scene's, or swapped: somebody chose them.
bool isAlongAxes(const glm::dmat4& m) {
    for (int column = 0; column < 3; ++column)
        for (int row = 0; row < 3; ++row) {
            const double part = std::abs(m[column][row]) / scaleOf(m);
            if (!(part < kStraight || std::abs(part - 1.0) < kStraight)) return false;
        }
    return true;
}

/// Whether bones stand in the bind pose where the mesh does, and the topmost node is posed: as
/// exporters that store a clip's first frame leave it. What else tells the spaces apart is no pose:
/// another unit or axis up, a figure that stands turned, a mesh's node that means nothing.
///
/// \param above from what the topmost bone's node stands in to the scene
/// \param byBone from the mesh to the scene, if the topmost bone's node is not posed
/// \param byMesh the same, if the mesh's node is where the mesh was bound
bool isPosed(const std::vector<const aiBone*>& bones, const aiBone& topmost,
             const glm::dmat4& above, const glm::dmat4& byBone, const glm::dmat4& byMesh) {
    if (!isAlongAxes(above) || !isAlongAxes(byMesh)) return false;
    const double scale = scaleOf(byMesh);
    if (!(scale > 0.0) || !(std::abs(scaleOf(byBone) / scale - 1.0) < kOneScale)) return false;
    const glm::dmat4 bound = glm::inverse(toGlm(topmost.mOffsetMatrix));
    double extent = 0.0;
    for (const aiBone* bone : bones) {
        const glm::dmat4 other = glm::inverse(toGlm(bone->mOffsetMatrix));
        extent =
            std::max(extent, scale * glm::distance(glm::dvec3(bound[3]), glm::dvec3(other[3])));
    }
    const glm::dvec3 place(byMesh * bound[3]);
    const double moved = glm::distance(place, glm::dvec3(byBone * bound[3]));
    const glm::dmat3 turn =
        glm::dmat3(byBone) / scaleOf(byBone) * glm::inverse(glm::dmat3(byMesh) / scale);
    const double turned = angleOf(turn);
    if (!(turned > kMinPosed)) return false; // not a number, too
    if (turned < kMaxPosed) return moved < kFarthestPosed * extent;
    // Turned about the mesh's origin, as a whole, it would stand elsewhere.
    const glm::dvec3 arm = place - glm::dvec3(byMesh[3]);
    return moved < kOnePlace * extent && glm::distance(turn * arm, arm) > 10.0 * kOnePlace * extent;
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
    std::vector<std::vector<const aiBone*>> bones;
    std::vector<std::pair<int, unsigned>> skins;
    for (unsigned m = 0; m < scene.mNumMeshes; ++m) {
        const aiMesh& mesh = *scene.mMeshes[m];
        for (unsigned b = 0; b < mesh.mNumBones; ++b)
            if (const aiNode* node = find(nameOf(*mesh.mBones[b]))) _isBone[node] = true;
        bones.push_back(reliableInverseBinds(mesh, *this));
        if (const aiBone* top = topmost(bones.back()))
            skins.emplace_back(_depth.at(find(nameOf(*top))), m);
    }
    std::sort(skins.begin(), skins.end());
    std::vector<glm::dmat4> shown(scene.mNumMeshes, glm::dmat4(0.0)); // by its first node
    for (auto node = _nodes.rbegin(); node != _nodes.rend(); ++node)
        for (unsigned i = 0; i < (*node)->mNumMeshes; ++i)
            shown[(*node)->mMeshes[i]] = _posed.at(*node);
    for (const auto& [depth, m] : skins) bindSkin(bones[m], shown[m], _skins[m]);

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

void SceneBind::bindSkin(const std::vector<const aiBone*>& bones, const glm::dmat4& meshToScene,
                         glm::dmat4& toScene) {
    const aiBone* reference = topmost(bones);
    for (const aiBone* bone : bones)
        if (_bind.count(find(nameOf(*bone))) != 0) {
            reference = bone;
            break;
        }
    const aiNode* standing = find(nameOf(*reference));
    toScene = bindFromAbove(*standing) * toGlm(reference->mOffsetMatrix);
    const aiNode* above = parent(*standing);
    if (_bind.count(standing) == 0 &&
        isPosed(bones, *reference, above != nullptr ? posed(*above) : glm::dmat4(1.0), toScene,
                meshToScene))
        toScene = meshToScene;
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
