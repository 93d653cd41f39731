// SPDX-License-Identifier: MIT
#include "model/VertexGroups.h"

#include "model/CorrectiveBlocks.h"

#include <osgSkin/Error>
#include <osgSkin/SkinModel>

#include <algorithm>
#include <map>
#include <numeric>
#include <utility>

namespace osgSkin {
namespace {

/// What the vertices of a group have in common: twice each joint's index, one more where they
/// follow it in part.
using Signature = std::vector<std::uint32_t>;

Signature signatureOf(const Binding& binding, std::uint32_t vertex) {
    Signature signature;
    for (std::uint32_t i = binding.firstInfluence[vertex]; i < binding.firstInfluence[vertex + 1];
         ++i) {
        const Influence& influence = binding.influences[i];
        if (influence.bend == 0.0f && influence.twist == 0.0f) continue;
        signature.push_back(2 * influence.joint + (influence.isPartial() ? 1u : 0u));
    }
    return signature;
}

/// The vertices of each signature. Sorted, so that groups side by side share their outer links.
using Members = std::map<Signature, std::vector<std::uint32_t>>;

Members groupBySignature(const Binding& binding, const std::vector<std::uint32_t>& source) {
    Members members;
    for (std::uint32_t v = 0; v < source.size(); ++v) {
        if (source[v] >= binding.vertexCount())
            throw Error("skin model: vertex " + std::to_string(v) + " comes from no bound vertex");
        members[signatureOf(binding, source[v])].push_back(v);
    }
    if (binding.correctives.empty()) return members;
    for (auto& [signature, vertices] : members)
        std::stable_sort(vertices.begin(), vertices.end(), [&](std::uint32_t a, std::uint32_t b) {
            return correctedBy(binding, source[a]) < correctedBy(binding, source[b]);
        });
    return members;
}

std::vector<VertexGroups::Joint> jointsOf(const Signature& signature) {
    std::vector<VertexGroups::Joint> joints;
    for (const std::uint32_t key : signature) joints.push_back({key / 2, key % 2 == 1});
    return joints;
}

void checkPartial(const std::vector<VertexGroups::Joint>& joints, std::uint32_t vertex) {
    const auto partial = static_cast<std::size_t>(std::count_if(
        joints.begin(), joints.end(), [](const VertexGroups::Joint& j) { return j.partial; }));
    if (partial > SkinModel::kMaxPartialInfluences)
        throw Error("skin model: vertex " + std::to_string(vertex) + " follows " +
                    std::to_string(partial) + " joints partly, expected at most " +
                    std::to_string(SkinModel::kMaxPartialInfluences));
}

} // namespace

VertexGroups::VertexGroups(const Binding& binding, std::vector<std::uint32_t> source)
    : _binding(&binding), _source(std::move(source)) {
    binding.validate();
    _order.reserve(_source.size());
    for (const auto& [signature, vertices] : groupBySignature(binding, _source)) {
        const std::vector<Joint> joints = jointsOf(signature);
        checkPartial(joints, vertices.front());
        _groups.push_back({joints, static_cast<std::uint32_t>(_order.size()),
                           static_cast<std::uint32_t>(vertices.size())});
        _order.insert(_order.end(), vertices.begin(), vertices.end());
    }
}

void VertexGroups::reorder() {
    std::vector<std::uint32_t> source;
    source.reserve(_source.size());
    for (const std::uint32_t v : _order) source.push_back(_source[v]);
    _source.swap(source);
    std::iota(_order.begin(), _order.end(), 0u);
}

} // namespace osgSkin
