// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/SurfaceQueries.h"

#include "mesh/SurfaceTree.h"

#include <glm/geometric.hpp>

#include <cmath>

namespace osgSkin {
namespace {

/// Half of a full sphere's solid angle, minus a margin for rounding, and of a half sphere's.
constexpr double kAllAround = 6.28, kHalfAround = 3.141592653589793;

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
