// SPDX-License-Identifier: MIT
#include "Blending.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <vector>

using namespace compare;

namespace {

/// A tetrahedron with its right-angled corner at the origin, facing outwards.
const Points kCorner{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
const std::vector<std::uint32_t> kSides{0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3};

Points scaled(Points points, const glm::dvec3& by, const glm::dvec3& shift = glm::dvec3(0.0)) {
    for (glm::dvec3& point : points) point = point * by + shift;
    return points;
}

TEST(EnclosedVolume, MeasuresATetrahedron) {
    EXPECT_DOUBLE_EQ(enclosedVolume(kCorner, kSides), 1.0 / 6.0);
    EXPECT_NEAR(enclosedVolume(scaled(kCorner, {2, 3, 4}, {5, 6, 7}), kSides), 4.0, 1e-12);
    EXPECT_DOUBLE_EQ(enclosedVolume(scaled(kCorner, {-1, 1, 1}), kSides), -1.0 / 6.0);
    EXPECT_EQ(enclosedVolume({}, {}), 0.0);
}

TEST(LoopArea, MeasuresPlanarLoops) {
    EXPECT_NEAR(loopArea({{0, 0, 0}, {2, 0, 0}, {2, 3, 0}, {0, 3, 0}}, {0, 1, 2, 3}), 6.0, 1e-14);
    EXPECT_NEAR(loopArea(kCorner, {1, 2, 3}), std::sqrt(3.0) / 2.0, 1e-14);
    EXPECT_EQ(loopArea(kCorner, {0, 1}), 0.0);
    EXPECT_EQ(loopArea({}, {}), 0.0);
}

TEST(FaceEdges, ListsEachEdgeOnceWithoutDiagonals) {
    const std::vector<Edge> edges = faceEdges({4, 3}, {0, 1, 2, 3, 2, 1, 4});
    const std::vector<Edge> expected{{0, 1}, {0, 3}, {1, 2}, {1, 4}, {2, 3}, {2, 4}};
    EXPECT_EQ(edges, expected);
}

TEST(EdgeStrain, ComparesLengths) {
    const Points rest{{0, 0, 0}, {1, 0, 0}, {1, 2, 0}};
    const Points posed{{0, 0, 0}, {1.5, 0, 0}, {1.5, 1, 0}}; // ratios 1.5 and 0.5
    const EdgeStrain strain = edgeStrain(rest, posed, {{0, 1}, {1, 2}});
    EXPECT_DOUBLE_EQ(strain.rms, 0.5);
    EXPECT_DOUBLE_EQ(strain.largest, 1.5);
    EXPECT_DOUBLE_EQ(strain.percentile999, 1.5);
}

TEST(EdgeStrain, IgnoresEdgesOfNoLength) {
    const Points rest{{0, 0, 0}, {0, 0, 0}};
    const EdgeStrain strain = edgeStrain(rest, {{0, 0, 0}, {9, 0, 0}}, {{0, 1}});
    EXPECT_EQ(strain.rms, 0.0);
    EXPECT_EQ(strain.largest, 1.0);
}

TEST(EdgeStrain, PercentileIgnoresASingleOutlier) {
    Points rest{{0, 0, 0}}, posed{{0, 0, 0}};
    std::vector<Edge> edges;
    for (std::uint32_t i = 1; i <= 2000; ++i) {
        rest.emplace_back(1, 0, 0);
        posed.emplace_back(i == 1000 ? 5 : 1, 0, 0);
        edges.push_back({0, i});
    }
    const EdgeStrain strain = edgeStrain(rest, posed, edges);
    EXPECT_EQ(strain.largest, 5.0);
    EXPECT_EQ(strain.percentile999, 1.0);
}

TEST(Bulge, ComparesDistancesToTheNearestBone) {
    const std::vector<Segment> bones{{{0, 0, 0}, {0, 0, 1}}, {{0, 0, 1}, {0, 0, 2}}};
    const Points rest{{1, 0, 0.5}, {0, 2, 1.5}, {0, 0, 1}};
    const Points posed{
        {1.25, 0, 0.5}, {0, 2, 1.5}, {3, 0, 1}}; // the last one lies on a bone at rest
    EXPECT_DOUBLE_EQ(bulge(rest, posed, {0, 1, 2}, bones, bones), 1.25);
    EXPECT_DOUBLE_EQ(bulge(rest, posed, {1}, bones, bones), 1.0);
}

TEST(TransformPoints, RejectsMissingMatrices) {
    EXPECT_THROW(transformPoints({glm::dmat4(1.0)}, {}), std::invalid_argument);
}

} // namespace
