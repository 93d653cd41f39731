// SPDX-License-Identifier: MIT
// Repairs a scene in which bones and tracks refer to nodes by name.
#include "scene/SourceScene.h"

#include "files/FileText.h"
#include "files/UniqueName.h"

#include <osgDB/FileNameUtils>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace osgSkin {
namespace {

using NodesOfName = std::map<std::string, std::vector<int>>;

SourceNode& nodeAt(SourceScene& scene, int index) {
    return scene.nodes[static_cast<std::size_t>(index)];
}

/// A scene's nodes by name, each list in depth-first order.
NodesOfName nodesByName(const SourceScene& scene) {
    NodesOfName result;
    std::vector<int> open{0};
    while (!open.empty()) {
        const int index = open.back();
        const SourceNode& node = scene.nodes[static_cast<std::size_t>(index)];
        open.pop_back();
        result[node.name].push_back(index);
        open.insert(open.end(), node.children.rbegin(), node.children.rend());
    }
    return result;
}

/// Swaps names if a bone's name belongs to a mesh node, and the name with Assimp's counter to a
/// node without a mesh: the bone originally had that name.
void exchangeWithTwin(SourceScene& scene, const std::string& bone, NodesOfName& nodes) {
    const auto found = nodes.find(bone), twin = nodes.find(bone + "001");
    if (found == nodes.end() || twin == nodes.end() || found->second.size() != 1 ||
        twin->second.size() != 1)
        return;
    SourceNode& held = nodeAt(scene, found->second.front());
    SourceNode& free = nodeAt(scene, twin->second.front());
    if (held.meshes.empty() || !free.meshes.empty()) return;
    std::swap(held.name, free.name);
    std::swap(found->second, twin->second);
}

/// A mesh's bones without a node, and how much weight each shares with bones that have one.
class MissingBones {
public:
    MissingBones(const std::map<std::string, int>& nodes, const SourceMesh& mesh) {
        for (const SourceBone& bone : mesh.bones) {
            const double volume = glm::determinant(bone.offset);
            if (!std::isfinite(volume) || volume == 0.0) continue;
            const auto found = nodes.find(bone.name);
            _bones.push_back({&bone, found == nodes.end() ? kNone : found->second, nullptr, 0.0});
        }
        const auto hasNode = [](const Bone& bone) { return bone.node != kNone; };
        if (std::all_of(_bones.begin(), _bones.end(), hasNode)) _bones.clear(); // the usual case
        if (_bones.empty()) return;
        _weightsOf.resize(mesh.positions.size());
        for (std::size_t b = 0; b < _bones.size(); ++b)
            for (const SourceBone::Weight& entry : _bones[b].bone->weights)
                if (entry.vertex < _weightsOf.size())
                    _weightsOf[entry.vertex].push_back({b, double(entry.weight)});
        for (std::size_t b = 0; b < _bones.size(); ++b)
            if (hasNode(_bones[b])) offer(b);
    }

    static constexpr int kNone = -1;

    struct Bone {
        const SourceBone* bone;
        int node;          ///< index in the scene; kNone if missing
        const Bone* above; ///< the bone with a node that shares most
        double shared;     ///< sum of products of the two bones' weights
    };

    /// The bone without a node that shares most with one that has a node; null if there is none.
    Bone* next() {
        Bone* best = nullptr;
        for (Bone& bone : _bones)
            if (bone.node == kNone && bone.shared > 0.0 &&
                (best == nullptr || bone.shared > best->shared))
                best = &bone;
        return best;
    }

    /// Sets the node of the bone that next() returned.
    void setNode(Bone& bone, int node) {
        bone.node = node;
        offer(static_cast<std::size_t>(&bone - _bones.data()));
    }

private:
    /// Updates the best parent of each bone without a node, given a bone that has one.
    void offer(std::size_t parent) {
        std::vector<double> shared(_bones.size(), 0.0);
        for (const SourceBone::Weight& entry : _bones[parent].bone->weights)
            if (entry.vertex < _weightsOf.size())
                for (const auto& [other, share] : _weightsOf[entry.vertex])
                    shared[other] += double(entry.weight) * share;
        for (std::size_t b = 0; b < _bones.size(); ++b)
            if (_bones[b].node == kNone && shared[b] > _bones[b].shared) {
                _bones[b].above = &_bones[parent];
                _bones[b].shared = shared[b];
            }
    }

    std::vector<Bone> _bones;
    std::vector<std::vector<std::pair<std::size_t, double>>> _weightsOf; ///< [vertex]
};

} // namespace

void separateNames(SourceScene& scene, const std::string& path) {
    NodesOfName nodes = nodesByName(scene);
    if (osgDB::getLowerCaseFileExtension(path) == "fbx")
        for (const std::string& bone : boneNames(scene)) exchangeWithTwin(scene, bone, nodes);
    UniqueNames taken;
    for (const auto& [name, same] : nodes) taken.take(name);
    for (auto& [name, same] : nodes) {
        const auto meant = std::find_if(same.begin(), same.end(), [&scene](int node) {
            return nodeAt(scene, node).meshes.empty();
        });
        const int keeper = meant == same.end() ? same.front() : *meant;
        for (const int node : same)
            if (node != keeper) nodeAt(scene, node).name = taken.unique(name);
    }
}

void addMissingBones(SourceScene& scene, const std::string& path) {
    std::map<std::string, int> nodes;
    for (const auto& [name, same] : nodesByName(scene)) nodes.emplace(name, same.front());
    for (const auto& mesh : scene.meshes) {
        if (mesh->bones.empty()) continue;
        MissingBones missing(nodes, *mesh);
        while (MissingBones::Bone* found = missing.next()) {
            const SourceBone &bone = *found->bone, &above = *found->above->bone;
            const int node = scene.addNode(bone.name, found->above->node,
                                           above.offset * glm::inverse(bone.offset));
            nodes.emplace(bone.name, node);
            missing.setNode(*found, node);
            warn(path, "bone \"" + bone.name + "\" has weights but no node; it follows \"" +
                           above.name + '"');
        }
    }
}

void dropCoarseLevels(SourceScene& scene, const std::string& path) {
    const auto shownAs = [](const SourceNode& node) { // "Body_LOD2": "Body" and 2
        std::size_t digits = node.name.size();
        while (digits > 0 && std::isdigit(static_cast<unsigned char>(node.name[digits - 1])) != 0)
            --digits;
        std::string word = node.name.substr(digits < 4 ? 0 : digits - 4, 4);
        std::transform(word.begin(), word.end(), word.begin(),
                       [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
        const std::size_t size = node.name.size() - digits;
        const bool isLevel = !node.meshes.empty() && size > 0 && size < 3 && digits >= 4 &&
                             (word == "_lod" || word == ".lod" || word == "-lod");
        return isLevel ? std::make_pair(node.name.substr(0, digits - 4),
                                        std::stoi(node.name.substr(digits)))
                       : std::make_pair(std::string(), -1);
    };
    std::map<std::string, int> finest;
    for (const SourceNode& node : scene.nodes)
        if (const auto [name, level] = shownAs(node); level >= 0) {
            const auto known = finest.emplace(name, level).first;
            known->second = std::min(known->second, level);
        }
    std::size_t dropped = 0;
    std::string first;
    for (SourceNode& node : scene.nodes) {
        const auto [name, level] = shownAs(node);
        if (level < 0 || level == finest.at(name)) continue;
        node.meshes.clear();
        if (dropped++ == 0) first = node.name;
    }
    if (dropped > 0)
        warn(path, std::to_string(dropped) + " coarser levels of detail are left out, " +
                       inQuotes(first) + " among them");
}

void takeClipScales(SourceScene& scene) {
    constexpr float kSame = 1e-4f; // relative
    struct Scale {
        glm::vec3 value{0.0f};
        std::size_t clips = 0; ///< with just this scale
    };
    std::map<std::string, Scale> scales;
    for (const auto& animation : scene.animations)
        for (const SourceTrack& track : animation->tracks) {
            if (track.scales.empty()) continue;
            Scale& scale = scales[track.node];
            if (scale.clips == 0) scale.value = track.scales.front().value;
            if (std::all_of(track.scales.begin(), track.scales.end(), [&](const auto& key) {
                    return glm::distance(key.value, scale.value) <=
                           kSame * glm::length(scale.value);
                }))
                ++scale.clips;
        }
    for (SourceNode& node : scene.nodes) {
        const auto found = scales.find(node.name);
        if (found == scales.end() || found->second.clips != scene.animations.size()) continue;
        const glm::dvec3 own = decompose(node.matrix).scale, scale(found->second.value);
        for (int axis = 0; axis < 3; ++axis)
            if (own[axis] > 0.0 && scale[axis] > 0.0 &&
                std::abs(own[axis] - scale[axis]) > double(kSame) * own[axis])
                node.matrix[axis] *= scale[axis] / own[axis];
    }
}

} // namespace osgSkin
