// SPDX-License-Identifier: GPL-3.0-or-later
#include "SampledSurface.h"

#include "Subject.h"

#include <CGAL/Orthogonal_k_neighbor_search.h>
#include <CGAL/Search_traits_3.h>
#include <CGAL/Search_traits_adapter.h>
#include <CGAL/Simple_cartesian.h>
#include <CGAL/property_map.h>
#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>

#include <algorithm>
#include <cmath>
#include <unordered_map>
#include <utility>

namespace quality {
namespace {

using Kernel = CGAL::Simple_cartesian<double>;
using Entry = std::pair<Kernel::Point_3, std::size_t>;
using Traits = CGAL::Search_traits_adapter<Entry, CGAL::First_of_pair_property_map<Entry>,
                                           CGAL::Search_traits_3<Kernel>>;
using Search = CGAL::Orthogonal_k_neighbor_search<Traits>;

constexpr int kParts = 4;               ///< of each edge; a triangle has the square of this
constexpr unsigned int kCandidates = 8; ///< nearest samples, of which one must face the right way
constexpr double kSampleReach = 0.004;  ///< a sample stands for the surface within this distance
constexpr int kViews = 16;
constexpr double kPixel = 0.008;
constexpr double kSeenShare = 0.4; ///< of the views, for all of the visibility

Kernel::Point_3 toCgal(const glm::dvec3& p) {
    return {p.x, p.y, p.z};
}

/// A direction of kViews that are spread evenly.
glm::dvec3 viewDirection(int view) {
    const double turn = glm::pi<double>() * (1.0 + std::sqrt(5.0)) * (view + 0.5);
    const double z = 1.0 - 2.0 * (view + 0.5) / kViews, radius = std::sqrt(1.0 - z * z);
    return {radius * std::cos(turn), radius * std::sin(turn), z};
}

} // namespace

struct SampledSurface::Tree {
    CGAL::Kd_tree<Traits> tree;
};

SampledSurface::SampledSurface(const compare::Points& points,
                               const std::vector<std::uint32_t>& triangles)
    : _tree(std::make_unique<Tree>()) {
    const compare::Points normals = skinNormals(points, triangles);
    std::vector<glm::dvec3> shares; // the middles of the parts of a triangle
    for (int i = 0; i < kParts; ++i)
        for (int j = 0; i + j < kParts; ++j)
            for (const double middle : {1.0 / 3.0, 2.0 / 3.0}) {
                const double u = (i + middle) / kParts, v = (j + middle) / kParts;
                if (u + v < 1.0) shares.emplace_back(u, v, 1.0 - u - v);
            }
    for (std::size_t t = 0; t + 2 < triangles.size(); t += 3)
        for (const glm::dvec3& share : shares) {
            glm::dvec3 flat(0.0), normal(0.0), move(0.0);
            for (int k = 0; k < 3; ++k) {
                flat += share[k] * points[triangles[t + static_cast<std::size_t>(k)]];
                normal += share[k] * normals[triangles[t + static_cast<std::size_t>(k)]];
            }
            for (int k = 0; k < 3; ++k) {
                const std::uint32_t corner = triangles[t + static_cast<std::size_t>(k)];
                move +=
                    share[k] * glm::dot(points[corner] - flat, normals[corner]) * normals[corner];
            }
            _samples.push_back(flat + 0.5 * move);
            _normals.push_back(normal / std::max(glm::length(normal), 1e-12));
        }
    for (std::size_t i = 0; i < _samples.size(); ++i) _tree->tree.insert({toCgal(_samples[i]), i});
    _tree->tree.build();
}

SampledSurface::SampledSurface(SampledSurface&&) noexcept = default;
SampledSurface::~SampledSurface() = default;

SampledSurface::Nearest SampledSurface::nearest(const glm::dvec3& point,
                                                const glm::dvec3& normal) const {
    const Search search(_tree->tree, toCgal(point), kCandidates);
    std::size_t found = search.begin()->first.second;
    for (const auto& [entry, squared] : search)
        if (glm::dot(_normals[entry.second], normal) > 0.0) {
            found = entry.second;
            break;
        }
    const glm::dvec3 from = point - _samples[found];
    const double height = glm::dot(from, _normals[found]);
    // Beside the sample's part, as at an open edge, the whole distance counts.
    const double beside = glm::length(from - height * _normals[found]) - kSampleReach;
    const double distance = std::hypot(height, std::max(beside, 0.0));
    return {std::copysign(distance, height), point - height * _normals[found], _normals[found]};
}

std::vector<double> SampledSurface::visibility(const compare::Points& points) const {
    std::vector<double> seen(points.size(), 0.0);
    for (int view = 0; view < kViews; ++view) {
        const glm::dvec3 towards = viewDirection(view);
        const glm::dvec3 other =
            std::abs(towards.x) < 0.8 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
        const glm::dvec3 across = glm::normalize(glm::cross(towards, other));
        const glm::dvec3 up = glm::cross(towards, across);
        const auto pixelOf = [&](const glm::dvec3& p) {
            return (std::int64_t(std::lround(glm::dot(p, across) / kPixel)) << 32) +
                   std::lround(glm::dot(p, up) / kPixel);
        };
        std::unordered_map<std::int64_t, double> depths;
        for (std::size_t i = 0; i < _samples.size(); ++i) {
            if (glm::dot(_normals[i], towards) < 0.1) continue;
            const double depth = glm::dot(_samples[i], towards);
            const auto [at, isNew] = depths.try_emplace(pixelOf(_samples[i]), depth);
            at->second = std::max(at->second, depth);
        }
        for (std::size_t i = 0; i < points.size(); ++i) {
            const auto at = depths.find(pixelOf(points[i]));
            const bool isHidden =
                at != depths.end() && at->second > glm::dot(points[i], towards) + kPixel;
            if (!isHidden) seen[i] += 1.0 / (kSeenShare * kViews);
        }
    }
    for (double& share : seen) share = std::min(share, 1.0);
    return seen;
}

std::vector<double> vertexAreas(const compare::Points& points,
                                const std::vector<std::uint32_t>& triangles) {
    std::vector<double> areas(points.size(), 0.0);
    for (std::size_t t = 0; t + 2 < triangles.size(); t += 3) {
        const glm::dvec3& a = points[triangles[t]];
        const double area =
            glm::length(glm::cross(points[triangles[t + 1]] - a, points[triangles[t + 2]] - a)) /
            6.0;
        for (std::size_t k = 0; k < 3; ++k) areas[triangles[t + k]] += area;
    }
    return areas;
}

} // namespace quality
