// SPDX-License-Identifier: MIT
#include "scene/SourceScene.h"

#include <algorithm>
#include <cstdint>
#include <memory>
#include <string>
#include <type_traits>
#include <unordered_map>
#include <utility>
#include <vector>

namespace osgSkin {
namespace {

/// Appends numbers' bytes to a key, with one kind of zero.
template <typename Number>
void append(const Number* numbers, std::size_t count, std::string& key) {
    for (std::size_t i = 0; i < count; ++i) {
        const Number number =
            std::is_floating_point_v<Number> ? numbers[i] + Number(0) : numbers[i];
        key.append(reinterpret_cast<const char*>(&number), sizeof number);
    }
}

template <typename Vector>
void append(const std::vector<Vector>& vectors, std::size_t v, std::string& key) {
    if (!vectors.empty()) append(&vectors[v][0], std::size_t(Vector::length()), key);
}

/// A key of all that vertices have. [vertex]
std::vector<std::string> keysOf(const SourceMesh& mesh) {
    std::vector<std::string> result(mesh.positions.size());
    for (std::size_t v = 0; v < result.size(); ++v) {
        append(mesh.positions, v, result[v]);
        append(mesh.normals, v, result[v]);
        append(mesh.tangents, v, result[v]);
        append(mesh.texCoords, v, result[v]);
        append(mesh.colours, v, result[v]);
    }
    for (std::uint32_t b = 0; b < mesh.bones.size(); ++b)
        for (const SourceBone::Weight& entry : mesh.bones[b].weights) {
            if (entry.vertex >= result.size()) continue; // reported when the mesh is used
            append(&b, 1, result[entry.vertex]);
            append(&entry.weight, 1, result[entry.vertex]);
        }
    for (std::uint32_t m = 0; m < mesh.morphs.size(); ++m) {
        const MorphTarget& morph = mesh.morphs[m];
        for (std::size_t i = 0; i < morph.vertices.size(); ++i) {
            std::string& key = result[morph.vertices[i]];
            append(&m, 1, key);
            append(morph.positions, i, key);
            append(morph.normals, i, key);
            append(morph.tangents, i, key);
        }
    }
    return result;
}

template <typename Value>
void keep(const std::vector<std::size_t>& kept, std::vector<Value>& values) {
    if (values.empty()) return;
    for (std::size_t i = 0; i < kept.size(); ++i) values[i] = values[kept[i]];
    values.resize(kept.size());
}

/// A copy with each vertex once; null if all differ.
std::shared_ptr<const SourceMesh> joined(const SourceMesh& mesh) {
    std::unordered_map<std::string, std::uint32_t> indices;
    std::vector<std::uint32_t> indexOf; // [vertex]
    std::vector<std::size_t> kept;      // the first of each
    std::vector<bool> isKept;           // [vertex]
    for (std::string& key : keysOf(mesh)) {
        const auto index = static_cast<std::uint32_t>(indices.size());
        const auto [known, isNew] = indices.emplace(std::move(key), index);
        if (isNew) kept.push_back(indexOf.size());
        isKept.push_back(isNew);
        indexOf.push_back(known->second);
    }
    if (kept.size() == indexOf.size()) return nullptr;
    auto result = std::make_shared<SourceMesh>(mesh);
    keep(kept, result->positions);
    keep(kept, result->normals);
    keep(kept, result->tangents);
    keep(kept, result->texCoords);
    keep(kept, result->colours);
    for (std::uint32_t& corner : result->corners)
        if (corner < indexOf.size()) corner = indexOf[corner];
    for (SourceBone& bone : result->bones) {
        auto& weights = bone.weights;
        weights.erase(std::remove_if(weights.begin(), weights.end(),
                                     [&](const auto& entry) {
                                         return entry.vertex < isKept.size() &&
                                                !isKept[entry.vertex];
                                     }),
                      weights.end());
        for (SourceBone::Weight& entry : weights)
            if (entry.vertex < indexOf.size()) entry.vertex = indexOf[entry.vertex];
    }
    for (MorphTarget& morph : result->morphs) {
        std::vector<std::size_t> entries;
        for (std::size_t i = 0; i < morph.vertices.size(); ++i)
            if (isKept[morph.vertices[i]]) entries.push_back(i);
        for (std::uint32_t& vertex : morph.vertices) vertex = indexOf[vertex];
        keep(entries, morph.vertices);
        keep(entries, morph.positions);
        keep(entries, morph.normals);
        keep(entries, morph.tangents);
    }
    return result;
}

} // namespace

void joinEqualVertices(SourceScene& scene) {
    for (auto& mesh : scene.meshes)
        if (auto result = joined(*mesh)) mesh = std::move(result);
}

} // namespace osgSkin
