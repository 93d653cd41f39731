// SPDX-License-Identifier: MIT
#include <osgSkinRig/SkinMesh>

#include "mesh/CutPolygon.h"

#include <osgSkin/Error>
#include <osgSkin/GlmTypes>

#include <glm/common.hpp>

#include <algorithm>
#include <cmath>

namespace osgSkin {

void SkinMesh::validate() const {
    if (positions.empty()) throw Error("mesh: no vertex, expected at least 3");
    if (faceSizes.empty()) throw Error("mesh: no face, expected at least one");
    for (std::size_t v = 0; v < positions.size(); ++v) {
        if (isInRange(positions[v])) continue;
        throw Error("mesh: vertex " + std::to_string(v) + " has a coordinate " +
                    (isFinite(positions[v]) ? "beyond -1e18 to 1e18" : "that is not finite"));
    }
    std::size_t corner = 0;
    for (std::size_t f = 0; f < faceSizes.size(); ++f) {
        const std::string place = "mesh: face " + std::to_string(f);
        if (faceSizes[f] < 3)
            throw Error(place + " has " + std::to_string(faceSizes[f]) +
                        " corners, expected 3 or more");
        if (faceSizes[f] > faceVertices.size() - corner)
            throw Error(place + " has more corners than the mesh lists");
        for (std::uint32_t k = 0; k < faceSizes[f]; ++k, ++corner)
            if (faceVertices[corner] >= positions.size())
                throw Error(place + " names vertex " + std::to_string(faceVertices[corner]) +
                            ", expected less than " + std::to_string(positions.size()));
    }
    if (corner != faceVertices.size()) throw Error("mesh: corners beyond the last face");
}

std::vector<std::uint32_t> SkinMesh::triangleCorners() const {
    std::vector<std::uint32_t> result;
    result.reserve(3 * faceVertices.size());
    PolygonCutter cutter(positions);
    std::size_t corner = 0;
    for (const std::uint32_t size : faceSizes) {
        const std::size_t begin = result.size();
        cutter.cut(&faceVertices[corner], size, result);
        for (std::size_t k = begin; k < result.size(); ++k)
            result[k] += static_cast<std::uint32_t>(corner);
        corner += size;
    }
    return result;
}

std::vector<std::uint32_t> SkinMesh::triangles() const {
    std::vector<std::uint32_t> result = triangleCorners();
    for (std::uint32_t& corner : result) corner = faceVertices[corner];
    return result;
}

double SkinMesh::size() const {
    if (positions.empty()) return 0.0;
    glm::dvec3 low = positions.front();
    glm::dvec3 high = low;
    for (const glm::dvec3& p : positions) {
        low = glm::min(low, p);
        high = glm::max(high, p);
    }
    const glm::dvec3 extent = high - low;
    return std::max({extent.x, extent.y, extent.z});
}

} // namespace osgSkin
