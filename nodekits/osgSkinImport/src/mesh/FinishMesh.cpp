// SPDX-License-Identifier: MIT
#include "mesh/FinishMesh.h"

#include "mesh/CheckNormals.h"
#include "mesh/MeshParts.h"
#include "mesh/SmoothNormals.h"
#include "text/FileText.h"

#include <osgSkin/Error>

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>
#include <system_error>
#include <utility>

namespace osgSkin {
namespace {

constexpr std::size_t kSamplesOfMaterial = 500; ///< what is drawn by itself takes 50 kilobytes

/// Makes all normals unit vectors; false where some are missing.
bool normalise(std::vector<glm::vec3>& normals) {
    for (glm::vec3& n : normals) {
        const double length = glm::length(glm::dvec3(n));
        if (!std::isfinite(length) || !(length > 0.0)) return false;
        n = glm::vec3(glm::dvec3(n) / length);
    }
    return true;
}

} // namespace

void checkMaterials(const CornerMesh& mesh, const std::string& path, const ReadLimits& limits) {
    std::error_code failure;
    const auto bytes = static_cast<std::size_t>(std::filesystem::file_size(path, failure));
    const std::size_t most = limits.samplesOf(failure ? 0 : bytes) / kSamplesOfMaterial;
    const std::set<std::uint32_t> used(mesh.materials.begin(), mesh.materials.end());
    if (used.size() > most)
        failFile(path, std::to_string(used.size()) + " materials, expected at most " +
                           std::to_string(most) + " (option maxSamples)");
}

ImportedMesh finishMesh(CornerMesh read, const std::string& path) {
    if (read.mesh.faceSizes.empty()) failFile(path, "no face, expected at least one");
    try {
        read.mesh.validate();
    } catch (const Error& error) {
        failFile(path, error.what());
    }
    if (normalise(read.normals))
        mendNormals(read, path);
    else
        read.normals = smoothNormals(read.mesh);
    for (glm::vec2& t : read.texCoords)
        if (!std::isfinite(t.x) || !std::isfinite(t.y)) t = glm::vec2(0.0f);
    for (glm::vec4& c : read.colours)
        for (int k = 0; k < 4; ++k)
            c[k] = std::isfinite(c[k]) ? std::clamp(c[k], 0.0f, 1.0f) : 1.0f;

    ImportedMesh result;
    result.parts = makeMeshParts(read);
    result.weights = std::move(read.weights);
    result.mesh = std::move(read.mesh);
    return result;
}

} // namespace osgSkin
