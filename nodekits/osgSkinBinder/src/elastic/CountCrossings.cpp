// SPDX-License-Identifier: GPL-3.0-or-later
#include "elastic/CountCrossings.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include <algorithm>
#include <array>
#include <vector>

namespace osgSkin::elastic {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Corners = std::array<std::uint32_t, 3>;

struct Box {
    Eigen::Array3d low, high;
    std::uint32_t triangle;
};

/// Moves the corners that `other` shares to the front; returns their number.
auto sharedFirst(Corners& triangle, const Corners& other) {
    return std::stable_partition(triangle.begin(), triangle.end(),
                                 [&](std::uint32_t corner) {
                                     return std::find(other.begin(), other.end(), corner) !=
                                            other.end();
                                 }) -
           triangle.begin();
}

bool cross(Corners a, Corners b, const std::vector<Kernel::Point_3>& points) {
    const auto shared = sharedFirst(a, b);
    if (shared > 1) return false;
    const auto triangle = [&](const Corners& t) {
        return Kernel::Triangle_3(points[t[0]], points[t[1]], points[t[2]]);
    };
    if (shared == 0) return CGAL::do_intersect(triangle(a), triangle(b));
    sharedFirst(b, a);
    return CGAL::do_intersect(triangle(a), Kernel::Segment_3(points[b[1]], points[b[2]])) ||
           CGAL::do_intersect(triangle(b), Kernel::Segment_3(points[a[1]], points[a[2]]));
}

} // namespace

std::size_t countCrossings(const RestSkin::Triangles& triangles, const Points& positions) {
    std::vector<Kernel::Point_3> points;
    for (Eigen::Index v = 0; v < positions.cols(); ++v)
        points.emplace_back(positions(0, v), positions(1, v), positions(2, v));
    std::vector<Box> boxes;
    for (std::uint32_t t = 0; t < triangles.size(); ++t) {
        const auto& [a, b, c] = triangles[t];
        const auto p = positions.col(a).array(), q = positions.col(b).array(),
                   r = positions.col(c).array();
        boxes.push_back({p.min(q).min(r), p.max(q).max(r), t});
    }
    std::sort(boxes.begin(), boxes.end(),
              [](const Box& a, const Box& b) { return a.low.y() < b.low.y(); });
    std::size_t count = 0;
    for (auto box = boxes.begin(); box != boxes.end(); ++box)
        for (auto next = box + 1; next != boxes.end() && next->low.y() <= box->high.y(); ++next)
            if ((next->low <= box->high).all() && (box->low <= next->high).all() &&
                cross(triangles[box->triangle], triangles[next->triangle], points))
                ++count;
    return count;
}

} // namespace osgSkin::elastic
