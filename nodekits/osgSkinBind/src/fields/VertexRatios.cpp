// SPDX-License-Identifier: GPL-3.0-or-later
#include "fields/VertexRatios.h"

namespace osgSkin {
namespace {

/// Goes through both fields of a joint at once.
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
