// SPDX-License-Identifier: MIT
#include "SkinMeasures.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace compare {
namespace {

double distance(const glm::dvec3& point, const Segment& bone) {
    const glm::dvec3 along = bone.to - bone.from;
    const double square = glm::dot(along, along);
    const double t =
        square > 0.0 ? std::clamp(glm::dot(point - bone.from, along) / square, 0.0, 1.0) : 0.0;
    return glm::distance(point, bone.from + t * along);
}

double distance(const glm::dvec3& point, const std::vector<Segment>& bones) {
    double least = std::numeric_limits<double>::infinity();
    for (const Segment& bone : bones) least = std::min(least, distance(point, bone));
    return least;
}

} // namespace

double enclosedVolume(const Points& points, const std::vector<std::uint32_t>& triangles) {
    double sum = 0.0;
    for (std::size_t t = 0; t + 2 < triangles.size(); t += 3)
        sum += glm::dot(points[triangles[t]],
                        glm::cross(points[triangles[t + 1]], points[triangles[t + 2]]));
    return sum / 6.0;
}

double loopArea(const Points& points, const std::vector<std::uint32_t>& loop) {
    if (loop.empty()) return 0.0;
    // Measured from a vertex of the loop, not from the origin, to keep the digits.
    const glm::dvec3 origin = points[loop.front()];
    glm::dvec3 sum(0.0);
    for (std::size_t i = 0; i < loop.size(); ++i)
        sum += glm::cross(points[loop[i]] - origin, points[loop[(i + 1) % loop.size()]] - origin);
    return 0.5 * glm::length(sum);
}

std::vector<Edge> faceEdges(const std::vector<std::uint32_t>& sizes,
                            const std::vector<std::uint32_t>& vertices) {
    std::vector<Edge> edges;
    std::size_t corner = 0;
    for (const std::uint32_t size : sizes) {
        for (std::uint32_t k = 0; k < size; ++k) {
            const std::uint32_t a = vertices[corner + k];
            const std::uint32_t b = vertices[corner + (k + 1) % size];
            edges.push_back({std::min(a, b), std::max(a, b)});
        }
        corner += size;
    }
    std::sort(edges.begin(), edges.end());
    edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
    return edges;
}

EdgeStrain edgeStrain(const Points& rest, const Points& posed, const std::vector<Edge>& edges) {
    std::vector<double> ratios;
    double squares = 0.0;
    for (const Edge& edge : edges) {
        const double length = glm::distance(rest[edge[0]], rest[edge[1]]);
        if (!(length > 0.0)) continue;
        ratios.push_back(glm::distance(posed[edge[0]], posed[edge[1]]) / length);
        squares += (ratios.back() - 1.0) * (ratios.back() - 1.0);
    }
    if (ratios.empty()) return {0.0, 1.0, 1.0};
    std::sort(ratios.begin(), ratios.end());
    const auto count = static_cast<double>(ratios.size());
    const auto rank = static_cast<std::size_t>(std::ceil(0.999 * count)) - 1; // nearest rank
    return {std::sqrt(squares / count), ratios[rank], ratios.back()};
}

double bulge(const Points& rest, const Points& posed, const std::vector<std::uint32_t>& vertices,
             const std::vector<Segment>& restBones, const std::vector<Segment>& posedBones) {
    double largest = 0.0;
    for (const std::uint32_t v : vertices) {
        const double before = distance(rest[v], restBones);
        if (before > 0.0) largest = std::max(largest, distance(posed[v], posedBones) / before);
    }
    return largest;
}

} // namespace compare
