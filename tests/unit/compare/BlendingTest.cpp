// SPDX-License-Identifier: MIT
#include "Blending.h"
#include "HalfTurned.h"

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/mat3x3.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <ostream>
#include <random>
#include <stdexcept>
#include <string>

using namespace compare;

namespace {

using test::HalfTurned;

constexpr double kTolerance = 1e-13;

double distance(const glm::dmat4& a, const glm::dmat4& b) {
    double largest = 0.0;
    for (int column = 0; column < 4; ++column)
        largest = std::fmax(largest, glm::length(a[column] - b[column]));
    return largest;
}

TEST(DualQuaternion, DefaultIsTheIdentity) {
    const DualQuaternion none;
    const DualQuaternion identity = toDualQuaternion(glm::dmat4(1.0));
    EXPECT_EQ(none.real, identity.real);
    EXPECT_EQ(none.dual, identity.dual);
}

TEST(DualQuaternion, RefusesWhatIsNotRigid) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    glm::dmat4 shear(1.0);
    shear[1][0] = 0.1;
    glm::dmat4 lost(1.0);
    lost[3][1] = nan;
    for (const glm::dmat4& bad :
         {glm::dmat4(0.0), glm::dmat4(2.0), glm::scale(glm::dmat4(1.0), glm::dvec3(1, 1, -1)),
          shear, lost, glm::dmat4(nan)})
        EXPECT_THROW(toDualQuaternion(bad), std::invalid_argument);
}

TEST(DualQuaternionBlend, AnEmptySkinStaysEmpty) {
    EXPECT_TRUE(dualQuaternionBlend({}, {}, {glm::dmat4(1.0)}).empty());
}

TEST(DualQuaternionBlend, IdentityLeavesThePointsAlone) {
    const HalfTurned skin;
    const Points posed =
        dualQuaternionBlend(skin.rest, skin.weights, {glm::dmat4(1.0), glm::dmat4(1.0)});
    for (std::size_t v = 0; v < posed.size(); ++v)
        EXPECT_LT(glm::distance(posed[v], skin.rest[v]), kTolerance);
}

TEST(DualQuaternionBlend, AVertexOfOneJointFollowsItsMatrix) {
    SkinWeights weights;
    weights.add({{1, 1.0}});
    std::mt19937 random(7);
    std::uniform_real_distribution<double> number(-3.0, 3.0);
    for (int i = 0; i < 100; ++i) {
        const glm::dmat4 own =
            test::turnAndShift(number(random), {number(random), number(random), number(random)},
                               {number(random), number(random), number(random)});
        EXPECT_LT(distance(dualQuaternionBlendMatrices(weights, {glm::dmat4(1.0), own})[0], own),
                  kTolerance);
    }
}

TEST(DualQuaternionBlend, JointsThatMoveAlikeMoveTheSkinRigidly) {
    const HalfTurned skin;
    const glm::dmat4 rigid = test::turnAndShift(3.0, {1, 2, 3}, {4, -5, 6});
    for (const glm::dmat4& matrix : dualQuaternionBlendMatrices(skin.weights, {rigid, rigid}))
        EXPECT_LT(distance(matrix, rigid), kTolerance);
}

TEST(DualQuaternionBlend, HalfWeightTurnsByHalfTheAngle) {
    const HalfTurned skin;
    for (double degrees = -179.0; degrees <= 179.0; degrees += 1.0) {
        const glm::dvec3 axis(1, -2, 0.5);
        const glm::dmat4 half =
            test::turnAndShift(0.5 * glm::radians(degrees), axis, glm::dvec3(0.0));
        EXPECT_LT(distance(dualQuaternionBlendMatrices(skin.weights, skin.turned(degrees, axis))[0],
                           half),
                  kTolerance)
            << degrees;
    }
}

TEST(DualQuaternionBlend, ACrossSectionKeepsItsArea) {
    const HalfTurned skin;
    const double before = loopArea(skin.rest, skin.loop);
    for (double degrees = 0.0; degrees <= 360.0; degrees += 7.5)
        for (const glm::dvec3& axis : {glm::dvec3(0, 0, 1), glm::dvec3(0, 1, 0)})
            EXPECT_NEAR(
                loopArea(dualQuaternionBlend(skin.rest, skin.weights, skin.turned(degrees, axis)),
                         skin.loop),
                before, kTolerance)
                << degrees;
}

/// Rotations of 150 and -150 degrees are 60 degrees apart by the shorter path through 180: their
/// quaternions have opposite signs, and blending without correction would give 0.
TEST(DualQuaternionBlend, GoesTheShortWayRound) {
    const HalfTurned skin;
    const glm::dvec3 axis(0, 0, 1);
    const glm::dmat4 a = test::turnAndShift(glm::radians(150.0), axis, {2, 0, 0});
    const glm::dmat4 b = test::turnAndShift(glm::radians(-150.0), axis, {2, 0, 0});
    const glm::dmat4 blended = dualQuaternionBlendMatrices(skin.weights, {a, b})[0];
    const glm::dmat4 halfTurn = test::turnAndShift(glm::pi<double>(), axis, glm::dvec3(0.0));
    EXPECT_LT(distance(glm::dmat4(glm::dmat3(blended)), halfTurn), kTolerance);
}

TEST(DualQuaternionBlend, TheOrderOfTheInfluencesDoesNotMatter) {
    SkinWeights one;
    one.add({{0, 0.2}, {1, 0.5}, {2, 0.3}});
    SkinWeights other;
    other.add({{2, 0.3}, {0, 0.2}, {1, 0.5}});
    const std::vector<glm::dmat4> joints{test::turnAndShift(3.0, {0, 0, 1}, {1, 0, 0}),
                                         test::turnAndShift(-3.0, {0, 0, 1}, {0, 1, 0}),
                                         test::turnAndShift(2.5, {0, 1, 1}, {0, 0, 1})};
    EXPECT_LT(distance(dualQuaternionBlendMatrices(one, joints)[0],
                       dualQuaternionBlendMatrices(other, joints)[0]),
              kTolerance);
}

TEST(DualQuaternionBlend, BlendsTranslationsLinearly) {
    SkinWeights weights;
    weights.add({{0, 0.25}, {1, 0.75}});
    const glm::dmat4 shift = glm::translate(glm::dmat4(1.0), glm::dvec3(4, 0, -8));
    const Points posed = dualQuaternionBlend({{1, 1, 1}}, weights, {glm::dmat4(1.0), shift});
    EXPECT_LT(glm::distance(posed[0], glm::dvec3(4, 1, -5)), kTolerance);
}

using test::HalfTurned;

constexpr double kLinearTolerance = 1e-14;

TEST(LinearBlend, AnEmptySkinStaysEmpty) {
    EXPECT_TRUE(linearBlend({}, {}, {glm::dmat4(1.0)}).empty());
}

TEST(LinearBlend, IdentityLeavesThePointsAlone) {
    const HalfTurned skin;
    const Points posed = linearBlend(skin.rest, skin.weights, {glm::dmat4(1.0), glm::dmat4(1.0)});
    for (std::size_t v = 0; v < posed.size(); ++v) EXPECT_EQ(posed[v], skin.rest[v]);
}

TEST(LinearBlend, JointsThatMoveAlikeMoveTheSkinRigidly) {
    const HalfTurned skin;
    const glm::dmat4 rigid = test::turnAndShift(1.1, {1, 2, 3}, {4, -5, 6});
    const Points posed = linearBlend(skin.rest, skin.weights, {rigid, rigid});
    for (std::size_t v = 0; v < posed.size(); ++v)
        EXPECT_LT(glm::distance(posed[v], glm::dvec3(rigid * glm::dvec4(skin.rest[v], 1.0))),
                  kLinearTolerance);
}

TEST(LinearBlend, AVertexOfOneJointFollowsItsMatrix) {
    SkinWeights weights;
    weights.add({{1, 1.0}});
    const glm::dmat4 other(7.0);
    const glm::dmat4 own = test::turnAndShift(-2.0, {0, 1, 1}, {1, 0, 0});
    EXPECT_EQ(linearBlendMatrices(weights, {other, own})[0], own);
}

TEST(LinearBlend, MovesByTheWeightedMean) {
    SkinWeights weights;
    weights.add({{0, 0.25}, {1, 0.75}});
    const glm::dmat4 shift = glm::translate(glm::dmat4(1.0), glm::dvec3(4, 0, -8));
    const Points posed = linearBlend({{1, 1, 1}}, weights, {glm::dmat4(1.0), shift});
    EXPECT_LT(glm::distance(posed[0], glm::dvec3(4, 1, -5)), kLinearTolerance);
}

TEST(LinearBlend, ACrossSectionAtHalfWeightShrinksAsTheoryHasIt) {
    const HalfTurned skin;
    const double before = loopArea(skin.rest, skin.loop);
    for (double degrees = -360.0; degrees <= 360.0; degrees += 7.5) {
        const double half = 0.5 * glm::radians(degrees);
        const auto area = [&](const glm::dvec3& axis) {
            return loopArea(linearBlend(skin.rest, skin.weights, skin.turned(degrees, axis)),
                            skin.loop) /
                   before;
        };
        EXPECT_NEAR(area({0, 0, 1}), std::cos(half) * std::cos(half), kLinearTolerance) << degrees;
        EXPECT_NEAR(area({0, 1, 0}), std::abs(std::cos(half)), kLinearTolerance) << degrees;
    }
}

TEST(LinearBlend, RefusesWeightsThatNameNoMatrix) {
    const HalfTurned skin;
    EXPECT_THROW(linearBlend(skin.rest, skin.weights, {glm::dmat4(1.0)}), std::invalid_argument);
    EXPECT_THROW(linearBlend({{0, 0, 0}}, skin.weights, {glm::dmat4(1.0), glm::dmat4(1.0)}),
                 std::invalid_argument);
}

/// A tetrahedron with its right-angled corner at the origin, facing outwards.
const Points kCorner{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
const std::vector<std::uint32_t> kSides{0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3};

Points scaled(Points points, const glm::dvec3& by, const glm::dvec3& shift = glm::dvec3(0.0)) {
    for (glm::dvec3& point : points) point = point * by + shift;
    return points;
}

TEST(EnclosedVolume, KnowsATetrahedronWhereverItIs) {
    EXPECT_DOUBLE_EQ(enclosedVolume(kCorner, kSides), 1.0 / 6.0);
    EXPECT_NEAR(enclosedVolume(scaled(kCorner, {2, 3, 4}, {5, 6, 7}), kSides), 4.0, 1e-12);
    EXPECT_DOUBLE_EQ(enclosedVolume(scaled(kCorner, {-1, 1, 1}), kSides), -1.0 / 6.0);
    EXPECT_EQ(enclosedVolume({}, {}), 0.0);
}

TEST(LoopArea, IsThatOfAPlaneLoopHoweverItLies) {
    EXPECT_NEAR(loopArea({{0, 0, 0}, {2, 0, 0}, {2, 3, 0}, {0, 3, 0}}, {0, 1, 2, 3}), 6.0, 1e-14);
    EXPECT_NEAR(loopArea(kCorner, {1, 2, 3}), std::sqrt(3.0) / 2.0, 1e-14);
    EXPECT_EQ(loopArea(kCorner, {0, 1}), 0.0);
    EXPECT_EQ(loopArea({}, {}), 0.0);
}

TEST(FaceEdges, ListsEachEdgeOnceAndNoDiagonal) {
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

TEST(EdgeStrain, LeavesOutEdgesWithoutLength) {
    const Points rest{{0, 0, 0}, {0, 0, 0}};
    const EdgeStrain strain = edgeStrain(rest, {{0, 0, 0}, {9, 0, 0}}, {{0, 1}});
    EXPECT_EQ(strain.rms, 0.0);
    EXPECT_EQ(strain.largest, 1.0);
}

TEST(EdgeStrain, APercentileIsNotTheLargest) {
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

TEST(SkinWeights, DefaultHasNoVertex) {
    const SkinWeights weights;
    EXPECT_EQ(weights.vertexCount(), 0u);
    EXPECT_NO_THROW(weights.validate(0));
}

TEST(SkinWeights, AddLeavesOutWeightsOfZero) {
    SkinWeights weights;
    weights.add({{0, 0.0}, {3, 1.0}});
    ASSERT_EQ(weights.entries.size(), 1u);
    EXPECT_EQ(weights.entries[0].joint, 3u);
    EXPECT_NO_THROW(weights.validate(4));
}

struct BadCase {
    std::string name;
    SkinWeights weights;
};

std::ostream& operator<<(std::ostream& out, const BadCase& bad) {
    return out << bad.name;
}

class BadSkinWeights : public testing::TestWithParam<BadCase> {};

TEST_P(BadSkinWeights, AreRefused) {
    EXPECT_THROW(GetParam().weights.validate(2), std::invalid_argument);
}

const BadCase kBadCases[] = {
    {"NoOffsets", {{}, {}}},
    {"FirstOffsetNotZero", {{1, 1}, {{0, 1.0}}}},
    {"OffsetsPastTheEnd", {{0, 2, 1}, {{0, 1.0}}}},
    {"OffsetsDecrease", {{0, 2, 1, 2}, {{0, 0.5}, {1, 0.5}}}},
    {"EntriesLeftOver", {{0, 1}, {{0, 1.0}, {1, 1.0}}}},
    {"VertexWithoutWeights", {{0, 0}, {}}},
    {"NoSuchJoint", {{0, 1}, {{2, 1.0}}}},
    {"Negative", {{0, 2}, {{0, -0.5}, {1, 1.5}}}},
    {"NotANumber", {{0, 1}, {{0, std::numeric_limits<double>::quiet_NaN()}}}},
    {"SumTooSmall", {{0, 2}, {{0, 0.5}, {1, 0.4}}}},
};

INSTANTIATE_TEST_SUITE_P(SkinWeights, BadSkinWeights, testing::ValuesIn(kBadCases),
                         [](const auto& tested) { return tested.param.name; });

TEST(TransformPoints, WantsAMatrixForEachPoint) {
    EXPECT_THROW(transformPoints({glm::dmat4(1.0)}, {}), std::invalid_argument);
}

} // namespace
