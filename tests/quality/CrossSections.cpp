// SPDX-License-Identifier: MIT
#include "CrossSections.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <map>

namespace quality {
namespace {

osgSkin::Influence ratiosOf(const osgSkin::Binding& binding, std::uint32_t vertex,
                            std::size_t joint) {
    for (std::uint32_t i = binding.firstInfluence[vertex]; i < binding.firstInfluence[vertex + 1];
         ++i)
        if (binding.influences[i].joint == joint) return binding.influences[i];
    return {static_cast<std::uint32_t>(joint), 0.0f, 0.0f};
}

/// The ratios of one joint, between the edges' ends; all other joints stay at rest, so theirs do
/// not matter.
osgSkin::Binding bindingOf(const Subject& subject, std::size_t joint,
                           const std::vector<EdgePoint>& points) {
    osgSkin::Binding binding;
    binding.joints = subject.binding.joints;
    binding.regions.assign(points.size(), 0);
    binding.firstInfluence.push_back(0);
    for (const EdgePoint& point : points) {
        const osgSkin::Influence a = ratiosOf(subject.binding, point.from, joint);
        const osgSkin::Influence b = ratiosOf(subject.binding, point.to, joint);
        const auto share = static_cast<float>(point.share);
        binding.influences.push_back({0, 1.0f, 1.0f});
        binding.influences.push_back({static_cast<std::uint32_t>(joint),
                                      std::clamp(glm::mix(a.bend, b.bend, share), 0.0f, 1.0f),
                                      std::clamp(glm::mix(a.twist, b.twist, share), 0.0f, 1.0f)});
        binding.firstInfluence.push_back(static_cast<std::uint32_t>(binding.influences.size()));
    }
    return binding;
}

compare::SkinWeights weightsOf(const compare::SkinWeights& weights,
                               const std::vector<EdgePoint>& points) {
    compare::SkinWeights result;
    for (const EdgePoint& point : points) {
        std::vector<compare::JointWeight> entries;
        for (const bool end : {false, true}) {
            const std::uint32_t v = end ? point.to : point.from;
            const double share = end ? point.share : 1.0 - point.share;
            for (std::uint32_t i = weights.first[v]; i < weights.first[v + 1]; ++i)
                entries.push_back({weights.entries[i].joint, share * weights.entries[i].weight});
        }
        result.add(entries);
    }
    return result;
}

compare::Points onEdges(const compare::Points& vertices, const std::vector<EdgePoint>& points) {
    compare::Points result;
    for (const EdgePoint& point : points)
        result.push_back(glm::mix(vertices[point.from], vertices[point.to], point.share));
    return result;
}

} // namespace

CrossSections::CrossSections(const Subject& subject, std::size_t joint,
                             const std::vector<std::vector<EdgePoint>>& loops) {
    for (const std::vector<EdgePoint>& loop : loops) {
        _loops.emplace_back();
        for (const EdgePoint& point : loop) {
            _loops.back().push_back(static_cast<std::uint32_t>(_points.size()));
            _points.push_back(point);
        }
    }
    if (_points.empty()) return;
    _fine.rest = onEdges(subject.rest, _points);
    _fine.weights = weightsOf(subject.weights, _points);
    _fine.binding = bindingOf(subject, joint, _points);
    _fine.model = modelOf(_fine);
}

CrossSections::Least CrossSections::leastAreas(Method method,
                                               const std::vector<glm::dmat4>& skinning,
                                               const compare::Points& posed) const {
    Least least;
    if (_points.empty()) return least;
    const compare::Points fine = deform(_fine, method, skinning);
    const compare::Points coarse = onEdges(posed, _points);
    for (const std::vector<std::uint32_t>& loop : _loops) {
        const double area = compare::loopArea(_fine.rest, loop);
        if (!(area > 0.0)) continue;
        least.ofMethod = std::min(least.ofMethod, compare::loopArea(fine, loop) / area);
        least.ofMesh = std::min(least.ofMesh, compare::loopArea(coarse, loop) / area);
    }
    return least;
}

} // namespace quality
