// SPDX-License-Identifier: MIT
#include <osgSkin/SkinModel>

#include <osgSkin/Error>

#include "model/CorrectiveBlocks.h"
#include "model/SkinBlocks.h"

#include <algorithm>
#include <map>

namespace osgSkin {
namespace {

bool isPartial(float ratio) {
    return ratio > 0.0f && ratio < 1.0f;
}

/// A joint with one ratio 0 and the other 1 is no rigid turn either: it goes through the split.
bool isPartial(const Influence& influence) {
    return isPartial(influence.bend) || isPartial(influence.twist) ||
           influence.bend != influence.twist;
}

/// What the vertices of a group have in common: each joint they follow, and whether only partly.
using Signature = std::vector<std::uint32_t>;

Signature signatureOf(const Binding& binding, std::uint32_t vertex) {
    Signature signature;
    for (std::uint32_t i = binding.firstInfluence[vertex]; i < binding.firstInfluence[vertex + 1];
         ++i) {
        const Influence& influence = binding.influences[i];
        if (influence.bend == 0.0f && influence.twist == 0.0f) continue;
        signature.push_back(2 * influence.joint + (isPartial(influence) ? 1u : 0u));
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

} // namespace

std::vector<std::uint32_t> SkinModel::bestOrder(const Binding& binding,
                                                const std::vector<std::uint32_t>& source) {
    binding.validate();
    std::vector<std::uint32_t> order;
    order.reserve(source.size());
    for (const auto& [signature, vertices] : groupBySignature(binding, source))
        order.insert(order.end(), vertices.begin(), vertices.end());
    return order;
}

std::shared_ptr<const SkinModel> SkinModel::create(const Binding& binding,
                                                   std::vector<glm::vec3> positions,
                                                   std::vector<glm::vec3> normals,
                                                   const std::vector<std::uint32_t>& source) {
    const std::shared_ptr<SkinModel> model =
        arrange(binding, std::move(positions), std::move(normals), source);
    model->_boundsProxy = makeBoundsProxy(*model);
    return model;
}

std::shared_ptr<SkinModel> SkinModel::arrange(const Binding& binding,
                                              std::vector<glm::vec3> positions,
                                              std::vector<glm::vec3> normals,
                                              const std::vector<std::uint32_t>& source) {
    binding.validate();
    if (positions.size() != source.size() || normals.size() != source.size())
        throw Error("skin model: expected one position, one normal and one source per vertex");
    const Members members = groupBySignature(binding, source);

    std::shared_ptr<SkinModel> model(new SkinModel);
    model->_joints = binding.joints;
    model->_positions = std::move(positions);
    model->_normals = std::move(normals);
    model->_order.reserve(source.size());
    for (const auto& [signature, vertices] : members) {
        Group group{};
        group.firstVertex = static_cast<std::uint32_t>(model->_order.size());
        group.vertexCount = static_cast<std::uint32_t>(vertices.size());
        group.firstLink = static_cast<std::uint32_t>(model->_links.size());
        group.linkCount = static_cast<std::uint32_t>(signature.size());
        group.firstRatio = static_cast<std::uint32_t>(model->_ratios.size());
        for (const std::uint32_t key : signature) {
            model->_links.push_back({key / 2, key % 2 == 1});
            group.partialCount += key % 2;
        }
        if (group.partialCount > kMaxPartialInfluences)
            throw Error("skin model: vertex " + std::to_string(vertices.front()) + " follows " +
                        std::to_string(group.partialCount) + " joints partly, expected at most " +
                        std::to_string(kMaxPartialInfluences));
        model->_groups.push_back(group);
        model->addVertices(binding, source, vertices);
    }
    model->_blocks = std::make_shared<SkinBlocks>(*model);
    if (!binding.correctives.empty())
        model->_correctives = std::make_shared<CorrectiveBlocks>(*model, binding, source);
    return model;
}

void SkinModel::addVertices(const Binding& binding, const std::vector<std::uint32_t>& source,
                            const std::vector<std::uint32_t>& vertices) {
    for (const std::uint32_t v : vertices) {
        _order.push_back(v);
        const std::uint32_t s = source[v];
        for (std::uint32_t i = binding.firstInfluence[s]; i < binding.firstInfluence[s + 1]; ++i)
            if (isPartial(binding.influences[i]))
                _ratios.push_back({binding.influences[i].bend, binding.influences[i].twist});
    }
}

} // namespace osgSkin
