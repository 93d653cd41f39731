// SPDX-License-Identifier: MIT
#include "Turns.h"

#include <osgSkin/BendTwist>
#include <osgSkin/Error>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

using osgSkin::BendTwist;
using osgSkin::partialRotation;
using osgSkin::splitBendTwist;

namespace {

const double kPi = glm::pi<double>();
const double kNan = std::numeric_limits<double>::quiet_NaN();
const double kInf = std::numeric_limits<double>::infinity();

glm::dquat turn(const glm::dvec3& axis, double angle) {
    return glm::angleAxis(angle, axis);
}

/// Distance between two rotations as quaternions, up to sign.
double distance(const glm::dquat& a, const glm::dquat& b) {
    const auto length = [](const glm::dquat& q) { return std::sqrt(glm::dot(q, q)); };
    return std::min(length(a - b), length(a + b));
}

double recompositionError(const glm::dquat& q, const glm::dvec3& pole) {
    const BendTwist split = splitBendTwist(q, pole);
    return distance(partialRotation(split, pole, 1.0, 1.0), glm::normalize(q));
}

bool isFinite(const BendTwist& s) {
    return std::isfinite(s.bendAngle) && std::isfinite(s.twistAngle) &&
           std::isfinite(s.bendAxis.x) && std::isfinite(s.bendAxis.y) &&
           std::isfinite(s.bendAxis.z);
}

} // namespace

TEST(BendTwist, RecomposesAMillionRandomRotations) {
    std::mt19937_64 random(1);
    double recomposition = 0.0;
    double perpendicular = 0.0;
    for (int i = 0; i < 1000000; ++i) {
        const glm::dquat q = test::randomRotation(random);
        const glm::dvec3 w = test::randomUnit(random);
        const BendTwist split = splitBendTwist(q, w);
        recomposition = std::max(recomposition, distance(partialRotation(split, w, 1.0, 1.0), q));
        perpendicular = std::max(perpendicular, std::abs(glm::dot(split.bendAxis, w)));
        ASSERT_GE(split.bendAngle, 0.0);
        ASSERT_LE(split.bendAngle, kPi);
        ASSERT_LE(std::abs(split.twistAngle), kPi);
        ASSERT_NEAR(glm::length(split.bendAxis), 1.0, 1e-12);
    }
    EXPECT_LE(recomposition, 1e-12);
    EXPECT_LE(perpendicular, 1e-12);
}

TEST(BendTwist, RecomposesNearEdgeCases) {
    std::mt19937_64 random(2);
    for (const double gap : {1e-3, 1e-6, 1e-9, 1e-12, 1e-15, 1e-30, 0.0})
        for (const double bend : {gap, kPi - gap, kPi / 2})
            for (const double twist : {gap, -gap, kPi - gap, -kPi + gap, 1.0})
                for (int i = 0; i < 50; ++i) {
                    const glm::dvec3 w = test::randomUnit(random);
                    const glm::dvec3 v = glm::normalize(glm::cross(w, test::randomUnit(random)));
                    const glm::dquat q = turn(v, bend) * turn(w, twist);
                    const BendTwist split = splitBendTwist(q, w);
                    ASSERT_TRUE(isFinite(split)) << bend << ' ' << twist;
                    ASSERT_LE(std::abs(glm::dot(split.bendAxis, w)), 1e-12);
                    ASSERT_LE(recompositionError(q, w), 1e-12) << bend << ' ' << twist;
                }
}

TEST(BendTwist, SplitsEdgeCasesExactly) {
    const glm::dvec3 w(0, 1, 0);
    struct Case {
        const char* name;
        glm::dquat q;
        double bend, twist;
    };
    const Case cases[] = {
        {"identity", {1, 0, 0, 0}, 0, 0},
        {"360 degrees", {-1, 0, 0, 0}, 0, 0},
        {"twist of 180 degrees", {0, 0, 1, 0}, 0, kPi},
        {"twist of -180 degrees", {0, 0, -1, 0}, 0, kPi},
        {"bend of 180 degrees", {0, 1, 0, 0}, kPi, 0},
        {"bend of 180 degrees about z", {0, 0, 0, -1}, kPi, 0},
        {"twist of 90 degrees", {std::sqrt(0.5), 0, std::sqrt(0.5), 0}, 0, kPi / 2},
        {"bend of 90 degrees", {std::sqrt(0.5), std::sqrt(0.5), 0, 0}, kPi / 2, 0},
    };
    for (const Case& c : cases) {
        const BendTwist split = splitBendTwist(c.q, w);
        EXPECT_NEAR(split.bendAngle, c.bend, 1e-15) << c.name;
        EXPECT_NEAR(split.twistAngle, c.twist, 1e-15) << c.name;
        EXPECT_EQ(glm::dot(split.bendAxis, w), 0.0) << c.name;
        EXPECT_LE(recompositionError(c.q, w), 1e-15) << c.name;
    }
}

TEST(BendTwist, NegatedQuaternionIsTheSameRotation) {
    std::mt19937_64 random(3);
    for (int i = 0; i < 10000; ++i) {
        glm::dquat q = test::randomRotation(random);
        if (i % 4 == 1) q = glm::dquat(0, glm::normalize(glm::dvec3(q.x, q.y, q.z)));
        const glm::dvec3 w = i % 4 == 2 ? glm::dvec3(0, 0, 1) : test::randomUnit(random);
        const BendTwist a = splitBendTwist(q, w);
        const BendTwist b = splitBendTwist(-q, w);
        ASSERT_EQ(a.bendAngle, b.bendAngle);
        ASSERT_EQ(a.twistAngle, b.twistAngle);
        ASSERT_EQ(a.bendAxis, b.bendAxis);
    }
}

TEST(BendTwist, AcceptsQuaternionsOfAnyLength) {
    std::mt19937_64 random(4);
    for (const double scale : {1e-300, 1e-30, 0.5, 3.0, 1e30, 1e300}) {
        const glm::dquat q = test::randomRotation(random);
        const glm::dvec3 w = test::randomUnit(random);
        const BendTwist a = splitBendTwist(q, w);
        const BendTwist b = splitBendTwist(q * scale, w);
        EXPECT_NEAR(a.bendAngle, b.bendAngle, 1e-12) << scale;
        EXPECT_NEAR(a.twistAngle, b.twistAngle, 1e-12) << scale;
    }
}

TEST(BendTwist, RejectsInvalidRotationsAndPoles) {
    const glm::dvec3 w(0, 1, 0);
    const glm::dquat good(1, 0, 0, 0);
    for (const double bad : {kNan, kInf, -kInf}) {
        for (int part = 0; part < 4; ++part) {
            glm::dquat q = good;
            q[part] = bad;
            EXPECT_THROW(splitBendTwist(q, w), osgSkin::Error);
        }
        for (int axis = 0; axis < 3; ++axis) {
            glm::dvec3 pole = w;
            pole[axis] = bad;
            EXPECT_THROW(splitBendTwist(good, pole), osgSkin::Error);
        }
    }
    EXPECT_THROW(splitBendTwist(glm::dquat(0, 0, 0, 0), w), osgSkin::Error);
    EXPECT_THROW(splitBendTwist(good, glm::dvec3(0)), osgSkin::Error);
    EXPECT_THROW(splitBendTwist(good, glm::dvec3(0, 2, 0)), osgSkin::Error);

    BendTwist untouched{{0, 0, 1}, 0.5, 0.25};
    EXPECT_FALSE(osgSkin::trySplitBendTwist(glm::dquat(kNan, 0, 0, 0), w, untouched));
    EXPECT_EQ(untouched.bendAngle, 0.5);
    EXPECT_EQ(untouched.twistAngle, 0.25);
}

TEST(BendTwist, PartialRotationScalesTheAngles) {
    const glm::dvec3 w(0, 1, 0);
    const glm::dvec3 v(1, 0, 0);
    const BendTwist split = splitBendTwist(turn(v, 1.2) * turn(w, -0.8), w);
    EXPECT_NEAR(split.bendAngle, 1.2, 1e-14);
    EXPECT_NEAR(split.twistAngle, -0.8, 1e-14);
    EXPECT_EQ(distance(partialRotation(split, w, 0.0, 0.0), glm::dquat(1, 0, 0, 0)), 0.0);
    EXPECT_LE(distance(partialRotation(split, w, 0.5, 0.25), turn(v, 0.6) * turn(w, -0.2)), 1e-14);
}
