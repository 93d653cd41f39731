// SPDX-License-Identifier: MIT
#include "mesh/CheckNormals.h"

#include "mesh/SmoothNormals.h"
#include "text/FileText.h"

#include <glm/geometric.hpp>

#include <cstddef>

namespace osgSkin {
namespace {

/// How much of a material's area is seen from the front, and has its normals on the back.
struct Areas {
    double all = 0.0, contradicting = 0.0;

    /// More than half: sheets with faces on both sides and one set of normals are as they should
    /// be.
    bool areMostlyWrong() const { return contradicting > 0.6 * all; }
};

std::vector<Areas> areasOf(const CornerMesh& mesh) {
    std::vector<Areas> result(mesh.stateSets.size());
    const double extent = mesh.mesh.size(), scale = extent > 0.0 ? 1.0 / extent : 1.0;
    std::size_t first = 0;
    for (std::size_t f = 0; f < mesh.mesh.faceSizes.size(); ++f) {
        const std::size_t size = mesh.mesh.faceSizes[f];
        const auto corner = [&](std::size_t k) {
            return mesh.mesh.positions[mesh.mesh.faceVertices[first + k]];
        };
        glm::dvec3 face(0.0), given(0.0);
        for (std::size_t k = 2; k < size; ++k)
            face +=
                glm::cross((corner(k - 1) - corner(0)) * scale, (corner(k) - corner(0)) * scale);
        for (std::size_t k = 0; k < size; ++k) given += glm::dvec3(mesh.normals[first + k]);
        first += size;
        if (mesh.materials[f] >= result.size()) continue;
        Areas& areas = result[mesh.materials[f]];
        areas.all += glm::length(face);
        if (glm::dot(face, given) < 0.0) areas.contradicting += glm::length(face);
    }
    return result;
}

} // namespace

void mendNormals(CornerMesh& mesh, const std::string& path) {
    const std::vector<Areas> areas = areasOf(mesh);
    std::vector<glm::vec3> computed;
    std::size_t first = 0, faces = 0;
    for (std::size_t f = 0; f < mesh.mesh.faceSizes.size(); ++f) {
        const std::size_t size = mesh.mesh.faceSizes[f], begin = first;
        first += size;
        if (mesh.materials[f] >= areas.size() || !areas[mesh.materials[f]].areMostlyWrong())
            continue;
        if (computed.empty()) computed = smoothNormals(mesh.mesh);
        for (std::size_t k = begin; k < first; ++k) mesh.normals[k] = computed[k];
        ++faces;
    }
    if (faces > 0)
        tellOf(path, "the normals of " + std::to_string(faces) + " of " +
                         std::to_string(mesh.mesh.faceSizes.size()) +
                         " faces point to the faces' back; computed anew");
}

} // namespace osgSkin
