// SPDX-License-Identifier: GPL-3.0-or-later
#include "Shapes.h"

#include <osgSkin/Deform>
#include <osgSkinBind/Bind>

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

using namespace osgSkin;

namespace {

enum class LastBone { Tip, EndJoint, Nothing };

/// A cylinder, radius 1 and 8 long, over two joints; the upper half rotates.
class Cylinder : public testing::TestWithParam<std::tuple<int, LastBone>> {
protected:
    void SetUp() override {
        const auto [sides, last] = GetParam();
        mesh = shapes::cylinder(8.0, sides);
        RestSkeleton skeleton = shapes::chainAlongY({0.0, 4.0}, 8.0);
        if (last != LastBone::Tip) skeleton.joints.back().tip.reset();
        if (last == LastBone::EndJoint)
            shapes::addJoint(skeleton, "end", skeleton.joints.back().name, {0, 8, 0});
        BindOptions options; // the ratios alone: pressing folds flat reduces the volume
        options.shapes = BindOptions::Shapes::None;
        binding = bind(mesh, skeleton, options);
    }

    std::vector<glm::dvec3> turned(const glm::dvec3& axis, double degrees) const {
        const glm::dmat4 unit(1.0);
        const glm::dmat4 turn = glm::translate(unit, glm::dvec3(0, 4, 0)) *
                                glm::rotate(unit, glm::radians(degrees), axis) *
                                glm::translate(unit, glm::dvec3(0, -4, 0));
        std::vector<glm::dmat4> skinning(binding.joints.size(), turn);
        skinning[0] = unit;
        return deform(binding, mesh.positions, skinning);
    }

    /// Smallest area of a ring over that at rest.
    double leastArea(const std::vector<glm::dvec3>& points) const {
        std::map<double, std::vector<std::size_t>> rings;
        for (std::size_t v = 0; v < points.size(); ++v)
            if (glm::length(glm::dvec2(mesh.positions[v].x, mesh.positions[v].z)) > 0.99)
                rings[mesh.positions[v].y].push_back(v);
        double least = 1.0;
        for (auto& [height, ring] : rings) {
            std::sort(ring.begin(), ring.end(), [&](std::size_t a, std::size_t b) {
                const glm::dvec3 &p = mesh.positions[a], &q = mesh.positions[b];
                return std::atan2(p.z, p.x) < std::atan2(q.z, q.x);
            });
            glm::dvec3 now(0.0), rest(0.0);
            for (std::size_t k = 0; k < ring.size(); ++k) {
                const std::size_t a = ring[k], b = ring[(k + 1) % ring.size()];
                now += glm::cross(points[a] - points[ring[0]], points[b] - points[ring[0]]);
                rest += glm::cross(mesh.positions[a] - mesh.positions[ring[0]],
                                   mesh.positions[b] - mesh.positions[ring[0]]);
            }
            least = std::min(least, glm::length(now) / glm::length(rest));
        }
        return least;
    }

    double volume(const std::vector<glm::dvec3>& points) const {
        const std::vector<std::uint32_t> corners = mesh.triangles();
        double sum = 0.0;
        for (std::size_t t = 0; t + 2 < corners.size(); t += 3)
            sum += glm::dot(points[corners[t]],
                            glm::cross(points[corners[t + 1]], points[corners[t + 2]]));
        return sum;
    }

    SkinMesh mesh;
    Binding binding;
};

} // namespace

TEST_P(Cylinder, KeepsCrossSectionsWhenTwisted) {
    for (double degrees = 0.0; degrees <= 330.0; degrees += 30.0)
        EXPECT_GE(leastArea(turned({0, 1, 0}, degrees)), 0.99) << "at " << degrees;
}

TEST_P(Cylinder, KeepsVolumeWhenBent) {
    for (const glm::dvec3& axis : {glm::dvec3(1, 0, 0), glm::dvec3(0, 0, 1)})
        for (double degrees = 30.0; degrees <= 120.0; degrees += 30.0)
            EXPECT_NEAR(volume(turned(axis, degrees)) / volume(mesh.positions), 1.0, 0.01)
                << "at " << degrees;
}

INSTANTIATE_TEST_SUITE_P(All, Cylinder,
                         testing::Combine(testing::Values(8, 16, 48),
                                          testing::Values(LastBone::Tip, LastBone::EndJoint,
                                                          LastBone::Nothing)));
