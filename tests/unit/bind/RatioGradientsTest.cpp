// SPDX-License-Identifier: GPL-3.0-or-later
//
// The ratios' gradients, which determine the normals of the deformed surface.
#include "Shapes.h"

#include <osgSkin/Deform>
#include <osgSkinBind/Bind>

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/trigonometric.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

using namespace osgSkin;

namespace {

/// Index of a vertex's influence by a joint, or the end index.
std::uint32_t find(const Binding& binding, std::uint32_t vertex, std::uint32_t joint) {
    std::uint32_t i = binding.firstInfluence[vertex];
    while (i < binding.firstInfluence[vertex + 1] && binding.influences[i].joint != joint) ++i;
    return i;
}

/// Area-weighted normals.
std::vector<glm::vec3> normalsOf(const std::vector<glm::vec3>& points,
                                 const std::vector<std::uint32_t>& corners) {
    std::vector<glm::vec3> normals(points.size(), glm::vec3(0.0f));
    for (std::size_t t = 0; t < corners.size(); t += 3) {
        const glm::vec3& a = points[corners[t]];
        const glm::vec3 area = glm::cross(points[corners[t + 1]] - a, points[corners[t + 2]] - a);
        for (std::size_t k = 0; k < 3; ++k) normals[corners[t + k]] += area;
    }
    for (glm::vec3& normal : normals) normal = glm::normalize(normal);
    return normals;
}

BindOptions withNormals() {
    BindOptions options;
    options.surfaceNormals = true;
    return options;
}

struct NormalError {
    double mean = 0.0, percentile95 = 0.0; ///< degrees
};

/// For a cylinder along y that is bent at y = 4, within 2.5 of the bend.
NormalError errorOf(const SkinMesh& mesh, const Binding& binding, double degrees) {
    std::vector<std::uint32_t> source(mesh.positions.size());
    std::iota(source.begin(), source.end(), 0u);
    const std::vector<glm::vec3> rest(mesh.positions.begin(), mesh.positions.end());
    const auto model = SkinModel::create(binding, rest, normalsOf(rest, mesh.triangles()), source);
    const glm::dvec3& centre = binding.joints[1].centre;
    std::vector<glm::dmat4> skinning(binding.joints.size(), glm::dmat4(1.0));
    skinning[1] = glm::translate(glm::dmat4(1.0), centre);
    skinning[1] = glm::rotate(skinning[1], glm::radians(degrees), glm::dvec3(1, 0, 0));
    skinning[1] = glm::translate(skinning[1], -centre);
    DeformOptions options;
    options.normals = true;
    const auto [posed, normals, tangents] = deform(*model, skinning, options);
    const std::vector<glm::vec3> wanted = normalsOf(posed, mesh.triangles());
    std::vector<double> errors;
    for (std::size_t v = 0; v < rest.size(); ++v)
        if (std::abs(rest[v].y - 4.0f) < 2.5f)
            errors.push_back(
                glm::degrees(std::acos(std::min(1.0, double(glm::dot(wanted[v], normals[v]))))));
    std::sort(errors.begin(), errors.end());
    const double sum = std::accumulate(errors.begin(), errors.end(), 0.0);
    return {sum / double(errors.size()), errors[errors.size() * 95 / 100]};
}

} // namespace

TEST(SurfaceNormals, MatchTheTrianglesOfABentLimb) {
    const SkinMesh mesh = shapes::cylinder(8.0, 32);
    const RestSkeleton skeleton = shapes::chainAlongY({0.0, 4.0}, 8.0);
    for (const auto shapes : {BindOptions::Shapes::None, BindOptions::Shapes::Fast}) {
        SCOPED_TRACE(shapes == BindOptions::Shapes::Fast ? "fast" : "none");
        BindOptions options = withNormals();
        options.shapes = shapes;
        const Binding binding = bind(mesh, skeleton, options);
        EXPECT_EQ(binding.correctives.hasNormals(), shapes == BindOptions::Shapes::Fast);
        options.surfaceNormals = false;
        const Binding turned = bind(mesh, skeleton, options);
        for (const double degrees : {90.0, 120.0, 140.0}) {
            SCOPED_TRACE(degrees);
            const NormalError error = errorOf(mesh, binding, degrees);
            EXPECT_LE(error.mean, 3.0);
            EXPECT_LE(error.percentile95, 12.0);
            EXPECT_GE(errorOf(mesh, turned, degrees).mean, 2.0 * error.mean);
        }
    }
}

TEST(RatioGradients, MatchDifferencesAlongEdges) {
    const SkinMesh mesh = shapes::cylinder();
    const RestSkeleton skeleton = shapes::chainAlongY({0.0, 4.0}, 8.0);
    BindOptions options = withNormals();
    options.shapes = BindOptions::Shapes::None; // shapes shorten gradients to open folds
    const Binding binding = bind(mesh, skeleton, options);
    ASSERT_EQ(binding.gradients.size(), binding.influences.size());
    const std::vector<std::uint32_t> corners = mesh.triangles();
    double worst = 0.0, steepest = 0.0;
    for (std::size_t c = 0; c < corners.size(); ++c) {
        const std::uint32_t a = corners[c], b = corners[c % 3 == 2 ? c - 2 : c + 1];
        const std::uint32_t i = find(binding, a, 1), j = find(binding, b, 1);
        if (i == binding.firstInfluence[a + 1] || j == binding.firstInfluence[b + 1]) continue;
        if (!binding.influences[i].isPartial() || !binding.influences[j].isPartial()) continue;
        const glm::vec3 way(mesh.positions[b] - mesh.positions[a]);
        const float bend = binding.influences[j].bend - binding.influences[i].bend;
        const float twist = binding.influences[j].twist - binding.influences[i].twist;
        const RatioGradient &ga = binding.gradients[i], &gb = binding.gradients[j];
        worst = std::max({worst, double(std::abs(bend - 0.5f * glm::dot(ga.bend + gb.bend, way))),
                          double(std::abs(twist - 0.5f * glm::dot(ga.twist + gb.twist, way)))});
        steepest = std::max(steepest, double(std::abs(bend)));
    }
    EXPECT_GE(steepest, 0.05); // otherwise there is nothing to compare
    EXPECT_LE(worst, 0.2 * steepest);
}

TEST(RatioGradients, AreTheSameOnBothSidesOfASeam) {
    SkinMesh mesh = shapes::cylinder();
    const RestSkeleton skeleton = shapes::chainAlongY({0.0, 4.0}, 8.0);
    const Binding whole = bind(mesh, skeleton, withNormals());
    // Gives the first face's corners vertices of their own.
    const auto vertices = static_cast<std::uint32_t>(mesh.positions.size());
    std::vector<std::uint32_t> from;
    std::size_t first = 0;
    for (std::size_t face = 0; face < mesh.faceSizes.size() / 2; ++face)
        first += mesh.faceSizes[face];
    for (std::size_t k = first; k < first + mesh.faceSizes[mesh.faceSizes.size() / 2]; ++k) {
        from.push_back(mesh.faceVertices[k]);
        mesh.positions.push_back(mesh.positions[from.back()]);
        mesh.faceVertices[k] = static_cast<std::uint32_t>(mesh.positions.size() - 1);
    }
    const Binding split = bind(mesh, skeleton, withNormals());
    bool any = false;
    for (std::uint32_t k = 0; k < from.size(); ++k) {
        const std::uint32_t copy = vertices + k;
        const std::uint32_t i = split.firstInfluence[copy], was = whole.firstInfluence[from[k]];
        ASSERT_EQ(split.firstInfluence[copy + 1] - i, whole.firstInfluence[from[k] + 1] - was);
        for (std::uint32_t n = 0; i + n < split.firstInfluence[copy + 1]; ++n) {
            EXPECT_LE(glm::distance(split.gradients[i + n].bend, whole.gradients[was + n].bend),
                      1e-5f);
            any = any || glm::length(whole.gradients[was + n].bend) > 0.01f;
        }
    }
    EXPECT_TRUE(any);
}

TEST(RatioGradients, AreOmittedWithoutSurfaceNormals) {
    BindOptions options;
    options.surfaceNormals = false;
    const Binding binding = bind(shapes::cylinder(), shapes::chainAlongY({0.0, 4.0}, 8.0), options);
    EXPECT_TRUE(binding.gradients.empty());
}
