// SPDX-License-Identifier: GPL-3.0-or-later
#include "ratios/JointFields.h"

#include <algorithm>

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

} // namespace osgSkin
