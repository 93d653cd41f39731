// SPDX-License-Identifier: MIT
#include "assimp/SceneSkeleton.h"

#include "assimp/AssimpScene.h"
#include "assimp/NodeNames.h"
#include "assimp/SceneBind.h"
#include "text/FileText.h"

#include <osgSkin/Error>

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>

#include <cmath>
#include <set>
#include <unordered_set>
#include <utility>

namespace osgSkin {
namespace {

std::set<std::string> animatedNames(const aiScene& scene) {
    std::set<std::string> names;
    for (unsigned a = 0; a < scene.mNumAnimations; ++a)
        for (unsigned c = 0; c < scene.mAnimations[a]->mNumChannels; ++c)
            names.insert(scene.mAnimations[a]->mChannels[c]->mNodeName.C_Str());
    return names;
}

bool isBelow(const aiNode* node, const std::set<const aiNode*>& nodes, const SceneBind& bind) {
    while (node != nullptr && nodes.count(node) == 0) node = bind.parent(*node);
    return node != nullptr;
}

/// Whether a node that nothing moves marks the end of its parent's bone.
bool isEndNode(const aiNode& node) {
    const std::string name = nameOf(node);
    const bool suffixed = name.size() > 4 && name.compare(name.size() - 4, 4, "_end") == 0;
    return node.mNumChildren == 0 && (name.rfind("EndSite", 0) == 0 || suffixed);
}

class Builder {
public:
    explicit Builder(const aiScene& scene) : _bind(scene), _joints(jointNodes(scene, _bind)) {
        for (const aiNode* node : _bind.nodes())
            if (isJoint(*node))
                while (node != nullptr && _needed.insert(node).second) node = _bind.parent(*node);
    }

    bool empty() const { return _needed.empty(); }

    SceneSkeleton build() {
        const aiNode* root = rootJoint();
        if (const aiNode* above = _bind.parent(*root)) _result.aboveRoot = _bind.node(*above);
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
    bool isJoint(const aiNode& node) const { return _joints.count(&node) != 0; }

    /// The lowest node that has all joints in its subtree.
    const aiNode* rootJoint() const {
        const aiNode* node = _bind.nodes().front();
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
        const glm::dmat4& world = _bind.node(node);
        RestJoint joint{nameOf(node), parent, glm::dvec3(world[3]), {}, rotationOf(world)};
        bool isLeaf = true;
        for (unsigned c = 0; c < node.mNumChildren; ++c)
            isLeaf = isLeaf && _needed.count(node.mChildren[c]) == 0;
        for (unsigned c = 0; isLeaf && !joint.tip && c < node.mNumChildren; ++c)
            if (isEndNode(*node.mChildren[c]))
                joint.tip = glm::dvec3(_bind.node(*node.mChildren[c])[3]);
        _result.rest.joints.push_back(joint);
        _result.nodes.push_back(&node);
        _result.bind.push_back(world);
        _result.worldRotations.push_back(rotationOf(world));
        return static_cast<int>(_result.nodes.size()) - 1;
    }

    SceneBind _bind;
    std::set<const aiNode*> _joints;
    std::unordered_set<const aiNode*> _needed; ///< joints and the nodes above them
    SceneSkeleton _result;
};

} // namespace

std::set<const aiNode*> jointNodes(const aiScene& scene, const SceneBind& bind) {
    std::set<const aiNode*> bones, moving, lineage;
    for (const std::string& name : boneNames(scene))
        if (const aiNode* node = bind.find(name)) bones.insert(node);
    for (const std::string& name : animatedNames(scene))
        if (const aiNode* node = bind.find(name)) moving.insert(node);
    if (bones.empty()) return moving;
    for (const aiNode* node : bones)
        for (; node != nullptr && lineage.insert(node).second;) node = bind.parent(*node);
    for (const aiNode* node : moving)
        if (lineage.count(node) != 0 || isBelow(node, bones, bind)) bones.insert(node);
    return bones;
}

glm::dquat rotationOf(const glm::dmat4& matrix) {
    glm::dmat3 axes(matrix);
    const double volume = glm::determinant(axes);
    if (!(std::abs(volume) > 0.0)) return {1.0, 0.0, 0.0, 0.0}; // flat: no rotation describes it
    axes[0] = glm::normalize(volume < 0.0 ? -axes[0] : axes[0]);
    axes[1] = glm::normalize(axes[1] - axes[0] * glm::dot(axes[0], axes[1]));
    axes[2] = glm::cross(axes[0], axes[1]);
    return glm::normalize(glm::quat_cast(axes));
}

SceneSkeleton readSceneSkeleton(const aiScene& scene, const std::string& path,
                                const ReadLimits& limits) {
    Builder builder(scene);
    if (builder.empty())
        failFile(path, "no skeleton, expected joints that an animation or a skin names");
    SceneSkeleton result = builder.build();
    if (result.rest.joints.size() > limits.joints)
        failFile(path, std::to_string(result.rest.joints.size()) + " joints, expected at most " +
                           std::to_string(limits.joints) + " (option maxJoints)");
    try {
        result.rest.validate();
    } catch (const Error& error) {
        failFile(path, error.what());
    }
    return result;
}

} // namespace osgSkin
