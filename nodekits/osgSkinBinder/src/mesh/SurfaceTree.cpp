// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/SurfaceTree.h"

#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Simple_cartesian.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <limits>

namespace osgSkin {
namespace {

constexpr std::uint32_t kLeaf = 8;

/// A node counts as a dipole beyond this many times its reach: an error of 1 % of a winding.
constexpr double kFarFromSkin = 2.3;

constexpr double kSphere = 12.566370614359172;

using Kernel = CGAL::Simple_cartesian<double>;
using Faces = std::vector<Kernel::Triangle_3>;
using Primitive = CGAL::AABB_triangle_primitive<Kernel, Faces::const_iterator>;
using AabbTree = CGAL::AABB_tree<CGAL::AABB_traits<Kernel, Primitive>>;

Kernel::Point_3 toCgal(const glm::dvec3& p) {
    return {p.x, p.y, p.z};
}

glm::dvec3 toGlm(const Kernel::Point_3& p) {
    return {p.x(), p.y(), p.z()};
}

/// Barycentric coordinates of a point in the triangle's plane, clamped to the triangle.
glm::dvec3 sharesOf(const glm::dvec3& p, const glm::dvec3& a, const glm::dvec3& b,
                    const glm::dvec3& c) {
    const glm::dvec3 normal = glm::cross(b - a, c - a);
    const double scale = 1.0 / glm::dot(normal, normal);
    glm::dvec3 shares(glm::dot(normal, glm::cross(b - p, c - p)) * scale,
                      glm::dot(normal, glm::cross(c - p, a - p)) * scale, 0.0);
    shares.z = 1.0 - shares.x - shares.y;
    shares = glm::max(shares, glm::dvec3(0.0));
    return shares / (shares.x + shares.y + shares.z);
}

} // namespace

void AngleSum::addHalfSolidAngle(const Corner& a, const Corner& b, const Corner& c) {
    add(glm::dot(a.from, glm::cross(b.from, c.from)),
        a.distance * b.distance * c.distance + glm::dot(a.from, b.from) * c.distance +
            glm::dot(b.from, c.from) * a.distance + glm::dot(c.from, a.from) * b.distance);
}

WindingTree::WindingTree(const std::vector<glm::dvec3>& positions,
                         const std::vector<std::array<std::uint32_t, 3>>& triangles) {
    for (const auto& [a, b, c] : triangles)
        _corners.push_back({positions[a], positions[b], positions[c]});
    _nodes.emplace_back();
    _nodes[0].end = static_cast<std::uint32_t>(_corners.size());
    if (!_corners.empty()) split(0);
}

void WindingTree::split(std::uint32_t index) {
    measure(_nodes[index]);
    const std::uint32_t begin = _nodes[index].begin, end = _nodes[index].end;
    if (end - begin <= kLeaf) return;
    glm::dvec3 low(std::numeric_limits<double>::infinity()), high(-low);
    for (std::uint32_t i = begin; i < end; ++i)
        for (const glm::dvec3& corner : _corners[i]) {
            low = glm::min(low, corner);
            high = glm::max(high, corner);
        }
    const glm::dvec3 size = high - low;
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
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
    double area = 0.0;
    glm::dvec3 middle(0.0);
    for (std::uint32_t i = node.begin; i < node.end; ++i) {
        const auto& [a, b, c] = _corners[i];
        const glm::dvec3 vector = 0.5 * glm::cross(b - a, c - a);
        node.dipole += vector;
        area += glm::length(vector);
        node.centre += glm::length(vector) / 3.0 * (a + b + c);
        middle += (a + b + c) / 3.0;
    }
    node.centre = area > 0.0 ? node.centre / area : middle / double(node.end - node.begin);
    for (std::uint32_t i = node.begin; i < node.end; ++i)
        for (const glm::dvec3& corner : _corners[i])
            node.reach = std::max(node.reach, glm::distance(corner, node.centre));
}

double WindingTree::sum(std::uint32_t index, const glm::dvec3& point, AngleSum& halves) const {
    const Node& node = _nodes[index];
    const glm::dvec3 away = node.centre - point;
    const double distance = glm::length(away);
    if (distance > kFarFromSkin * node.reach)
        return glm::dot(node.dipole, away) / (distance * distance * distance);
    if (node.child != 0) return sum(node.child, point, halves) + sum(node.child + 1, point, halves);
    for (std::uint32_t i = node.begin; i < node.end; ++i) {
        AngleSum::Corner seen[3];
        for (std::size_t k = 0; k < 3; ++k)
            seen[k] = {_corners[i][k] - point, glm::distance(_corners[i][k], point)};
        halves.addHalfSolidAngle(seen[0], seen[1], seen[2]);
    }
    return 0.0;
}

double WindingTree::at(const glm::dvec3& point) const {
    if (_corners.empty()) return 0.0;
    AngleSum halves;
    const double far = sum(0, point, halves);
    return (far + 2.0 * halves.value()) / kSphere;
}

bool WindingTree::inside(const glm::dvec3& point) const {
    return std::abs(at(point)) > 0.5;
}

struct SurfaceTree::Tree {
    Faces faces;
    std::vector<std::uint32_t> triangleOf; ///< of each face
    AabbTree tree;
};

SurfaceTree::SurfaceTree(const std::vector<glm::dvec3>& positions,
                         const std::vector<std::array<std::uint32_t, 3>>& triangles) {
    auto made = std::make_unique<Tree>();
    for (std::uint32_t t = 0; t < triangles.size(); ++t) {
        const auto& [a, b, c] = triangles[t];
        const glm::dvec3 &p = positions[a], &q = positions[b], &r = positions[c];
        if (!(glm::length(glm::cross(q - p, r - p)) > 1e-9 * glm::dot(q - p, q - p))) continue;
        made->faces.emplace_back(toCgal(p), toCgal(q), toCgal(r));
        made->triangleOf.push_back(t);
    }
    if (!made->faces.empty()) {
        made->tree.rebuild(made->faces.cbegin(), made->faces.cend());
        made->tree.build(); // otherwise the first query would, on any thread
        made->tree.accelerate_distance_queries();
    }
    _tree = std::move(made);
}

SurfaceTree::~SurfaceTree() = default;

bool SurfaceTree::empty() const {
    return _tree->faces.empty();
}

SurfaceTree::Nearest SurfaceTree::nearest(const glm::dvec3& point) const {
    const auto [found, face] = _tree->tree.closest_point_and_primitive(toCgal(point));
    Nearest result;
    result.triangle = _tree->triangleOf[static_cast<std::size_t>(face - _tree->faces.cbegin())];
    result.position = toGlm(found);
    result.shares = sharesOf(result.position, toGlm(face->vertex(0)), toGlm(face->vertex(1)),
                             toGlm(face->vertex(2)));
    return result;
}

double SurfaceTree::distance(const glm::dvec3& point) const {
    return std::sqrt(_tree->tree.squared_distance(toCgal(point)));
}

double SurfaceTree::distanceToBox(const glm::dvec3& point) const {
    const CGAL::Bbox_3 box = _tree->tree.bbox();
    return glm::distance(point, glm::clamp(point, {box.xmin(), box.ymin(), box.zmin()},
                                           {box.xmax(), box.ymax(), box.zmax()}));
}

} // namespace osgSkin
