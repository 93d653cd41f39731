// SPDX-License-Identifier: GPL-3.0-or-later
#include "elastic/solid/RestSkin.h"

#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Simple_cartesian.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

namespace osgSkin::elastic {
namespace {

constexpr std::uint32_t kLeaf = 8;

/// A node counts as a dipole beyond this many times its reach: an error of 1 % of a winding.
constexpr double kFarFromSkin = 2.3;

constexpr double kSphere = 12.566370614359172;

/// Adds half a triangle's signed solid angle (van Oosterom & Strackee 1983).
void addSolidAngle(const Point& a, const Point& b, const Point& c, AngleSum& halves) {
    const double la = a.norm(), lb = b.norm(), lc = c.norm();
    halves.add(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
}

using Cartesian = CGAL::Simple_cartesian<double>;
using Faces = std::vector<Cartesian::Triangle_3>;
using Primitive = CGAL::AABB_triangle_primitive<Cartesian, Faces::const_iterator>;
using AabbTree = CGAL::AABB_tree<CGAL::AABB_traits<Cartesian, Primitive>>;

Cartesian::Point_3 cgal(const Point& p) {
    return {p.x(), p.y(), p.z()};
}

/// Barycentric coordinates of a point in the triangle's plane, clamped to the triangle.
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

WindingTree::WindingTree(const Points& positions,
                         const std::vector<std::array<std::uint32_t, 3>>& triangles) {
    for (const auto& t : triangles)
        _corners.push_back({positions.col(t[0]), positions.col(t[1]), positions.col(t[2])});
    _nodes.emplace_back();
    _nodes[0].end = static_cast<std::uint32_t>(_corners.size());
    if (!_corners.empty()) split(0);
}

void WindingTree::split(std::uint32_t index) {
    measure(_nodes[index]);
    const std::uint32_t begin = _nodes[index].begin, end = _nodes[index].end;
    if (end - begin <= kLeaf) return;
    Eigen::AlignedBox3d box;
    for (std::uint32_t i = begin; i < end; ++i)
        box.extend(_corners[i][0]).extend(_corners[i][1]).extend(_corners[i][2]);
    Eigen::Index axis = 0;
    box.sizes().maxCoeff(&axis);
    const std::uint32_t middle = begin + (end - begin) / 2;
    const auto along = [axis](const Corners& t) { return t[0][axis] + t[1][axis] + t[2][axis]; };
    std::nth_element(_corners.begin() + begin, _corners.begin() + middle, _corners.begin() + end,
                     [&](const Corners& a, const Corners& b) { return along(a) < along(b); });
    const auto child = static_cast<std::uint32_t>(_nodes.size());
    _nodes.resize(_nodes.size() + 2);
    _nodes[index].child = child;
    _nodes[child].begin = begin;
    _nodes[child].end = _nodes[child + 1].begin = middle;
    _nodes[child + 1].end = end;
    split(child);
    split(child + 1);
}

void WindingTree::measure(Node& node) const {
    node.centre.setZero();
    node.dipole.setZero();
    double area = 0.0;
    Point middle = Point::Zero();
    for (std::uint32_t i = node.begin; i < node.end; ++i) {
        const auto& [a, b, c] = _corners[i];
        const Point vector = 0.5 * (b - a).cross(c - a);
        node.dipole += vector;
        area += vector.norm();
        node.centre += vector.norm() / 3.0 * (a + b + c);
        middle += (a + b + c) / 3.0;
    }
    node.centre = area > 0.0 ? Point(node.centre / area) : Point(middle / (node.end - node.begin));
    for (std::uint32_t i = node.begin; i < node.end; ++i)
        for (const Point& corner : _corners[i])
            node.reach = std::max(node.reach, (corner - node.centre).norm());
}

double WindingTree::sum(std::uint32_t index, const Point& point, AngleSum& halves) const {
    const Node& node = _nodes[index];
    const Point away = node.centre - point;
    const double distance = away.norm();
    if (distance > kFarFromSkin * node.reach)
        return node.dipole.dot(away) / (distance * distance * distance);
    if (node.child != 0) return sum(node.child, point, halves) + sum(node.child + 1, point, halves);
    for (std::uint32_t i = node.begin; i < node.end; ++i)
        addSolidAngle(_corners[i][0] - point, _corners[i][1] - point, _corners[i][2] - point,
                      halves);
    return 0.0;
}

double WindingTree::at(const Point& point) const {
    if (_corners.empty()) return 0.0;
    AngleSum halves;
    const double far = sum(0, point, halves);
    return (far + 2.0 * halves.value()) / kSphere;
}

bool WindingTree::inside(const Point& point) const {
    return std::abs(at(point)) > 0.5;
}

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
        tree.build(); // otherwise the first query would, on any thread
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
