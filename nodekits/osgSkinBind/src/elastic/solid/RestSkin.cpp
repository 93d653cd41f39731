// SPDX-License-Identifier: GPL-3.0-or-later
#include "elastic/solid/RestSkin.h"

#include <glm/geometric.hpp>

#include <utility>

namespace osgSkin::elastic {
namespace {

glm::dvec3 toGlm(const Point& p) {
    return {p.x(), p.y(), p.z()};
}

std::vector<glm::dvec3> toGlm(const Points& points) {
    std::vector<glm::dvec3> result;
    for (Eigen::Index v = 0; v < points.cols(); ++v) result.push_back(toGlm(Point(points.col(v))));
    return result;
}

} // namespace

RestSkin::RestSkin(Points positions, Triangles triangles)
    : RestSkin(positions, std::move(triangles), toGlm(positions)) {}

RestSkin::RestSkin(Points positions, Triangles triangles, const std::vector<glm::dvec3>& corners)
    : _positions(std::move(positions)), _triangles(std::move(triangles)),
      _tree(corners, _triangles), _winding(corners, _triangles) {}

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
