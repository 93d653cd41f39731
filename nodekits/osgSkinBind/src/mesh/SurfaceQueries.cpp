// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/SurfaceQueries.h"

#include "mesh/AngleSum.h"

#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Orthogonal_incremental_neighbor_search.h>
#include <CGAL/Search_traits_3.h>
#include <CGAL/Search_traits_adapter.h>
#include <CGAL/Simple_cartesian.h>
#include <CGAL/property_map.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace osgSkin {
namespace {

using Kernel = CGAL::Simple_cartesian<double>;
using Entry = std::pair<Kernel::Point_3, std::uint32_t>; // with its index
using Traits = CGAL::Search_traits_adapter<Entry, CGAL::First_of_pair_property_map<Entry>,
                                           CGAL::Search_traits_3<Kernel>>;
using Search = CGAL::Orthogonal_incremental_neighbor_search<Traits>;

using Faces = std::vector<Kernel::Triangle_3>;
using Primitive = CGAL::AABB_triangle_primitive<Kernel, Faces::const_iterator>;
using AabbTree = CGAL::AABB_tree<CGAL::AABB_traits<Kernel, Primitive>>;

/// CGAL visits neighbours by rounded distances. A neighbour that is farther by no more than this
/// factor may be equally near.
constexpr double kRounding = 1.0 + 1e-12;

/// Half of a full sphere's solid angle, minus a margin for rounding, and of a half sphere's.
constexpr double kAllAround = 6.28, kHalfAround = 3.141592653589793;

Kernel::Point_3 toCgal(const glm::dvec3& p) {
    return {p.x, p.y, p.z};
}

/// A vertex relative to the query point.
struct Seen {
    glm::dvec3 from;
    double away;
};

std::vector<Seen> seenFrom(const glm::dvec3& point, const WeldedMesh& mesh) {
    std::vector<Seen> seen;
    seen.reserve(mesh.positions.size());
    for (const glm::dvec3& p : mesh.positions) seen.push_back({p - point, glm::length(p - point)});
    return seen;
}

/// Adds half of a triangle's solid angle (van Oosterom and Strackee 1983).
void addAngle(const std::vector<Seen>& seen, const std::array<std::uint32_t, 3>& t,
              AngleSum& halves) {
    const Seen &a = seen[t[0]], &b = seen[t[1]], &c = seen[t[2]];
    const double numerator = glm::dot(a.from, glm::cross(b.from, c.from));
    const double denominator = a.away * b.away * c.away + glm::dot(a.from, b.from) * c.away +
                               glm::dot(b.from, c.from) * a.away +
                               glm::dot(c.from, a.from) * b.away;
    halves.add(numerator, denominator);
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

bool isInsideSkin(const WeldedMesh& mesh, const glm::dvec3& point) {
    const std::vector<Seen> seen = seenFrom(point, mesh);
    AngleSum halves;
    for (const auto& t : mesh.triangles) addAngle(seen, t, halves);
    return std::abs(halves.value()) > kHalfAround;
}

std::vector<std::uint32_t> shellsAround(const WeldedMesh& mesh, const glm::dvec3& point,
                                        bool onlyClosed) {
    const std::vector<Seen> seen = seenFrom(point, mesh);
    std::vector<AngleSum> halves(mesh.shells);
    for (const auto& t : mesh.triangles) addAngle(seen, t, halves[mesh.shellOf[t[0]]]);
    std::vector<std::uint32_t> result;
    for (std::uint32_t shell = 0; shell < mesh.shells; ++shell)
        if (std::abs(halves[shell].value()) > (onlyClosed ? kAllAround : kHalfAround))
            result.push_back(shell);
    return result;
}

std::vector<std::uint32_t> nearestPoints(const std::vector<glm::dvec3>& points,
                                         const std::vector<std::uint32_t>& candidates,
                                         const std::vector<std::uint32_t>& queries) {
    std::vector<Entry> entries;
    entries.reserve(candidates.size());
    for (const std::uint32_t c : candidates) entries.emplace_back(toCgal(points[c]), c);
    const Search::Tree tree(entries.begin(), entries.end());

    std::vector<std::uint32_t> result;
    result.reserve(queries.size());
    for (const std::uint32_t q : queries) {
        const Search search(tree, toCgal(points[q]));
        const auto rank = [&](std::uint32_t c) {
            const glm::dvec3 d = points[c] - points[q];
            return std::pair(glm::dot(d, d), c);
        };
        std::pair best = rank(search.begin()->first.second);
        for (auto found = search.begin();
             found != search.end() && found->second <= kRounding * best.first; ++found)
            best = std::min(best, rank(found->first.second));
        result.push_back(best.second);
    }
    return result;
}

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
        _tree->faces.emplace_back(toCgal(p), toCgal(q), toCgal(r));
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
    const auto [found, face] = _tree->tree.closest_point_and_primitive(toCgal(point));
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
