// SPDX-License-Identifier: GPL-3.0-or-later
#include "elastic/solid/RestSkin.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cstdint>
#include <utility>

namespace osgSkin::elastic {
namespace {

std::vector<glm::dvec3> cornersOf(const Points& points) {
    std::vector<glm::dvec3> result;
    for (Eigen::Index v = 0; v < points.cols(); ++v) result.push_back(toGlm(Point(points.col(v))));
    return result;
}

/// Each edge adds a number of its own, with the sign of its direction.
bool areClosed(const RestSkin::Triangles& triangles) {
    std::uint64_t sum = 0;
    for (const auto& t : triangles)
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint64_t from = t[k], to = t[(k + 1) % 3];
            std::uint64_t mixed = std::min(from, to) << 32 | std::max(from, to); // splitmix64
            mixed = (mixed ^ mixed >> 30) * 0xbf58476d1ce4e5b9u;
            mixed = (mixed ^ mixed >> 27) * 0x94d049bb133111ebu;
            mixed ^= mixed >> 31;
            sum += from < to ? mixed : from > to ? 0 - mixed : 0;
        }
    return sum == 0;
}

} // namespace

RestSkin::RestSkin(Points positions, Triangles triangles)
    : RestSkin(positions, std::move(triangles), cornersOf(positions)) {}

RestSkin::RestSkin(Points positions, Triangles triangles, const std::vector<glm::dvec3>& corners)
    : _positions(std::move(positions)), _triangles(std::move(triangles)),
      _tree(corners, _triangles), _winding(corners, _triangles), _isClosed(areClosed(_triangles)) {}

double RestSkin::distance(const Point& point) const {
    return _tree.distance(toGlm(point));
}

RestSkin::Nearest RestSkin::nearest(const Point& point) const {
    const SurfaceTree::Nearest found = _tree.nearest(toGlm(point));
    return {found.triangle,
            {found.shares.x, found.shares.y, found.shares.z},
            glm::distance(found.position, toGlm(point))};
}

bool RestSkin::inside(const Point& point) const {
    return _winding.inside(toGlm(point));
}

double RestSkin::signedDistance(const Point& point) const {
    return inside(point) ? -distance(point) : distance(point);
}

} // namespace osgSkin::elastic
