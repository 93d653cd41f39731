// SPDX-License-Identifier: MIT
#include "CutSkin.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <limits>
#include <map>

namespace quality {
namespace {

using compare::Edge;

/// For each cut edge the one that the cut leads on to. A triangle's cut leads from the edge where
/// it goes below the plane to the edge where it comes up, so on a closed skin each has one.
std::map<Edge, Edge> cuts(const Subject& subject, const std::vector<double>& height) {
    std::map<Edge, Edge> next;
    for (std::size_t t = 0; t + 2 < subject.triangles.size(); t += 3) {
        Edge down{}, up{};
        bool cut = false;
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t a = subject.triangles[t + k];
            const std::uint32_t b = subject.triangles[t + (k + 1) % 3];
            if ((height[a] >= 0.0) == (height[b] >= 0.0)) continue;
            (height[a] >= 0.0 ? down : up) = {std::min(a, b), std::max(a, b)};
            cut = true;
        }
        if (cut) next[down] = up;
    }
    return next;
}

/// Takes the loop that begins at the first edge out of `next`; empty where it does not close.
std::vector<Edge> takeLoop(std::map<Edge, Edge>& next) {
    const Edge start = next.begin()->first;
    std::vector<Edge> loop;
    for (Edge edge = start; loop.empty() || edge != start;) {
        loop.push_back(edge);
        const auto found = next.find(edge);
        if (found == next.end()) return {}; // an open skin
        edge = found->second;
        next.erase(found);
    }
    return loop;
}

} // namespace

std::vector<EdgePoint> crossSection(const Subject& subject, const glm::dvec3& centre,
                                    const glm::dvec3& normal) {
    std::vector<double> height;
    for (const glm::dvec3& p : subject.rest) height.push_back(glm::dot(p - centre, normal));
    std::map<Edge, Edge> next = cuts(subject, height);
    std::vector<EdgePoint> result;
    double nearest = std::numeric_limits<double>::infinity();
    while (!next.empty()) {
        std::vector<EdgePoint> points;
        glm::dvec3 middle(0.0);
        for (const Edge& edge : takeLoop(next)) {
            const double share = height[edge[0]] / (height[edge[0]] - height[edge[1]]);
            points.push_back({edge[0], edge[1], share});
            middle += glm::mix(subject.rest[edge[0]], subject.rest[edge[1]], share);
        }
        if (points.size() < 3) continue;
        const double distance = glm::distance(middle / static_cast<double>(points.size()), centre);
        if (distance >= nearest) continue;
        nearest = distance;
        result = points;
    }
    return result;
}

} // namespace quality
