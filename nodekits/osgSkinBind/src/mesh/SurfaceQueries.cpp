// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/SurfaceQueries.h"

#include "mesh/SurfaceTree.h"

#include <CGAL/Orthogonal_incremental_neighbor_search.h>
#include <CGAL/Search_traits_3.h>
#include <CGAL/Search_traits_adapter.h>
#include <CGAL/Simple_cartesian.h>
#include <CGAL/property_map.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace osgSkin {
namespace {

using Kernel = CGAL::Simple_cartesian<double>;
using Entry = std::pair<Kernel::Point_3, std::uint32_t>; // with its index
using Traits = CGAL::Search_traits_adapter<Entry, CGAL::First_of_pair_property_map<Entry>,
                                           CGAL::Search_traits_3<Kernel>>;
using Search = CGAL::Orthogonal_incremental_neighbor_search<Traits>;

/// CGAL visits neighbours by rounded distances. A neighbour that is farther by no more than this
/// factor may be equally near.
constexpr double kRounding = 1.0 + 1e-12;

/// Half of a full sphere's solid angle, minus a margin for rounding, and of a half sphere's.
constexpr double kAllAround = 6.28, kHalfAround = 3.141592653589793;

Kernel::Point_3 toCgal(const glm::dvec3& p) {
    return {p.x, p.y, p.z};
}

std::vector<AngleSum::Corner> seenFrom(const glm::dvec3& point, const WeldedMesh& mesh) {
    std::vector<AngleSum::Corner> seen;
    seen.reserve(mesh.positions.size());
    for (const glm::dvec3& p : mesh.positions) seen.push_back({p - point, glm::length(p - point)});
    return seen;
}

std::vector<std::array<std::uint32_t, 3>> trianglesOf(const WeldedMesh& mesh, std::uint32_t shell) {
    std::vector<std::array<std::uint32_t, 3>> result;
    for (const auto& t : mesh.triangles)
        if (mesh.shellOf[t[0]] == shell) result.push_back(t);
    return result;
}

} // namespace

bool isInsideSkin(const WeldedMesh& mesh, const glm::dvec3& point) {
    const std::vector<AngleSum::Corner> seen = seenFrom(point, mesh);
    AngleSum halves;
    for (const auto& t : mesh.triangles)
        halves.addHalfSolidAngle(seen[t[0]], seen[t[1]], seen[t[2]]);
    return std::abs(halves.value()) > kHalfAround;
}

std::vector<std::uint32_t> shellsAround(const WeldedMesh& mesh, const glm::dvec3& point,
                                        bool onlyClosed) {
    const std::vector<AngleSum::Corner> seen = seenFrom(point, mesh);
    std::vector<AngleSum> halves(mesh.shells);
    for (const auto& t : mesh.triangles)
        halves[mesh.shellOf[t[0]]].addHalfSolidAngle(seen[t[0]], seen[t[1]], seen[t[2]]);
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

ShellSurface::ShellSurface(const WeldedMesh& mesh, std::uint32_t shell)
    : _mesh(mesh), _triangles(trianglesOf(mesh, shell)), _tree(mesh.positions, _triangles) {}

std::optional<SurfacePoint> ShellSurface::nearest(const glm::dvec3& point, double reach) const {
    if (_tree.empty() || _tree.distanceToBox(point) > reach) return std::nullopt;
    const SurfaceTree::Nearest found = _tree.nearest(point);
    if (glm::distance(found.position, point) > reach) return std::nullopt;
    SurfacePoint result{_triangles[found.triangle], found.shares, found.position};
    const auto& [a, b, c] = result.corners;
    const glm::dvec3 normal = result.shares.x * _mesh.normals[a] +
                              result.shares.y * _mesh.normals[b] +
                              result.shares.z * _mesh.normals[c];
    if (const double length = glm::length(normal); length > 1e-9) result.normal = normal / length;
    return result;
}

} // namespace osgSkin
