// SPDX-License-Identifier: MIT
#include "HalfTurned.h"

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/mat3x3.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>

using namespace compare;
using test::HalfTurned;

namespace {

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

TEST(DualQuaternion, RejectsNonRigidMatrices) {
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

TEST(DualQuaternionBlend, AcceptsAnEmptySkin) {
    EXPECT_TRUE(dualQuaternionBlend({}, {}, {glm::dmat4(1.0)}).empty());
}

TEST(DualQuaternionBlend, IdentityKeepsThePoints) {
    const HalfTurned skin;
    const Points posed =
        dualQuaternionBlend(skin.rest, skin.weights, {glm::dmat4(1.0), glm::dmat4(1.0)});
    for (std::size_t v = 0; v < posed.size(); ++v)
        EXPECT_LT(glm::distance(posed[v], skin.rest[v]), kTolerance);
}

TEST(DualQuaternionBlend, VertexOfOneJointFollowsItsMatrix) {
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

TEST(DualQuaternionBlend, EqualMatricesMoveTheSkinRigidly) {
    const HalfTurned skin;
    const glm::dmat4 rigid = test::turnAndShift(3.0, {1, 2, 3}, {4, -5, 6});
    for (const glm::dmat4& matrix : dualQuaternionBlendMatrices(skin.weights, {rigid, rigid}))
        EXPECT_LT(distance(matrix, rigid), kTolerance);
}

TEST(DualQuaternionBlend, HalfWeightRotatesByHalfTheAngle) {
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

TEST(DualQuaternionBlend, CrossSectionKeepsItsArea) {
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
TEST(DualQuaternionBlend, TakesTheShorterRotation) {
    const HalfTurned skin;
    const glm::dvec3 axis(0, 0, 1);
    const glm::dmat4 a = test::turnAndShift(glm::radians(150.0), axis, {2, 0, 0});
    const glm::dmat4 b = test::turnAndShift(glm::radians(-150.0), axis, {2, 0, 0});
    const glm::dmat4 blended = dualQuaternionBlendMatrices(skin.weights, {a, b})[0];
    const glm::dmat4 halfTurn = test::turnAndShift(glm::pi<double>(), axis, glm::dvec3(0.0));
    EXPECT_LT(distance(glm::dmat4(glm::dmat3(blended)), halfTurn), kTolerance);
}

TEST(DualQuaternionBlend, IsIndependentOfTheInfluencesOrder) {
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

} // namespace
