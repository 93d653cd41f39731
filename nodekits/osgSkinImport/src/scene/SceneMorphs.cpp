// SPDX-License-Identifier: MIT
#include "scene/SceneMorphs.h"

#include "files/FileText.h"

#include <algorithm>
#include <cmath>

namespace osgSkin {
namespace {

using Lists = std::vector<glm::vec3> MorphTarget::*;

/// Exporters compute offsets from coordinates in single precision.
constexpr float kRounding = 2.5e-7f; ///< relative to the largest coordinate
constexpr float kTurned = 1e-4f;     ///< a change of a normal or a tangent that counts

/// Adds the vertices that are moved farther than `min`, in increasing order.
void addMoved(const VertexOffsets& from, float min, std::vector<std::uint32_t>& vertices) {
    const std::size_t before = vertices.size();
    for (std::size_t i = 0; i < from.vertices.size(); ++i) {
        const glm::vec3& offset = from.offsets[i];
        for (int axis = 0; axis < 3; ++axis)
            if (!(std::abs(offset[axis]) <= min)) { // also NaN, which is refused later
                vertices.push_back(from.vertices[i]);
                break;
            }
    }
    if (before == 0) return;
    std::inplace_merge(vertices.begin(), vertices.begin() + std::ptrdiff_t(before), vertices.end());
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
}

/// The offsets of `vertices`, zero where there is none; none at all if there are none.
std::vector<glm::vec3> offsetsOf(const VertexOffsets& from,
                                 const std::vector<std::uint32_t>& vertices) {
    std::vector<glm::vec3> result;
    if (from.vertices.empty()) return result;
    result.reserve(vertices.size());
    std::size_t at = 0;
    for (const std::uint32_t vertex : vertices) {
        while (at < from.vertices.size() && from.vertices[at] < vertex) ++at;
        const bool isMoved = at < from.vertices.size() && from.vertices[at] == vertex;
        result.push_back(isMoved ? from.offsets[at] : glm::vec3(0.0f));
    }
    return result;
}

} // namespace

MorphNames::MorphNames(const std::vector<std::string>& taken) {
    for (const std::string& name : taken) _taken.take(name);
}

std::vector<std::string> MorphNames::of(const std::vector<std::string>& wanted,
                                        const std::vector<float>& initial) {
    std::vector<std::string> result;
    std::map<std::string, std::size_t> copies; // in this mesh
    for (std::size_t t = 0; t < wanted.size(); ++t) {
        std::string& name = _known[{wanted[t], copies[wanted[t]]++, initial[t]}];
        if (name.empty()) {
            name = _taken.unique(wanted[t]);
            if (name != wanted[t] && _renamed++ == 0) _first = name;
        }
        result.push_back(name);
    }
    return result;
}

void MorphNames::warnRenamed(const std::string& path) const {
    if (_renamed > 0)
        warn(path, "morph targets or expressions share names; " + std::to_string(_renamed) +
                       " were renamed, the first to " + inQuotes(_first));
}

void separateMorphs(SourceScene& scene, const std::string& path) {
    UniqueNames names;
    for (const auto& mesh : scene.meshes)
        for (const MorphTarget& target : mesh->morphs) names.take(target.name);
    // How each node's target of a name moves: each key's animation, time and weight.
    std::map<std::string, std::map<int, std::vector<double>>> moves;
    for (std::size_t a = 0; a < scene.animations.size(); ++a)
        for (const SourceMorphTrack& track : scene.animations[a]->morphs) {
            if (track.node < 0) continue;
            std::vector<double>& keys = moves[track.morph][track.node];
            for (const auto& [time, weight] : track.weights)
                keys.insert(keys.end(), {double(a), time, double(weight)});
        }
    std::map<std::pair<int, std::string>, std::string> renamed; // by node and name
    for (const auto& [name, nodes] : moves) {
        std::map<std::vector<double>, std::string> known{{nodes.begin()->second, name}};
        for (const auto& [node, keys] : nodes) {
            std::string& own = known[keys];
            if (own.empty()) own = names.unique(name);
            if (own != name) renamed[{node, name}] = own;
        }
    }
    if (renamed.empty()) return;
    warn(path,
         "meshes with morph targets of one name move differently; renamed: " +
             inQuotes(renamed.begin()->second) +
             (renamed.size() > 1 ? " and " + std::to_string(renamed.size() - 1) + " more" : ""));
    std::vector<std::size_t> uses(scene.meshes.size(), 0);
    for (const SourceNode& node : scene.nodes)
        for (const std::size_t mesh : node.meshes) ++uses[mesh];
    for (std::size_t n = 0; n < scene.nodes.size(); ++n)
        for (std::size_t& mesh : scene.nodes[n].meshes) {
            const auto isRenamed = [&](const MorphTarget& target) {
                return renamed.count({int(n), target.name}) != 0;
            };
            const std::vector<MorphTarget>& old = scene.meshes[mesh]->morphs;
            if (std::none_of(old.begin(), old.end(), isRenamed)) continue;
            const auto copy = std::make_shared<SourceMesh>(*scene.meshes[mesh]);
            for (MorphTarget& target : copy->morphs)
                if (isRenamed(target)) target.name = renamed.at({int(n), target.name});
            if (uses[mesh]-- > 1) {
                mesh = scene.meshes.size();
                scene.meshes.emplace_back();
                uses.push_back(1);
            }
            scene.meshes[mesh] = copy;
        }
    for (auto& animation : scene.animations) {
        const auto copy = std::make_shared<SourceAnimation>(*animation);
        for (SourceMorphTrack& track : copy->morphs)
            if (const auto found = renamed.find({track.node, track.morph}); found != renamed.end())
                track.morph = found->second;
        animation = copy;
    }
}

MorphFiller::MorphFiller(const SourceMesh& mesh) {
    for (const glm::vec3& p : mesh.positions)
        for (int axis = 0; axis < 3; ++axis)
            _rounding = std::max(_rounding, kRounding * std::abs(p[axis]));
}

void MorphFiller::fill(const VertexOffsets& positions, const VertexOffsets& normals,
                       const VertexOffsets& tangents, MorphTarget& target) const {
    target.vertices.clear();
    addMoved(positions, _rounding, target.vertices);
    addMoved(normals, kTurned, target.vertices);
    addMoved(tangents, kTurned, target.vertices);
    target.vertices.shrink_to_fit();
    target.positions = offsetsOf(positions, target.vertices);
    target.positions.resize(target.vertices.size());
    target.normals = offsetsOf(normals, target.vertices);
    target.tangents = offsetsOf(tangents, target.vertices);
}

MorphTarget sumOf(const std::vector<std::pair<const MorphTarget*, double>>& parts) {
    MorphTarget result;
    std::vector<std::uint32_t>& all = result.vertices;
    for (const auto& [part, weight] : parts)
        all.insert(all.end(), part->vertices.begin(), part->vertices.end());
    std::sort(all.begin(), all.end());
    all.erase(std::unique(all.begin(), all.end()), all.end());
    for (const Lists lists :
         {&MorphTarget::positions, &MorphTarget::normals, &MorphTarget::tangents}) {
        std::vector<glm::dvec3> sums;
        for (const auto& [part, weight] : parts) {
            const std::vector<glm::vec3>& offsets = part->*lists;
            if (offsets.empty()) continue;
            sums.resize(all.size(), glm::dvec3(0.0));
            auto at = all.begin();
            for (std::size_t i = 0; i < offsets.size(); ++i) {
                at = std::lower_bound(at, all.end(), part->vertices[i]);
                sums[std::size_t(at - all.begin())] += weight * glm::dvec3(offsets[i]);
            }
        }
        (result.*lists).assign(sums.begin(), sums.end());
    }
    return result;
}

} // namespace osgSkin
