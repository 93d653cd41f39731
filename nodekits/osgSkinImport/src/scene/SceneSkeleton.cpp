// SPDX-License-Identifier: MIT
#include "scene/SceneSkeleton.h"

#include "files/FileText.h"
#include "scene/SceneBind.h"

#include <osgSkin/Error>
#include <osgSkinRig/JointRoles>

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <unordered_set>
#include <utility>

namespace osgSkin {
namespace {

std::set<std::string> animatedNames(const SourceScene& scene) {
    std::set<std::string> names;
    for (const auto& animation : scene.animations)
        for (const SourceTrack& track : animation->tracks) names.insert(track.node);
    return names;
}

bool isBelow(const SourceNode* node, const std::set<const SourceNode*>& nodes,
             const SceneBind& bind) {
    while (node != nullptr && nodes.count(node) == 0) node = bind.parent(*node);
    return node != nullptr;
}

/// Whether a leaf node, by its name, marks the end of its parent's bone.
bool isEndNode(const SourceNode& node) {
    const std::string& name = node.name;
    const bool suffixed = name.size() > 4 && name.compare(name.size() - 4, 4, "_end") == 0;
    return node.children.empty() && (name.rfind("EndSite", 0) == 0 || suffixed);
}

/// The joints of a skeleton that was exported alone, without a mesh, a skin or a clip: all nodes,
/// without those above the hips if these are recognised.
std::set<const SourceNode*> nodesOfSkeleton(const SceneBind& bind) {
    std::map<const SourceNode*, int> indices;
    RestSkeleton rest;
    for (const SourceNode* node : bind.nodes()) {
        if (!node->meshes.empty()) return {};
        const SourceNode* const above = bind.parent(*node);
        indices[node] = rest.add(node->name, above == nullptr ? -1 : indices.at(above),
                                 glm::dvec3(bind.posed(*node)[3]));
        rest.joints.back().role = node->role;
    }
    constexpr std::size_t kMaxNodes = 10000; // more are no skeleton
    if (rest.joints.size() < 2 || rest.joints.size() > kMaxNodes) return {};
    const JointRoles roles = recogniseJoints(rest);
    int top = std::max(roles.joint("Hips"), 0);
    for (const auto& [role, joints] : roles.joints)
        for (const int joint : joints)
            if (!rest.isInSubtree(joint, top)) top = 0;
    std::set<const SourceNode*> result;
    for (const auto& [node, joint] : indices)
        if (rest.isInSubtree(joint, top)) result.insert(node);
    return result;
}

class Builder {
public:
    explicit Builder(const SourceScene& scene) : _bind(scene), _joints(jointNodes(scene, _bind)) {
        for (const SourceNode* node : _bind.nodes())
            if (isJoint(*node))
                while (node != nullptr && _needed.insert(node).second) node = _bind.parent(*node);
    }

    SceneSkeleton build() {
        if (_needed.empty()) return {};
        const SourceNode* root = rootJoint();
        if (const SourceNode* above = _bind.parent(*root)) _result.aboveRoot = _bind.node(*above);
        std::vector<std::pair<const SourceNode*, int>> open{{root, -1}};
        while (!open.empty()) {
            const auto [node, parent] = open.back();
            open.pop_back();
            const int index = add(*node, parent);
            for (auto c = node->children.rbegin(); c != node->children.rend(); ++c)
                if (_needed.count(&_bind.child(*c)) != 0)
                    open.emplace_back(&_bind.child(*c), index);
        }
        return std::move(_result);
    }

private:
    bool isJoint(const SourceNode& node) const { return _joints.count(&node) != 0; }

    /// The lowest node whose subtree contains all joints.
    const SourceNode* rootJoint() const {
        const SourceNode* node = _bind.nodes().front();
        while (!isJoint(*node)) {
            const SourceNode* below = nullptr;
            for (const int c : node->children) {
                if (_needed.count(&_bind.child(c)) == 0) continue;
                if (below != nullptr) return node;
                below = &_bind.child(c);
            }
            node = below;
        }
        return node;
    }

    int add(const SourceNode& node, int parent) {
        const glm::dmat4& world = _bind.node(node);
        RestJoint joint{node.name, parent, glm::dvec3(world[3]), {}, rotationOf(world), node.role};
        bool isLeaf = true;
        for (const int c : node.children) isLeaf = isLeaf && _needed.count(&_bind.child(c)) == 0;
        for (const int c : node.children)
            if (isLeaf && !joint.tip && isEndNode(_bind.child(c)))
                joint.tip = glm::dvec3(_bind.node(_bind.child(c))[3]);
        _result.rest.joints.push_back(joint);
        _result.nodes.push_back(&node);
        _result.bind.push_back(world);
        _result.worldRotations.push_back(rotationOf(world));
        return static_cast<int>(_result.nodes.size()) - 1;
    }

    SceneBind _bind;
    std::set<const SourceNode*> _joints;
    std::unordered_set<const SourceNode*> _needed; ///< joints and their ancestors
    SceneSkeleton _result;
};

} // namespace

std::set<const SourceNode*> jointNodes(const SourceScene& scene, const SceneBind& bind) {
    std::set<const SourceNode*> bones, moving, lineage;
    for (const std::string& name : boneNames(scene))
        if (const SourceNode* node = bind.find(name)) bones.insert(node);
    for (const std::string& name : animatedNames(scene))
        if (const SourceNode* node = bind.find(name)) moving.insert(node);
    if (bones.empty()) {
        for (const SourceNode* node : bind.nodes()) // a VRM animation may move an arm alone
            if (!node->role.empty()) moving.insert(node);
        std::set<const SourceNode*> all = nodesOfSkeleton(bind);
        if (moving.empty()) return all;
        // All bones of an armature count, whichever its clips move.
        std::set<const SourceNode*> tops;
        for (const SourceNode* node : moving) {
            for (const SourceNode* above = bind.parent(*node);
                 above != nullptr && (bind.parent(*above) != nullptr || !scene.isRootMade);
                 above = bind.parent(*node))
                node = above;
            tops.insert(node);
        }
        bool isWhole = true; // but for its top, which may be the armature itself
        for (const SourceNode* node : all) {
            if (!isBelow(node, tops, bind) || isEndNode(*node)) continue;
            bones.insert(node);
            isWhole = isWhole && (moving.count(node) != 0 || tops.count(node) != 0);
        }
        if (!isWhole) moving.merge(bones);
        return moving;
    }
    for (const Constraint& constraint : scene.constraints)
        for (const std::string& name : {constraint.joint.name, constraint.source.name})
            if (const SourceNode* node = bind.find(name)) moving.insert(node);
    for (const SourceNode* node : bones)
        for (; node != nullptr && lineage.insert(node).second;) node = bind.parent(*node);
    for (const SourceNode* node : moving)
        if (lineage.count(node) != 0 || isBelow(node, bones, bind)) bones.insert(node);
    return bones;
}

SceneSkeleton findSceneSkeleton(const SourceScene& scene) {
    return Builder(scene).build();
}

SceneSkeleton readSceneSkeleton(const SourceScene& scene, const std::string& path,
                                const ReadLimits& limits) {
    SceneSkeleton result = findSceneSkeleton(scene);
    if (result.nodes.empty())
        failFile(path, "no skeleton, expected joints that an animation or a skin names");
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
