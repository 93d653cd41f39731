// SPDX-License-Identifier: GPL-3.0-or-later
#include "fit/solid/SurfaceNet.h"

#include <glm/common.hpp>

#include <cstdint>

namespace osgSkin::fit {

SurfaceNet::SurfaceNet(const SolidGrid& grid) {
    const glm::ivec3 size = grid.size();
    const auto index = [&size](const glm::ivec3& c) {
        return (static_cast<std::size_t>(c.z) * static_cast<std::size_t>(size.y) +
                static_cast<std::size_t>(c.y)) *
                   static_cast<std::size_t>(size.x) +
               static_cast<std::size_t>(c.x);
    };
    constexpr std::uint32_t kNone = 0xffffffffu;
    std::vector<std::uint32_t> vertexOf(index({0, 0, size.z}), kNone);
    // The vertex between a cube and the seven beyond it.
    const auto vertex = [&](const glm::ivec3& c) {
        std::uint32_t& v = vertexOf[index(c)];
        if (v == kNone) {
            v = static_cast<std::uint32_t>(points.size());
            points.push_back(grid.centre(glm::dvec3(c) + 0.5));
        }
        return static_cast<std::size_t>(v);
    };
    const glm::ivec3 unit[] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    for (int z = 1; z + 1 < size.z; ++z)
        for (int y = 1; y + 1 < size.y; ++y)
            for (int x = 1; x + 1 < size.x; ++x)
                for (int axis = 0; axis < 3; ++axis) {
                    const glm::ivec3 c(x, y, z);
                    const bool in = grid.solid(c);
                    if (in == grid.solid(c + unit[axis])) continue;
                    const glm::ivec3 u = unit[(axis + 1) % 3], v = unit[(axis + 2) % 3];
                    std::array<std::size_t, 4> quad{vertex(c - u - v), vertex(c - v), vertex(c),
                                                    vertex(c - u)};
                    if (!in) std::swap(quad[1], quad[3]);
                    triangles.push_back({quad[0], quad[1], quad[2]});
                    triangles.push_back({quad[0], quad[2], quad[3]});
                }
    relax(0.5 * grid.edge());
}

void SurfaceNet::relax(double reach) {
    constexpr int kSteps = 8;
    const std::vector<glm::dvec3> start = points;
    std::vector<glm::dvec3> sum(points.size());
    std::vector<double> count(points.size());
    for (int step = 0; step < kSteps; ++step) {
        sum.assign(points.size(), glm::dvec3(0.0));
        count.assign(points.size(), 0.0);
        for (const auto& t : triangles)
            for (std::size_t k = 0; k < 3; ++k) {
                sum[t[k]] += points[t[(k + 1) % 3]];
                count[t[k]] += 1.0;
            }
        for (std::size_t p = 0; p < points.size(); ++p)
            points[p] = glm::clamp(sum[p] / count[p], start[p] - reach, start[p] + reach);
    }
}

} // namespace osgSkin::fit
