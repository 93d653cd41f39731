// SPDX-License-Identifier: MIT
#include "NormalError.h"

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace quality {

NormalError normalError(const Subject& subject, const PosedSkin& posed) {
    std::vector<std::uint32_t> all(posed.points.size());
    std::iota(all.begin(), all.end(), 0u);
    return normalError(subject, posed, all);
}

NormalError normalError(const Subject& subject, const PosedSkin& posed,
                        const std::vector<std::uint32_t>& vertices) {
    const compare::Points shown = skinNormals(posed.points, subject.triangles);
    std::vector<double> angles;
    NormalError error;
    for (const std::uint32_t v : vertices) {
        if (shown[v] == glm::dvec3(0.0)) continue;
        const double cosine = glm::dot(shown[v], posed.normals[v]);
        const double sine = glm::length(glm::cross(shown[v], posed.normals[v]));
        angles.push_back(glm::degrees(std::atan2(sine, cosine)));
        error.mean += angles.back();
    }
    if (angles.empty()) return error;
    error.mean /= static_cast<double>(angles.size());
    const auto rank = static_cast<std::ptrdiff_t>(0.95 * static_cast<double>(angles.size()));
    std::nth_element(angles.begin(), angles.begin() + rank, angles.end());
    error.percentile95 = angles[static_cast<std::size_t>(rank)];
    return error;
}

} // namespace quality
