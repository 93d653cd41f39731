// SPDX-License-Identifier: GPL-3.0-or-later
#include "ElasticTube.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include <algorithm>

namespace {

using namespace osgSkin;

/// Bent once for all tests: they only look.
const ElasticShapes& bent() {
    static const ElasticTube tube;
    static const ElasticShapes shapes =
        solveElasticJoint(tube.skin(), tube.joint({30, 60, 90, 120}));
    return shapes;
}

} // namespace

TEST(ElasticCylinder, IsSolvedWithoutCrossingsOrInvertedCells) {
    ASSERT_EQ(bent().reason, "");
    ASSERT_EQ(bent().samples.size(), 4u);
    for (const ElasticSample& sample : bent().samples) {
        EXPECT_EQ(sample.reason, "");
        EXPECT_EQ(sample.crossings, 0u);
        EXPECT_GT(sample.leastJacobian, 0.0);
        EXPECT_EQ(sample.positions.size(), bent().vertices.size());
    }
    EXPECT_GT(bent().samples.back().plainCrossings, 20u); // else there was nothing to solve
}

TEST(ElasticCylinder, KeepsItsVolume) {
    for (const ElasticSample& sample : bent().samples) {
        EXPECT_GT(sample.volumeRatio, 0.97);
        EXPECT_LT(sample.volumeRatio, 1.01);
    }
}

TEST(ElasticCylinder, OuterSideNeitherCavesInNorSwells) {
    const int angles[] = {30, 60, 90, 120};
    for (std::size_t i = 0; i < 4; ++i) {
        // Towards the outer side: the child's bone turns from +y to +z.
        const double half = glm::radians(0.5 * angles[i]);
        const glm::dvec3 bone(0, std::cos(2.0 * half), std::sin(2.0 * half));
        const glm::dvec3 outwards(0, std::sin(half), -std::cos(half));
        double least = 1e9, most = 0.0;
        for (const glm::dvec3& p : bent().samples[i].positions) {
            const double height = glm::dot(p, glm::cross(outwards, glm::dvec3(1, 0, 0)));
            if (glm::dot(p, outwards) < 0.0 || std::abs(p.x) > 0.3 || std::abs(height) > 1.0)
                continue;
            const double below = glm::length(p - glm::dvec3(0, std::min(p.y, 0.0), 0));
            const double above = glm::length(p - std::max(glm::dot(p, bone), 0.0) * bone);
            least = std::min({least, below, above});
            most = std::max(most, std::min(below, above));
        }
        EXPECT_GT(least, 0.94) << angles[i];
        EXPECT_LT(most, 1.04) << angles[i];
    }
}

TEST(ElasticCylinder, ComesToTheSameFoldByAnyWay) {
    const ElasticTube tube;
    const ElasticShapes other = solveElasticJoint(tube.skin(), tube.joint({20, 50, 75, 98, 120}));
    const ElasticSample &a = bent().samples.back(), &b = other.samples.back();
    ASSERT_EQ(a.positions.size(), b.positions.size());
    EXPECT_TRUE(a.converged);
    EXPECT_TRUE(b.converged);
    for (std::size_t v = 0; v < a.positions.size(); ++v)
        EXPECT_LT(glm::length(a.positions[v] - b.positions[v]), 0.05);
}

/// What cannot be bent so far is bent as far as it goes, for those who fit functions to it.
TEST(ElasticCylinder, GoesPartOfTheWayToABendThatIsTooFar) {
    const ElasticTube tube;
    const ElasticShapes shapes = solveElasticJoint(tube.skin(), tube.joint({90, 178}));
    ASSERT_GT(shapes.samples.size(), 2u);
    EXPECT_EQ(shapes.samples[0].reason, "");
    EXPECT_NE(shapes.samples[1].reason, "");
    double last = glm::radians(90.0);
    for (std::size_t i = 2; i < shapes.samples.size(); ++i) {
        EXPECT_EQ(shapes.samples[i].reason, "");
        const double angle = glm::angle(shapes.samples[i].rotation);
        EXPECT_GT(angle, last + 0.1);
        EXPECT_LT(angle, glm::radians(170.0));
        last = angle;
    }
}

TEST(ElasticCylinder, RimFollowsTheBones) {
    const ElasticShapes& shapes = bent();
    const double rim = shapes.reach - 1.0 / 3.0; // a cell
    std::size_t above = 0, below = 0;
    for (const ElasticSample& sample : shapes.samples)
        for (std::size_t v = 0; v < shapes.vertices.size(); ++v) {
            const glm::dvec3& rest = shapes.rest[v];
            if (glm::length(rest) < rim + 0.1) continue;
            const glm::dvec3 moved = rest.y > 0.0 ? sample.rotation * rest : rest;
            // Ratios within the flesh tend to 0 and 1, and are not quite there.
            EXPECT_LT(glm::length(sample.positions[v] - moved), 1e-4);
            ++(rest.y > 0.0 ? above : below);
        }
    EXPECT_GT(above, 40u);
    EXPECT_GT(below, 40u);
}

TEST(ElasticCylinder, RestPoseIsTheRestSkin) {
    const ElasticTube tube;
    ElasticJoint joint = tube.joint({0});
    joint.samples.push_back(glm::angleAxis(1e-5, glm::dvec3(1, 0, 0))); // is minimised
    const ElasticShapes shapes = solveElasticJoint(tube.skin(), joint);
    ASSERT_EQ(shapes.samples.size(), 2u);
    EXPECT_GT(shapes.samples[1].steps, 0);
    for (std::size_t v = 0; v < shapes.vertices.size(); ++v) {
        EXPECT_LT(glm::length(shapes.samples[0].positions[v] - shapes.rest[v]), 1e-9);
        EXPECT_LT(glm::length(shapes.samples[1].positions[v] - shapes.rest[v]), 1e-4);
    }
    EXPECT_NEAR(shapes.samples[1].volumeRatio, 1.0, 1e-6);
}

TEST(ElasticCylinder, IsTheSameFromRunToRunInAnySizeAndPlace) {
    const ElasticTube tube, other(0.01, {5, -3, 2});
    const ElasticShapes a = solveElasticJoint(tube.skin(), tube.joint({25, -25}));
    const ElasticShapes b = solveElasticJoint(tube.skin(), tube.joint({25, -25}));
    const ElasticShapes c = solveElasticJoint(other.skin(), other.joint({25, -25}));
    ASSERT_EQ(a.vertices, c.vertices);
    for (std::size_t s = 0; s < 2; ++s) {
        EXPECT_EQ(a.samples[s].positions, b.samples[s].positions);
        for (std::size_t v = 0; v < a.vertices.size(); ++v) {
            const glm::dvec3 back = (c.samples[s].positions[v] - glm::dvec3(5, -3, 2)) / 0.01;
            EXPECT_LT(glm::length(back - a.samples[s].positions[v]), 0.02);
        }
    }
}
