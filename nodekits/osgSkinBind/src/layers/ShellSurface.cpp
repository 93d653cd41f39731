// SPDX-License-Identifier: GPL-3.0-or-later
#include "layers/ShellSurface.h"

#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Simple_cartesian.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <limits>

namespace osgSkin {
namespace {

using Cartesian = CGAL::Simple_cartesian<double>;
using Faces = std::vector<Cartesian::Triangle_3>;
using Primitive = CGAL::AABB_triangle_primitive<Cartesian, Faces::const_iterator>;
using AabbTree = CGAL::AABB_tree<CGAL::AABB_traits<Cartesian, Primitive>>;

Cartesian::Point_3 cgal(const glm::dvec3& p) {
    return {p.x, p.y, p.z};
}

/// Barycentric coordinates of a point in the triangle's plane, kept within the triangle.
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

struct ShellSurface::Tree {
    Faces faces;
    std::vector<std::uint32_t> triangleOf; ///< of each face
    glm::dvec3 low{std::numeric_limits<double>::infinity()}, high{-low};
    AabbTree tree;
};

ShellSurface::ShellSurface(const WeldedMesh& mesh, std::uint32_t shell)
    : _mesh(mesh), _tree(std::make_unique<Tree>()) {
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
        if (mesh.shellOf[mesh.triangles[t][0]] != shell) continue;
        const auto& [a, b, c] = mesh.triangles[t];
        const glm::dvec3 &p = mesh.positions[a], &q = mesh.positions[b], &r = mesh.positions[c];
        if (!(glm::length(glm::cross(q - p, r - p)) > 1e-9 * glm::dot(q - p, q - p))) continue;
        _tree->faces.emplace_back(cgal(p), cgal(q), cgal(r));
        _tree->triangleOf.push_back(t);
        _tree->low = glm::min(_tree->low, glm::min(p, glm::min(q, r)));
        _tree->high = glm::max(_tree->high, glm::max(p, glm::max(q, r)));
    }
    if (_tree->faces.empty()) return;
    _tree->tree.rebuild(_tree->faces.cbegin(), _tree->faces.cend());
    _tree->tree.accelerate_distance_queries();
}

ShellSurface::~ShellSurface() = default;

std::optional<SurfacePoint> ShellSurface::nearest(const glm::dvec3& point, double reach) const {
    if (_tree->faces.empty()) return std::nullopt;
    const glm::dvec3 toBox = glm::clamp(point, _tree->low, _tree->high) - point;
    if (glm::length(toBox) > reach) return std::nullopt;
    const auto [found, face] = _tree->tree.closest_point_and_primitive(cgal(point));
    SurfacePoint result;
    result.position = {found.x(), found.y(), found.z()};
    if (glm::distance(result.position, point) > reach) return std::nullopt;
    result.corners =
        _mesh.triangles[_tree->triangleOf[static_cast<std::size_t>(face - _tree->faces.cbegin())]];
    const auto& [a, b, c] = result.corners;
    result.shares =
        sharesOf(result.position, _mesh.positions[a], _mesh.positions[b], _mesh.positions[c]);
    const glm::dvec3 normal = result.shares.x * _mesh.normals[a] +
                              result.shares.y * _mesh.normals[b] +
                              result.shares.z * _mesh.normals[c];
    if (const double length = glm::length(normal); length > 1e-9) result.normal = normal / length;
    return result;
}

} // namespace osgSkin
