// SPDX-License-Identifier: GPL-3.0-or-later
#include "elastic/skin/RestSkin.h"

#include "elastic/skin/WindingTree.h"

#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Simple_cartesian.h>
#include <Eigen/Geometry>

#include <cmath>
#include <utility>

namespace osgSkin::elastic {
namespace {

using Cartesian = CGAL::Simple_cartesian<double>;
using Faces = std::vector<Cartesian::Triangle_3>;
using Primitive = CGAL::AABB_triangle_primitive<Cartesian, Faces::const_iterator>;
using AabbTree = CGAL::AABB_tree<CGAL::AABB_traits<Cartesian, Primitive>>;

Cartesian::Point_3 cgal(const Point& p) {
    return {p.x(), p.y(), p.z()};
}

/// Barycentric coordinates of a point in the triangle's plane, kept within the triangle.
Point sharesOf(const Point& p, const Point& a, const Point& b, const Point& c) {
    const Point normal = (b - a).cross(c - a);
    const double scale = 1.0 / normal.squaredNorm();
    Point shares(normal.dot((b - p).cross(c - p)) * scale, normal.dot((c - p).cross(a - p)) * scale,
                 0.0);
    shares.z() = 1.0 - shares.x() - shares.y();
    shares = shares.cwiseMax(0.0);
    return shares / shares.sum();
}

} // namespace

struct RestSkin::Tree {
    Faces faces;
    std::vector<std::uint32_t> triangleOf; ///< of each face
    AabbTree tree;
    WindingTree winding;

    Tree(const Points& positions, const Triangles& triangles) : winding(positions, triangles) {
        for (std::uint32_t t = 0; t < triangles.size(); ++t) {
            const auto& [a, b, c] = triangles[t];
            const Point one = positions.col(b) - positions.col(a);
            const Point other = positions.col(c) - positions.col(a);
            if (!(one.cross(other).norm() > 1e-9 * one.squaredNorm())) continue;
            faces.emplace_back(cgal(positions.col(a)), cgal(positions.col(b)),
                               cgal(positions.col(c)));
            triangleOf.push_back(t);
        }
        tree.rebuild(faces.cbegin(), faces.cend());
        tree.build(); // else the first question would, on whichever thread it comes
        tree.accelerate_distance_queries();
    }
};

RestSkin::RestSkin(Points positions, Triangles triangles)
    : _positions(std::move(positions)), _triangles(std::move(triangles)),
      _tree(std::make_unique<Tree>(_positions, _triangles)) {}

RestSkin::~RestSkin() = default;

double RestSkin::distance(const Point& point) const {
    return std::sqrt(_tree->tree.squared_distance(cgal(point)));
}

RestSkin::Nearest RestSkin::nearest(const Point& point) const {
    const auto [found, face] = _tree->tree.closest_point_and_primitive(cgal(point));
    Nearest result;
    result.triangle = _tree->triangleOf[static_cast<std::size_t>(face - _tree->faces.cbegin())];
    const auto& [a, b, c] = _triangles[result.triangle];
    const Point p(found.x(), found.y(), found.z());
    result.shares = sharesOf(p, _positions.col(a), _positions.col(b), _positions.col(c));
    result.distance = (p - point).norm();
    return result;
}

bool RestSkin::inside(const Point& point) const {
    return _tree->winding.inside(point);
}

double RestSkin::signedDistance(const Point& point) const {
    return inside(point) ? -distance(point) : distance(point);
}

} // namespace osgSkin::elastic
