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

constexpr std::size_t kElementsOfVertex = 14;   ///< of 64 bytes each, half a sample
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

/// No light is as bright: such numbers count to 255.
constexpr float kTooBright = 16.0f;

/// Some write numbers up to 255, whole ones as a rule, where numbers up to 1 are expected: colours,
/// or alpha.
bool countsTo255(const std::vector<glm::vec4>& colours, int first, int end) {
    float most = 0.0f;
    bool areWhole = true;
    for (const glm::vec4& colour : colours)
        for (int k = first; k < end; ++k) {
            areWhole = areWhole && colour[k] == std::floor(colour[k]); // or not a number
            most = std::max(most, colour[k]);
        }
    return most > (areWhole ? 1.0f : kTooBright) && most <= 255.0f;
}

void finishColours(std::vector<glm::vec4>& colours) {
    const float rgb = countsTo255(colours, 0, 3) ? 255.0f : 1.0f;
    const float alpha = countsTo255(colours, 3, 4) ? 255.0f : 1.0f;
    for (glm::vec4& colour : colours) {
        colour /= glm::vec4(rgb, rgb, rgb, alpha);
        for (int k = 0; k < 4; ++k)
            colour[k] = std::isfinite(colour[k]) ? std::clamp(colour[k], 0.0f, 1.0f) : 1.0f;
    }
}

std::size_t samplesFor(const std::string& path, const ReadLimits& limits) {
    std::error_code failure;
    const auto bytes = static_cast<std::size_t>(std::filesystem::file_size(path, failure));
    return limits.samplesOf(failure ? 0 : bytes);
}

} // namespace

void checkVertices(const CornerMesh& mesh, const std::string& path, const ReadLimits& limits) {
    const std::size_t most = 2 * samplesFor(path, limits);
    if (kElementsOfVertex * mesh.mesh.positions.size() > most)
        failFile(path, std::to_string(mesh.mesh.positions.size()) + " vertices, expected at most " +
                           std::to_string(most / kElementsOfVertex) + " (option maxSamples)");
}

void checkMaterials(const CornerMesh& mesh, const std::string& path, const ReadLimits& limits) {
    const std::size_t most = samplesFor(path, limits) / kSamplesOfMaterial;
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
    if (read.mesh.size() == 0.0)
        failFile(path, "all vertices are at one place, expected a surface");
    if (normalise(read.normals))
        mendNormals(read, path);
    else
        read.normals = smoothNormals(read.mesh);
    for (glm::vec2& t : read.texCoords)
        if (!std::isfinite(t.x) || !std::isfinite(t.y)) t = glm::vec2(0.0f);
    finishColours(read.colours);

    ImportedMesh result;
    result.parts = makeMeshParts(read);
    result.weights = std::move(read.weights);
    result.mesh = std::move(read.mesh);
    return result;
}

} // namespace osgSkin
