// SPDX-License-Identifier: MIT
#include <osgSkinRig/MorphsByVertex>

#include <algorithm>
#include <numeric>
#include <utility>

namespace osgSkin {

MorphsByVertex::MorphsByVertex(const std::vector<MorphTarget>& targets) : _targets(targets) {
    std::size_t vertices = 0;
    for (const MorphTarget& target : targets)
        for (const std::uint32_t vertex : target.vertices)
            vertices = std::max(vertices, vertex + std::size_t{1});
    _first.assign(vertices + 1, 0);
    for (const MorphTarget& target : targets)
        for (const std::uint32_t vertex : target.vertices) ++_first[vertex + std::size_t{1}];
    std::partial_sum(_first.begin(), _first.end(), _first.begin());
    _entries.resize(_first.back());
    std::vector<std::size_t> next(_first.begin(), _first.end() - 1);
    for (std::uint32_t t = 0; t < targets.size(); ++t)
        for (std::uint32_t i = 0; i < targets[t].vertices.size(); ++i)
            _entries[next[targets[t].vertices[i]]++] = {t, i};
}

std::vector<MorphTarget> MorphsByVertex::ofCopies(const std::vector<std::uint32_t>& source) const {
    struct Range {
        std::size_t begin, end;
    };
    std::vector<Range> ranges; // of entries, of each copy
    std::vector<std::size_t> counts(_targets.size(), 0);
    ranges.reserve(source.size());
    for (const std::uint32_t vertex : source) {
        const bool isMoved = vertex + std::size_t{1} < _first.size();
        ranges.push_back(isMoved ? Range{_first[vertex], _first[vertex + 1]} : Range{0, 0});
        for (std::size_t e = ranges.back().begin; e < ranges.back().end; ++e)
            ++counts[_entries[e].target];
    }
    // A piece with eyelids has an expression that overrides blinking, although it moves none of it.
    bool hasOverridden = false;
    for (std::size_t t = 0; t < _targets.size(); ++t)
        hasOverridden = hasOverridden ||
                        (counts[t] > 0 && _targets[t].rules.part != ExpressionRules::Part::None);
    std::vector<MorphTarget> result;
    std::vector<std::size_t> places(_targets.size());
    for (std::size_t t = 0; t < _targets.size(); ++t) {
        places[t] = result.size();
        if (counts[t] == 0 && !(hasOverridden && _targets[t].rules.overrides())) continue;
        MorphTarget& to = result.emplace_back();
        to.name = _targets[t].name;
        to.initial = _targets[t].initial;
        to.rules = _targets[t].rules;
        to.vertices.reserve(counts[t]);
        to.positions.reserve(counts[t]);
        to.normals.reserve(_targets[t].normals.empty() ? 0 : counts[t]);
        to.tangents.reserve(_targets[t].tangents.empty() ? 0 : counts[t]);
    }
    // Some targets at a time: the processor's caches hold what is read and written for these.
    const std::size_t step = std::max(std::size_t{16}, _targets.size() / 64);
    for (std::size_t end = step; end < _targets.size() + step; end += step)
        for (std::uint32_t copy = 0; copy < source.size(); ++copy)
            for (Range& range = ranges[copy];
                 range.begin < range.end && _entries[range.begin].target < end; ++range.begin) {
                const Entry& entry = _entries[range.begin];
                const MorphTarget& from = _targets[entry.target];
                MorphTarget& to = result[places[entry.target]];
                to.vertices.push_back(copy);
                to.positions.push_back(from.positions[entry.index]);
                if (!from.normals.empty()) to.normals.push_back(from.normals[entry.index]);
                if (!from.tangents.empty()) to.tangents.push_back(from.tangents[entry.index]);
            }
    return result;
}

} // namespace osgSkin
