// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <osgSkinRig/SkinMesh>

#include <glm/geometric.hpp>

#include <algorithm>
#include <cstdint>
#include <vector>

/// l'/l of each edge, ascending.
inline std::vector<double> stretches(const osgSkin::SkinMesh& rest,
                                     const osgSkin::SkinMesh& posed) {
    std::vector<double> result;
    const std::vector<std::uint32_t> corners = rest.triangles();
    for (std::size_t t = 0; t < corners.size(); ++t) {
        const std::uint32_t a = corners[t], b = corners[t % 3 == 2 ? t - 2 : t + 1];
        const double length = glm::distance(rest.positions[a], rest.positions[b]);
        if (a < b && length > 0.0)
            result.push_back(glm::distance(posed.positions[a], posed.positions[b]) / length);
    }
    std::sort(result.begin(), result.end());
    return result;
}

inline double percentile999(const std::vector<double>& sorted) {
    return sorted[static_cast<std::size_t>(0.999 * static_cast<double>(sorted.size()))];
}
