// SPDX-License-Identifier: MIT
#include "mesh/SmoothNormals.h"

#include <glm/geometric.hpp>

#include <map>
#include <tuple>

namespace osgSkin {
namespace {

/// For each vertex, the first vertex at the same position.
std::vector<std::size_t> weld(const std::vector<glm::dvec3>& positions) {
    std::map<std::tuple<double, double, double>, std::size_t> first;
    std::vector<std::size_t> result;
    result.reserve(positions.size());
    for (std::size_t v = 0; v < positions.size(); ++v) {
        const glm::dvec3& p = positions[v];
        result.push_back(first.emplace(std::make_tuple(p.x, p.y, p.z), v).first->second);
    }
    return result;
}

} // namespace

std::vector<glm::vec3> smoothNormals(const SkinMesh& mesh) {
    const std::vector<std::size_t> welded = weld(mesh.positions);
    std::vector<glm::dvec3> sums(mesh.positions.size(), glm::dvec3(0.0));
    // Bodies come in any unit: scaled to size 1, squared lengths neither overflow nor vanish.
    const double extent = mesh.size();
    const double scale = extent > 0.0 ? 1.0 / extent : 1.0;
    // A polygon's normal is the sum of its triangles' (Newell), the same for all of its corners:
    // the shading does not tell how it is cut into triangles.
    const std::uint32_t* corners = mesh.faceVertices.data();
    for (const std::uint32_t size : mesh.faceSizes) {
        const glm::dvec3& origin = mesh.positions[corners[0]];
        glm::dvec3 normal(0.0);
        for (std::uint32_t k = 2; k < size; ++k)
            normal += glm::cross((mesh.positions[corners[k - 1]] - origin) * scale,
                                 (mesh.positions[corners[k]] - origin) * scale);
        for (std::uint32_t k = 0; k < size; ++k) sums[welded[corners[k]]] += normal;
        corners += size;
    }
    std::vector<glm::vec3> result;
    result.reserve(mesh.faceVertices.size());
    for (const std::uint32_t v : mesh.faceVertices) {
        const double length = glm::length(sums[welded[v]]);
        // Some unit vector where all faces around the vertex are flat.
        result.emplace_back(length > 0.0 ? sums[welded[v]] / length : glm::dvec3(0.0, 1.0, 0.0));
    }
    return result;
}

} // namespace osgSkin
