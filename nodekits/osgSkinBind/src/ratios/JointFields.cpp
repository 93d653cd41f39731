// SPDX-License-Identifier: GPL-3.0-or-later
#include "ratios/JointFields.h"

#include <osgSkin/SkinModel>

#include <algorithm>
#include <functional>

namespace osgSkin {
namespace {

/// Visits both fields of a joint at once.
template <class Visit>
void eachRatio(const JointFields& bend, const JointFields& twist, std::uint32_t joint,
               const Visit& visit) {
    const std::vector<JointFields::Entry>&bends = bend.entries(joint),
          &twists = twist.entries(joint);
    auto b = bends.begin();
    auto t = twists.begin();
    while (b != bends.end() || t != twists.end()) {
        const bool hasBend = b != bends.end() && (t == twists.end() || b->vertex <= t->vertex);
        const bool hasTwist = t != twists.end() && (b == bends.end() || t->vertex <= b->vertex);
        const std::uint32_t vertex = hasBend ? b->vertex : t->vertex;
        visit(vertex, JointRatio{joint, hasBend ? b->value : 0.0, hasTwist ? t->value : 0.0});
        if (hasBend) ++b;
        if (hasTwist) ++t;
    }
}

/// Ratios this close to 0 or 1 cost time in every frame for an invisible movement.
constexpr double kNothing = 1e-4;

float ratio(double a) {
    if (a < kNothing) return 0.0f;
    return a > 1.0 - kNothing ? 1.0f : static_cast<float>(a);
}

float distanceToFull(float a) {
    return std::min(a, 1.0f - a);
}

/// The distance of a joint's ratios from 0 or 1.
float partialness(const Influence& i) {
    return std::max(distanceToFull(i.bend), distanceToFull(i.twist));
}

/// partialness() of the first surplus joint; 0 if there is none.
float excess(const std::vector<Influence>& all, std::size_t mostPartial) {
    std::vector<float> partial;
    for (const Influence& influence : all)
        if (influence.isFractional()) partial.push_back(partialness(influence));
    if (partial.size() <= mostPartial) return 0.0f;
    const auto extra = partial.begin() + static_cast<std::ptrdiff_t>(mostPartial);
    std::nth_element(partial.begin(), extra, partial.end(), std::greater<>());
    return *extra;
}

/// Stretches [margin, 1 - margin] to [0, 1] and clamps.
float stretched(float a, float margin) {
    if (margin >= 0.499f) return a < 0.5f ? 0.0f : 1.0f;
    return std::clamp((a - margin) / (1.0f - 2.0f * margin), 0.0f, 1.0f);
}

} // namespace

std::vector<double> JointFields::values(std::size_t joint) const {
    std::vector<double> result(_vertices, 0.0);
    for (const Entry& entry : _entries[joint]) result[entry.vertex] = entry.value;
    return result;
}

void JointFields::set(std::size_t joint, const std::vector<double>& values) {
    std::vector<Entry>& entries = _entries[joint];
    entries.clear();
    const auto zeros = std::count(values.begin(), values.end(), 0.0);
    entries.reserve(values.size() - static_cast<std::size_t>(zeros));
    for (std::uint32_t v = 0; v < values.size(); ++v)
        if (values[v] != 0.0) entries.push_back({v, values[v]});
    entries.shrink_to_fit();
}

void raise(std::vector<double>& values, const std::vector<JointFields::Entry>& field) {
    for (const JointFields::Entry& entry : field)
        values[entry.vertex] = std::max(values[entry.vertex], entry.value);
}

std::vector<std::vector<std::uint32_t>> freeChildren(const std::vector<PlannedJoint>& joints) {
    std::vector<std::vector<std::uint32_t>> children(joints.size());
    for (std::uint32_t j = 1; j < joints.size(); ++j)
        if (!joints[j].belowRigid(static_cast<int>(j)))
            children[static_cast<std::size_t>(joints[j].parent)].push_back(j);
    return children;
}

void raiseParents(const std::vector<PlannedJoint>& joints, JointFields& fields) {
    const std::vector<std::vector<std::uint32_t>> children = freeChildren(joints);
    for (std::size_t parent = joints.size(); parent-- > 0;) {
        const auto isEmpty = [&](std::uint32_t j) { return fields.entries(j).empty(); };
        if (std::all_of(children[parent].begin(), children[parent].end(), isEmpty)) continue;
        std::vector<double> values = fields.values(parent);
        for (const std::uint32_t child : children[parent]) raise(values, fields.entries(child));
        fields.set(parent, values);
    }
}

VertexRatios::VertexRatios(const JointFields& bend, const JointFields& twist)
    : _first(bend.vertexCount() + 1, 0) {
    const auto joints = static_cast<std::uint32_t>(bend.jointCount());
    for (std::uint32_t j = 0; j < joints; ++j)
        eachRatio(bend, twist, j, [&](std::uint32_t v, const JointRatio&) { ++_first[v + 1]; });
    for (std::size_t v = 1; v < _first.size(); ++v) _first[v] += _first[v - 1];
    _ratios.resize(_first.back());
    std::vector<std::size_t> next(_first.begin(), _first.end() - 1);
    for (std::uint32_t j = 0; j < joints; ++j)
        eachRatio(bend, twist, j,
                  [&](std::uint32_t v, const JointRatio& ratio) { _ratios[next[v]++] = ratio; });
}

std::vector<JointRatio> VertexRatios::of(std::uint32_t vertex) const {
    return {_ratios.begin() + static_cast<std::ptrdiff_t>(_first[vertex]),
            _ratios.begin() + static_cast<std::ptrdiff_t>(_first[vertex + 1])};
}

bool packInfluences(const std::vector<JointRatio>& ratios, std::size_t mostPartial,
                    std::vector<Influence>& influences) {
    std::vector<Influence> all;
    all.reserve(ratios.size());
    for (const JointRatio& of : ratios) all.push_back({of.joint, ratio(of.bend), ratio(of.twist)});

    const float margin = excess(all, mostPartial);
    if (margin > 0.0f)
        for (Influence& influence : all) {
            // ratio() rounds those that differ from the surplus one only by rounding errors.
            influence.bend = ratio(stretched(influence.bend, margin));
            influence.twist = ratio(stretched(influence.twist, margin));
        }
    // A joint that only twists skin is partial, too. If there are more than the runtime can split,
    // the lowest ones get their bend ratio as twist ratio.
    auto partial = std::count_if(all.begin(), all.end(),
                                 [](const Influence& influence) { return influence.isPartial(); });
    for (auto lowest = all.rbegin(); lowest != all.rend(); ++lowest) {
        if (partial <= static_cast<std::ptrdiff_t>(SkinModel::kMaxPartialInfluences)) break;
        if (lowest->isFractional() || !lowest->isPartial()) continue;
        lowest->twist = lowest->bend;
        --partial;
    }
    for (const Influence& influence : all)
        if (influence.bend > 0.0f || influence.twist > 0.0f) influences.push_back(influence);
    return margin > 0.0f;
}

} // namespace osgSkin
