// SPDX-License-Identifier: MIT
#include "model/VertexGroups.h"

#include "model/CorrectiveBlocks.h"
#include "model/SkinBlocks.h"

#include <osgSkin/Error>
#include <osgSkin/SkinModel>

#include <algorithm>
#include <map>
#include <numeric>
#include <tuple>
#include <utility>

namespace osgSkin {
namespace {

/// Joints that vertices follow in part where groups join, at most; as many as bindings have.
constexpr std::size_t kMostJoined = 4;

/// What the vertices of a group have in common: twice each joint's place in the product, one more
/// where they follow it in part. Sorted.
using Signature = std::vector<std::uint32_t>;

/// \param places of the joints in the product
Signature signatureOf(const Binding& binding, const std::vector<std::uint32_t>& places,
                      std::uint32_t vertex) {
    Signature signature;
    for (std::uint32_t i = binding.firstInfluence[vertex]; i < binding.firstInfluence[vertex + 1];
         ++i) {
        const Influence& influence = binding.influences[i];
        if (influence.bend == 0.0f && influence.twist == 0.0f) continue;
        signature.push_back(2 * places[influence.joint] + (influence.isPartial() ? 1u : 0u));
    }
    std::sort(signature.begin(), signature.end());
    return signature;
}

std::size_t partialCount(const Signature& signature) {
    return static_cast<std::size_t>(std::count_if(signature.begin(), signature.end(),
                                                  [](std::uint32_t key) { return key % 2 == 1; }));
}

/// The one that vertices of both can have: joints that one of them does not follow, or only one
/// follows wholly, are followed in part, by ratios 0 or 1.
void unite(const Signature& a, const Signature& b, Signature& result) {
    result.clear();
    auto i = a.begin(), k = b.begin();
    while (i != a.end() || k != b.end()) {
        const std::uint32_t joint =
            std::min(i != a.end() ? *i / 2 : *k / 2, k != b.end() ? *k / 2 : *i / 2);
        const bool inA = i != a.end() && *i / 2 == joint, inB = k != b.end() && *k / 2 == joint;
        const bool whole = inA && inB && *i % 2 == 0 && *k % 2 == 0;
        result.push_back(2 * joint + (whole ? 0u : 1u));
        if (inA) ++i;
        if (inB) ++k;
    }
}

/// The vertices of each signature. Sorted, so that groups side by side share their outer links.
using Members = std::map<Signature, std::vector<std::uint32_t>>;

/// What it takes to deform a group, about, in the time that a link of a block takes.
double costOf(const Signature& signature, std::size_t vertices) {
    constexpr double kGroup = 2.0; // to begin one
    const std::size_t count = (vertices + kBlock - 1) / kBlock;
    const auto blocks = static_cast<double>(count);
    return kGroup + blocks * (1.0 + static_cast<double>(partialCount(signature)));
}

/// Lets small groups join others, where that takes less time than the padding of both and one group
/// more. Of many, a group looks at those that are most like it in order, and at fewer where each
/// has a long chain of joints: painted weights make thousands.
void joinSmall(Members& members) {
    constexpr std::size_t kSmall = 2 * kBlock;
    constexpr std::size_t kTriedOnASide = 64, kJointsTried = 64 * kTriedOnASide;
    struct Small {
        std::size_t vertices;
        Signature signature;
        bool operator<(const Small& other) const {
            return std::tie(vertices, signature) < std::tie(other.vertices, other.signature);
        }
    };
    std::vector<Small> small;
    for (const auto& [signature, vertices] : members)
        if (vertices.size() < kSmall) small.push_back({vertices.size(), signature});
    std::sort(small.begin(), small.end());
    Signature united, best;
    for (const Small& one : small) {
        const auto own = members.find(one.signature);
        if (own == members.end() || own->second.size() >= kSmall) continue;
        const std::size_t count = own->second.size();
        const std::size_t tried =
            std::min(kTriedOnASide, kJointsTried / std::max<std::size_t>(one.signature.size(), 1));
        double most = 0.0;
        auto with = members.end();
        auto other = own, last = own;
        for (std::size_t i = 0; i < tried && other != members.begin(); ++i) --other;
        for (std::size_t i = 0; i <= tried && last != members.end(); ++i) ++last;
        for (; other != last; ++other) {
            if (other == own) continue;
            unite(one.signature, other->first, united);
            if (partialCount(united) > kMostJoined &&
                partialCount(united) > partialCount(other->first))
                continue;
            const std::size_t others = other->second.size();
            const double saved = costOf(one.signature, count) + costOf(other->first, others) -
                                 costOf(united, count + others);
            if (saved <= most) continue;
            most = saved;
            with = other;
            best = united;
        }
        if (with == members.end()) continue;
        std::vector<std::uint32_t> all = std::move(with->second);
        all.insert(all.end(), own->second.begin(), own->second.end());
        members.erase(own);
        members.erase(with);
        std::vector<std::uint32_t>& to = members[best]; // which there may be already
        if (to.size() < all.size()) to.swap(all);
        to.insert(to.end(), all.begin(), all.end());
    }
}

/// \param order productOrder() of the binding's joints
Members groupVertices(const Binding& binding, const std::vector<std::uint32_t>& order,
                      const std::vector<std::uint32_t>& source) {
    const std::vector<std::uint32_t> places = productPlaces(order);
    Members members;
    for (std::uint32_t v = 0; v < source.size(); ++v) {
        if (source[v] >= binding.vertexCount())
            throw Error("skin model: vertex " + std::to_string(v) + " comes from no bound vertex");
        members[signatureOf(binding, places, source[v])].push_back(v);
    }
    joinSmall(members);
    for (auto& [signature, vertices] : members) {
        std::sort(vertices.begin(), vertices.end());
        if (binding.correctives.empty()) continue;
        std::stable_sort(vertices.begin(), vertices.end(), [&](std::uint32_t a, std::uint32_t b) {
            return correctedBy(binding, source[a]) < correctedBy(binding, source[b]);
        });
    }
    return members;
}

std::vector<VertexGroups::Joint> jointsOf(const std::vector<std::uint32_t>& order,
                                          const Signature& signature) {
    std::vector<VertexGroups::Joint> joints;
    for (const std::uint32_t key : signature) joints.push_back({order[key / 2], key % 2 == 1});
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
    const std::vector<std::uint32_t> order = productOrder(binding.joints);
    for (const auto& [signature, vertices] : groupVertices(binding, order, _source)) {
        const std::vector<Joint> joints = jointsOf(order, signature);
        checkPartial(joints, vertices.front());
        _groups.push_back({joints, static_cast<std::uint32_t>(_order.size()),
                           static_cast<std::uint32_t>(vertices.size())});
        _order.insert(_order.end(), vertices.begin(), vertices.end());
    }
}

const Influence* influenceOf(const Binding& binding, std::uint32_t vertex, std::uint32_t joint) {
    const auto end = binding.influences.begin() + binding.firstInfluence[vertex + 1];
    const auto found = std::find_if(binding.influences.begin() + binding.firstInfluence[vertex],
                                    end, [joint](const Influence& i) { return i.joint == joint; });
    return found == end ? nullptr : &*found;
}

void VertexGroups::reorder() {
    std::vector<std::uint32_t> source;
    source.reserve(_source.size());
    for (const std::uint32_t v : _order) source.push_back(_source[v]);
    _source.swap(source);
    std::iota(_order.begin(), _order.end(), 0u);
}

} // namespace osgSkin
