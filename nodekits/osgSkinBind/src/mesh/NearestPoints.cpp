// SPDX-License-Identifier: MIT
#include "mesh/NearestPoints.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cstddef>
#include <limits>
#include <utility>

namespace osgSkin {
namespace {

/// A k-d tree. The point in the middle of a range splits it in two, along the axis in which the
/// range is longest.
class PointTree {
public:
    PointTree(const std::vector<glm::dvec3>& points, std::vector<std::uint32_t> candidates)
        : _points(points), _order(std::move(candidates)), _axes(_order.size(), 0) {
        split(0, _order.size());
    }

    std::uint32_t nearest(const glm::dvec3& point) const {
        Ranked best(std::numeric_limits<double>::infinity(), 0);
        search(point, 0, _order.size(), best);
        return best.second;
    }

private:
    using Ranked = std::pair<double, std::uint32_t>; ///< squared distance, index

    void split(std::size_t first, std::size_t end) {
        if (end - first < 2) return;
        glm::dvec3 low = at(first), high = low;
        for (std::size_t i = first; i < end; ++i) {
            low = glm::min(low, at(i));
            high = glm::max(high, at(i));
        }
        const glm::dvec3 extent = high - low;
        const int axis = extent.x >= extent.y && extent.x >= extent.z ? 0
                         : extent.y >= extent.z                       ? 1
                                                                      : 2;
        const std::size_t middle = first + (end - first) / 2;
        const auto begin = _order.begin();
        std::nth_element(
            begin + static_cast<std::ptrdiff_t>(first), begin + static_cast<std::ptrdiff_t>(middle),
            begin + static_cast<std::ptrdiff_t>(end),
            [&](std::uint32_t a, std::uint32_t b) { return _points[a][axis] < _points[b][axis]; });
        _axes[middle] = axis;
        split(first, middle);
        split(middle + 1, end);
    }

    void search(const glm::dvec3& point, std::size_t first, std::size_t end, Ranked& best) const {
        if (first == end) return;
        const std::size_t middle = first + (end - first) / 2;
        const glm::dvec3 offset = at(middle) - point;
        best = std::min(best, Ranked(glm::dot(offset, offset), _order[middle]));
        const double beyond = offset[_axes[middle]]; // to the plane that splits the range
        const bool isBelow = beyond > 0.0;
        search(point, isBelow ? first : middle + 1, isBelow ? middle : end, best);
        if (beyond * beyond <= best.first) // equal: points there may be as near, with lower indices
            search(point, isBelow ? middle + 1 : first, isBelow ? end : middle, best);
    }

    const glm::dvec3& at(std::size_t place) const { return _points[_order[place]]; }

    const std::vector<glm::dvec3>& _points;
    std::vector<std::uint32_t> _order;
    std::vector<int> _axes; ///< of the middle of each range
};

} // namespace

std::vector<std::uint32_t> nearestPoints(const std::vector<glm::dvec3>& points,
                                         const std::vector<std::uint32_t>& candidates,
                                         const std::vector<std::uint32_t>& queries) {
    const PointTree tree(points, candidates);
    std::vector<std::uint32_t> result;
    result.reserve(queries.size());
    for (const std::uint32_t q : queries) result.push_back(tree.nearest(points[q]));
    return result;
}

} // namespace osgSkin
