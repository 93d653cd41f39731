// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/NearestPoint.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <limits>
#include <utility>

namespace osgSkin {

NearestPoint::NearestPoint(const std::vector<glm::dvec3>& points,
                           std::vector<std::uint32_t> candidates)
    : _points(points), _order(std::move(candidates)) {
    build(0, _order.size(), 0);
}

void NearestPoint::build(std::size_t begin, std::size_t end, int axis) {
    if (end - begin < 2) return;
    const std::size_t middle = begin + (end - begin) / 2;
    const auto at = [&](std::size_t i) { return _order.begin() + static_cast<std::ptrdiff_t>(i); };
    std::nth_element(at(begin), at(middle), at(end), [&](std::uint32_t a, std::uint32_t b) {
        const double pa = _points[a][axis], pb = _points[b][axis];
        return pa < pb || (pa == pb && a < b);
    });
    build(begin, middle, (axis + 1) % 3);
    build(middle + 1, end, (axis + 1) % 3);
}

std::uint32_t NearestPoint::find(const glm::dvec3& p) const {
    std::uint32_t best = _order.front();
    double bestSquared = std::numeric_limits<double>::infinity();
    search(0, _order.size(), 0, p, best, bestSquared);
    return best;
}

void NearestPoint::search(std::size_t begin, std::size_t end, int axis, const glm::dvec3& p,
                          std::uint32_t& best, double& bestSquared) const {
    if (begin == end) return;
    const std::size_t middle = begin + (end - begin) / 2;
    const std::uint32_t index = _order[middle];
    const glm::dvec3 d = _points[index] - p;
    const double squared = glm::dot(d, d);
    if (squared < bestSquared || (squared == bestSquared && index < best)) {
        best = index;
        bestSquared = squared;
    }
    const double toPlane = p[axis] - _points[index][axis];
    const int next = (axis + 1) % 3;
    const bool below = toPlane < 0.0;
    search(below ? begin : middle + 1, below ? middle : end, next, p, best, bestSquared);
    if (toPlane * toPlane <= bestSquared)
        search(below ? middle + 1 : begin, below ? end : middle, next, p, best, bestSquared);
}

} // namespace osgSkin
