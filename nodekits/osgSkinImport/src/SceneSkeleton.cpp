// SPDX-License-Identifier: MIT
#include "SceneSkeleton.h"

#include "AssimpScene.h"
#include "FileText.h"

#include <osgSkin/Error>

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>

#include <set>
#include <unordered_set>
#include <utility>

namespace osgSkin {
namespace {

std::string nameOf(const aiNode& node) {
    return {node.mName.C_Str(), node.mName.length};
}

std::set<std::string> jointNames(const aiScene& scene) {
    std::set<std::string> names;
    if (scene.mNumAnimations > 0) {
        const aiAnimation& animation = *scene.mAnimations[0];
        for (unsigned c = 0; c < animation.mNumChannels; ++c)
            names.insert(animation.mChannels[c]->mNodeName.C_Str());
    }
    for (unsigned m = 0; m < scene.mNumMeshes; ++m)
        for (unsigned b = 0; b < scene.mMeshes[m]->mNumBones; ++b)
            names.insert(scene.mMeshes[m]->mBones[b]->mName.C_Str());
    return names;
}

/// All nodes, parents before children, children in file order.
std::vector<const aiNode*> preorder(const aiNode& root) {
    std::vector<const aiNode*> result;
    std::vector<const aiNode*> open{&root};
    while (!open.empty()) {
        const aiNode* node = open.back();
        open.pop_back();
        result.push_back(node);
        for (unsigned c = node->mNumChildren; c > 0; --c) open.push_back(node->mChildren[c - 1]);
    }
    return result;
}

/// Whether a node that nothing moves marks the end of its parent's bone.
bool isEndNode(const aiNode& node) {
    const std::string name = nameOf(node);
    const bool suffixed = name.size() > 4 && name.compare(name.size() - 4, 4, "_end") == 0;
    return node.mNumChildren == 0 && (name.rfind("EndSite", 0) == 0 || suffixed);
}

class Builder {
public:
    explicit Builder(const aiScene& scene)
        : _nodes(preorder(*scene.mRootNode)), _names(jointNames(scene)) {
        for (const aiNode* node : _nodes)
            if (isJoint(*node))
                while (node != nullptr && _needed.insert(node).second) node = node->mParent;
    }

    bool empty() const { return _needed.empty(); }

    SceneSkeleton build() {
        const aiNode* root = rootJoint();
        for (const aiNode* up = root->mParent; up != nullptr; up = up->mParent)
            _result.aboveRoot = toGlm(up->mTransformation) * _result.aboveRoot;
        std::vector<std::pair<const aiNode*, int>> open{{root, -1}};
        while (!open.empty()) {
            const auto [node, parent] = open.back();
            open.pop_back();
            const int index = add(*node, parent);
            for (unsigned c = node->mNumChildren; c > 0; --c)
                if (_needed.count(node->mChildren[c - 1]) != 0)
                    open.emplace_back(node->mChildren[c - 1], index);
        }
        return std::move(_result);
    }

private:
    bool isJoint(const aiNode& node) const { return _names.count(nameOf(node)) != 0; }

    /// The lowest node that has all joints in its subtree.
    const aiNode* rootJoint() const {
        const aiNode* node = _nodes.front();
        while (!isJoint(*node)) {
            const aiNode* below = nullptr;
            for (unsigned c = 0; c < node->mNumChildren; ++c) {
                if (_needed.count(node->mChildren[c]) == 0) continue;
                if (below != nullptr) return node;
                below = node->mChildren[c];
            }
            node = below;
        }
        return node;
    }

    int add(const aiNode& node, int parent) {
        const glm::dmat4& above =
            parent < 0 ? _result.aboveRoot : _world[static_cast<std::size_t>(parent)];
        const glm::dmat4 world = above * toGlm(node.mTransformation);
        RestJoint joint{nameOf(node), parent, glm::dvec3(world[3]), {}};
        bool isLeaf = true;
        for (unsigned c = 0; c < node.mNumChildren; ++c)
            isLeaf = isLeaf && _needed.count(node.mChildren[c]) == 0;
        for (unsigned c = 0; isLeaf && !joint.tip && c < node.mNumChildren; ++c)
            if (isEndNode(*node.mChildren[c]))
                joint.tip = glm::dvec3((world * toGlm(node.mChildren[c]->mTransformation))[3]);
        _result.rest.joints.push_back(joint);
        _result.nodes.push_back(&node);
        _result.worldRotations.push_back(rotationOf(world));
        _world.push_back(world);
        return static_cast<int>(_world.size()) - 1;
    }

    std::vector<const aiNode*> _nodes;
    std::set<std::string> _names;
    std::unordered_set<const aiNode*> _needed; ///< joints and the nodes above them
    SceneSkeleton _result;
    std::vector<glm::dmat4> _world;
};

} // namespace

glm::dquat rotationOf(const glm::dmat4& matrix) {
    glm::dmat3 axes(matrix);
    const double volume = glm::determinant(axes);
    if (!(volume > 0.0)) return {1.0, 0.0, 0.0, 0.0}; // mirrored or flat: no turn describes it
    axes[0] = glm::normalize(axes[0]);
    axes[1] = glm::normalize(axes[1] - axes[0] * glm::dot(axes[0], axes[1]));
    axes[2] = glm::cross(axes[0], axes[1]);
    return glm::normalize(glm::quat_cast(axes));
}

SceneSkeleton skeletonOf(const aiScene& scene, const std::string& path) {
    Builder builder(scene);
    if (builder.empty())
        failFile(path, "no skeleton, expected joints that an animation or a skin names");
    SceneSkeleton result = builder.build();
    try {
        result.rest.validate();
    } catch (const Error& error) {
        failFile(path, error.what());
    }
    return result;
}

} // namespace osgSkin
