// SPDX-License-Identifier: MIT
#include "WorstEdges.h"

#include "../Format.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <map>

namespace quality {
namespace {

constexpr double kShare = 1e-3; // beyond the 99.9th percentile

std::vector<glm::dvec2> ratiosOf(const osgSkin::Binding& binding, std::size_t vertex) {
    std::vector<glm::dvec2> ratios(binding.joints.size(), glm::dvec2(0.0));
    for (std::uint32_t i = binding.firstInfluence[vertex]; i < binding.firstInfluence[vertex + 1];
         ++i) {
        const osgSkin::Influence& influence = binding.influences[i];
        ratios[influence.joint] = {influence.bend, influence.twist};
    }
    return ratios;
}

} // namespace

std::vector<WorstEdge> worstEdges(const Subject& subject, const std::vector<NamedPose>& poses) {
    std::map<compare::Edge, WorstEdge> found;
    const auto count =
        static_cast<std::size_t>(kShare * static_cast<double>(subject.edges.size())) + 1;
    for (const NamedPose& pose : poses) {
        const compare::Points posed = deform(subject, Method::Ours, pose.skinning);
        std::vector<std::pair<double, compare::Edge>> all;
        for (const compare::Edge& edge : subject.edges) {
            const double rest = glm::distance(subject.rest[edge[0]], subject.rest[edge[1]]);
            if (rest > 0.0)
                all.emplace_back(glm::distance(posed[edge[0]], posed[edge[1]]) / rest, edge);
        }
        const auto end = all.begin() + static_cast<std::ptrdiff_t>(std::min(count, all.size()));
        std::partial_sort(all.begin(), end, all.end(), std::greater<>());
        for (auto entry = all.begin(); entry != end; ++entry) {
            WorstEdge& worst = found[entry->second];
            worst.edge = entry->second;
            ++worst.poses;
            worst.excess += entry->first - 1.0;
            if (entry->first > worst.longest) {
                worst.longest = entry->first;
                worst.longestIn = pose.name;
            }
        }
    }
    std::vector<WorstEdge> result;
    result.reserve(found.size());
    for (const auto& [edge, worst] : found) result.push_back(worst);
    std::sort(result.begin(), result.end(),
              [](const WorstEdge& a, const WorstEdge& b) { return a.excess > b.excess; });
    return result;
}

std::string lineOf(const Subject& subject, const WorstEdge& worst) {
    const std::size_t a = worst.edge[0], b = worst.edge[1];
    const auto name = [&](std::size_t joint) { return subject.rig.joints[joint].name; };
    const glm::dvec3 middle = 0.5 * (subject.rest[a] + subject.rest[b]);
    std::string line =
        format("%6.2f in %2zu, %.2f in %s, %.3f long at (%.2f %.2f %.2f), ", worst.excess,
               worst.poses, worst.longest, worst.longestIn.c_str(),
               glm::distance(subject.rest[a], subject.rest[b]), middle.x, middle.y, middle.z);
    line += name(subject.dominantJoint(a)) + "-" + name(subject.dominantJoint(b)) + ", region " +
            name(subject.binding.regions[a]) + "-" + name(subject.binding.regions[b]) + ":";
    const std::vector<glm::dvec2> from = ratiosOf(subject.binding, a);
    const std::vector<glm::dvec2> to = ratiosOf(subject.binding, b);
    for (std::size_t j = 0; j < from.size(); ++j)
        if (std::abs(from[j].x - to[j].x) > 0.05 || std::abs(from[j].y - to[j].y) > 0.05)
            line += format(" %s %.2f/%.2f-%.2f/%.2f", name(j).c_str(), from[j].x, from[j].y,
                           to[j].x, to[j].y);
    return line;
}

} // namespace quality
