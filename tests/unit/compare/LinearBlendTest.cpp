// SPDX-License-Identifier: MIT
#include "HalfTurned.h"

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

using namespace compare;
using test::HalfTurned;

namespace {

constexpr double kLinearTolerance = 1e-14;

TEST(LinearBlend, AcceptsAnEmptySkin) {
    EXPECT_TRUE(linearBlend({}, {}, {glm::dmat4(1.0)}).empty());
}

TEST(LinearBlend, IdentityKeepsThePoints) {
    const HalfTurned skin;
    const Points posed = linearBlend(skin.rest, skin.weights, {glm::dmat4(1.0), glm::dmat4(1.0)});
    for (std::size_t v = 0; v < posed.size(); ++v) EXPECT_EQ(posed[v], skin.rest[v]);
}

TEST(LinearBlend, EqualMatricesMoveTheSkinRigidly) {
    const HalfTurned skin;
    const glm::dmat4 rigid = test::turnAndShift(1.1, {1, 2, 3}, {4, -5, 6});
    const Points posed = linearBlend(skin.rest, skin.weights, {rigid, rigid});
    for (std::size_t v = 0; v < posed.size(); ++v)
        EXPECT_LT(glm::distance(posed[v], glm::dvec3(rigid * glm::dvec4(skin.rest[v], 1.0))),
                  kLinearTolerance);
}

TEST(LinearBlend, VertexOfOneJointFollowsItsMatrix) {
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

TEST(LinearBlend, CrossSectionShrinksByTheCosine) {
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

TEST(LinearBlend, RejectsWeightsWithoutAMatrix) {
    const HalfTurned skin;
    EXPECT_THROW(linearBlend(skin.rest, skin.weights, {glm::dmat4(1.0)}), std::invalid_argument);
    EXPECT_THROW(linearBlend({{0, 0, 0}}, skin.weights, {glm::dmat4(1.0), glm::dmat4(1.0)}),
                 std::invalid_argument);
}

} // namespace
