// SPDX-License-Identifier: MIT
// Meshes without a skin that are not parented to a joint.
#include "scene/SourceScene.h"

#include "files/FileText.h"
#include "scene/SceneBind.h"
#include "scene/SceneSkeleton.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/mat4x4.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace osgSkin {
namespace {

struct Box {
    glm::dvec3 low{0.0}, high{0.0};
    bool valid = false;

    void add(const glm::dvec3& p) {
        low = valid ? glm::min(low, p) : p;
        high = valid ? glm::max(high, p) : p;
        valid = true;
    }
    double size() const {
        const glm::dvec3 extent = high - low;
        return std::max({extent.x, extent.y, extent.z});
    }
};

/// Compares unskinned meshes with the bounds of all skins.
class Surroundings {
public:
    Surroundings(const SourceScene& scene, const SceneBind& bind) : _scene(scene), _bind(bind) {
        for (const SourceNode* node : bind.nodes())
            for (const std::size_t mesh : node->meshes) {
                if (scene.meshes[mesh]->bones.empty()) continue;
                const Box box = boxOf(*node, mesh);
                if (!box.valid) continue;
                _skins.add(box.low);
                _skins.add(box.high);
            }
    }

    /// Whether a mesh is scenery (a sky, a wall): it does not overlap the bounds of the skins, or
    /// is more than half as large again as these.
    bool isScenery(const SourceNode& node, std::size_t mesh) const {
        constexpr double kLarger = 1.5; // relative to all skins together
        const Box box = boxOf(node, mesh);
        if (!_skins.valid || !box.valid) return false;
        if (box.size() > kLarger * _skins.size()) return true;
        for (int axis = 0; axis < 3; ++axis)
            if (box.low[axis] > _skins.high[axis] || box.high[axis] < _skins.low[axis]) return true;
        return false;
    }

    /// Whether a mesh is inside the bounds of the skins, as eyes and hair are; floors are not.
    bool isPart(const SourceNode& node, std::size_t mesh) const {
        constexpr double kBeyond = 0.1; // relative to all skins together
        const Box box = boxOf(node, mesh);
        if (!_skins.valid || !box.valid) return true;
        const double room = kBeyond * _skins.size();
        for (int axis = 0; axis < 3; ++axis) {
            const double middle = 0.5 * (box.low[axis] + box.high[axis]);
            if (middle < _skins.low[axis] || middle > _skins.high[axis] ||
                box.low[axis] < _skins.low[axis] - room ||
                box.high[axis] > _skins.high[axis] + room)
                return false;
        }
        return true;
    }

private:
    Box boxOf(const SourceNode& node, std::size_t mesh) const {
        const glm::dmat4 toScene = _bind.mesh(node, mesh);
        Box box;
        for (const glm::vec3& vertex : _scene.meshes[mesh]->positions)
            box.add(glm::dvec3(toScene * glm::dvec4(vertex, 1.0)));
        return box;
    }

    const SourceScene& _scene;
    const SceneBind& _bind;
    Box _skins;
};

bool isOther(const glm::vec3& a, const glm::vec3& b) {
    return glm::length(a - b) > 1e-3f * std::max(glm::length(a), glm::length(b));
}

/// A quaternion and its negative are the same rotation.
bool isOther(const glm::quat& a, const glm::quat& b) {
    const glm::quat p = glm::normalize(a), q = glm::normalize(b);
    const float sign = glm::dot(p, q) < 0.0f ? -1.0f : 1.0f;
    return std::max({std::abs(p.w - sign * q.w), std::abs(p.x - sign * q.x),
                     std::abs(p.y - sign * q.y), std::abs(p.z - sign * q.z)}) > 1e-3f;
}

template <typename Value>
bool anyOther(const std::vector<SourceKey<Value>>& keys, const Value& rest) {
    return std::any_of(keys.begin(), keys.end(),
                       [&rest](const SourceKey<Value>& key) { return isOther(key.value, rest); });
}

/// Whether a track moves a node from its own transform. Exporters also write constant tracks.
bool moves(const SourceTrack& track, const SourceNode& node) {
    NodeTransform rest = decompose(node.matrix);
    if (rest.scale.x < 0.0) { // mirrored: flip all axes, which changes the rotation
        glm::dmat4 unmirrored = -node.matrix;
        rest.rotation = rotationOf(unmirrored);
        rest.scale = {rest.scale.x, -rest.scale.y, -rest.scale.z};
    }
    return anyOther(track.positions, glm::vec3(rest.translation)) ||
           anyOther(track.rotations, glm::quat(rest.rotation)) ||
           anyOther(track.scales, glm::vec3(rest.scale));
}

/// The nodes that some clip moves from their own transform.
std::set<const SourceNode*> movedNodes(const SourceScene& scene, const SceneBind& bind) {
    std::set<const SourceNode*> result;
    for (const auto& animation : scene.animations)
        for (const SourceTrack& track : animation->tracks) {
            const SourceNode* const node = bind.find(track.node);
            if (node != nullptr && result.count(node) == 0 && moves(track, *node))
                result.insert(node);
        }
    return result;
}

/// The nearest node of a set at or above a node; null if there is none.
const SourceNode* nearestOf(const std::set<const SourceNode*>& nodes, const SourceNode* node,
                            const SceneBind& bind) {
    while (node != nullptr && nodes.count(node) == 0) node = bind.parent(*node);
    return node;
}

/// Makes a mesh of a node follow one joint at or above it.
void followJoint(const SourceNode& joint, std::size_t node, std::size_t& mesh, SourceScene& scene) {
    glm::dmat4 toJoint(1.0);
    for (const SourceNode* at = &scene.nodes[node]; at != &joint;
         at = &scene.nodes[static_cast<std::size_t>(at->parent)])
        toJoint = at->matrix * toJoint;
    scene.meshes.push_back(boundTo(joint.name, toJoint, *scene.meshes[mesh]));
    mesh = scene.meshes.size() - 1;
}

void warnOfSome(const std::string& path, const std::set<std::string>& names,
                const std::string& what) {
    if (names.empty()) return;
    const std::string more =
        names.size() > 1 ? " and " + std::to_string(names.size() - 1) + " more" : "";
    warn(path, what + ": " + inQuotes(*names.begin()) + more);
}

} // namespace

std::shared_ptr<const SourceMesh> boundTo(const std::string& joint, const glm::dmat4& toJoint,
                                          const SourceMesh& mesh) {
    SourceBone bone{joint, toJoint, {}};
    for (std::size_t v = 0; v < mesh.positions.size(); ++v)
        bone.weights.push_back({static_cast<std::uint32_t>(v), 1.0f});
    auto result = std::make_shared<SourceMesh>(mesh);
    result->bones.push_back(std::move(bone));
    return result;
}

void bindFreeMeshes(SourceScene& scene, const std::string& path) {
    const SceneBind bind(scene);
    if (std::none_of(bind.nodes().begin(), bind.nodes().end(),
                     [&](const SourceNode* node) { return bind.isBone(*node); }))
        return;
    const std::set<const SourceNode*> joints = jointNodes(scene, bind);
    const std::set<const SourceNode*> moved = movedNodes(scene, bind);
    const bool plays = std::any_of(joints.begin(), joints.end(), [&](const SourceNode* joint) {
        return moved.count(joint) != 0;
    });
    const Surroundings surroundings(scene, bind);
    std::set<std::string> leftOut, apart;
    for (std::size_t n = 0; n < scene.nodes.size(); ++n) {
        SourceNode& node = scene.nodes[n];
        std::vector<std::size_t> kept;
        for (std::size_t mesh : node.meshes) {
            const bool isFree =
                scene.meshes[mesh]->bones.empty() && nearestOf(joints, &node, bind) == nullptr;
            if (isFree && (surroundings.isScenery(node, mesh) ||
                           (!plays && !surroundings.isPart(node, mesh)))) {
                leftOut.insert(node.name);
                continue;
            }
            if (isFree && plays) {
                const SourceNode* const mover = nearestOf(moved, &node, bind);
                followJoint(mover != nullptr ? *mover : scene.nodes.front(), n, mesh, scene);
                apart.insert(node.name);
            }
            kept.push_back(mesh);
        }
        node.meshes = std::move(kept);
    }
    warnOfSome(path, leftOut, "objects beside the figure are left out");
    warnOfSome(
        path, apart,
        "objects that are neither skinned nor parented to a joint move as their own nodes do "
        "in the file's clips");
}

bool bindFace(SourceScene& scene) {
    if (std::none_of(scene.meshes.begin(), scene.meshes.end(),
                     [](const auto& mesh) { return !mesh->morphs.empty(); }))
        return false;
    const SceneBind bind(scene);
    const std::set<const SourceNode*> moved = movedNodes(scene, bind);
    for (std::size_t n = 0; n < scene.nodes.size(); ++n)
        for (std::size_t& mesh : scene.nodes[n].meshes) {
            const SourceNode* const mover = nearestOf(moved, &scene.nodes[n], bind);
            followJoint(mover != nullptr ? *mover : scene.nodes.front(), n, mesh, scene);
        }
    return true;
}

} // namespace osgSkin
