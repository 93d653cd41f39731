// SPDX-License-Identifier: MIT
// Twist that an elbow or a knee cannot have is distributed along the limb.
#include "Figure.h"

#include <osgSkinRig/Retarget>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

namespace {

using osgSkin::Clip;
using osgSkin::Motion;
using osgSkin::RestSkeleton;
using osgSkin::RetargetReport;

/// Joints of makeFigure().
constexpr std::size_t kArm = 4, kForeArm = 5, kHand = 6, kUpLeg = 8, kLowerLeg = 9, kFoot = 10;

/// A limb of a figure.
struct Limb {
    const char* name;
    std::size_t upper, hinge, end;
    double bentAtRest; ///< degrees
};

constexpr Limb kLimbs[] = {{"Elbow", kArm, kForeArm, kHand, 0.0},
                           {"Knee", kUpLeg, kLowerLeg, kFoot, 0.0},
                           {"ElbowBentAtRest", kArm, kForeArm, kHand, 40.0}};

RestSkeleton figureWith(const Limb& limb) {
    RestSkeleton figure = makeFigure(0.0);
    const glm::dvec3 hinge = figure.joints[limb.hinge].centre;
    const glm::dquat bend = turnDegrees(limb.bentAtRest, {0, 1, 0});
    figure.joints[limb.end].centre = hinge + bend * (figure.joints[limb.end].centre - hinge);
    figure.joints[limb.end].tip = hinge + bend * (*figure.joints[limb.end].tip - hinge);
    return figure;
}

glm::dvec3 boneOf(const RestSkeleton& figure, std::size_t from, std::size_t to) {
    return glm::normalize(figure.joints[to].centre - figure.joints[from].centre);
}

double twistOf(const Clip& clip, std::size_t frame, std::size_t joint, const glm::dvec3& axis) {
    const glm::dquat& q = clip.rotations[frame * clip.joints + joint];
    const double sine = glm::dot(axis, glm::dvec3(q.x, q.y, q.z));
    return glm::degrees(2.0 * (q.w < 0.0 ? std::atan2(-sine, -q.w) : std::atan2(sine, q.w)));
}

/// A limb's twists in one sample: upper joint, hinge, end.
std::vector<double> twistsOf(const Clip& clip, const RestSkeleton& figure, const Limb& limb,
                             std::size_t frame) {
    const glm::dvec3 lower = boneOf(figure, limb.hinge, limb.end);
    return {twistOf(clip, frame, limb.upper, boneOf(figure, limb.upper, limb.hinge)),
            twistOf(clip, frame, limb.hinge, lower), twistOf(clip, frame, limb.end, lower)};
}

/// A motion with the hinge bent and twisted by these degrees, one per sample.
Motion twisted(const RestSkeleton& figure, const Limb& limb, const std::vector<double>& degrees,
               double bend = 50.0) {
    Motion motion = standStill(figure, degrees.size());
    const glm::dvec3 lower = boneOf(figure, limb.hinge, limb.end);
    const glm::dvec3 across =
        glm::cross(lower, std::abs(lower.y) < 0.5 ? glm::dvec3(0, 1, 0) : glm::dvec3(1, 0, 0));
    for (std::size_t f = 0; f < degrees.size(); ++f) {
        glm::dquat* local = &motion.rotations[f * figure.joints.size()];
        local[limb.upper] = turnDegrees(20.0, {0.3, 1, 0.5});
        local[limb.hinge] = turnDegrees(bend, across) * turnDegrees(degrees[f], lower);
        local[limb.end] = turnDegrees(15.0, {0, 1, 1});
    }
    return motion;
}

std::vector<double> range(double from, double to, double step) {
    std::vector<double> result;
    for (double x = from; x <= to; x += step) result.push_back(x);
    return result;
}

Clip unshared(const Motion& motion, const RestSkeleton& figure) {
    osgSkin::RetargetOptions options;
    options.shareTwist = false;
    return osgSkin::retarget(motion, figure, options);
}

/// Expects unchanged joint positions, and unchanged orientations except for the two joints that
/// twist.
void expectSamePose(const Clip& clip, const Clip& before, const RestSkeleton& figure,
                    const std::vector<std::size_t>& twisting) {
    for (std::size_t f = 0; f < clip.frames; ++f) {
        const Placed now = place(clip, figure, f), then = place(before, figure, f);
        for (std::size_t j = 0; j < clip.joints; ++j) {
            ASSERT_LT(glm::length(now.places[j] - then.places[j]), 1e-6) << f << ", joint " << j;
            if (std::count(twisting.begin(), twisting.end(), j) > 0) continue;
            ASSERT_LT(angleBetween(now.turns[j], then.turns[j]), 1e-6) << f << ", joint " << j;
        }
    }
}

class HingeTwist : public testing::TestWithParam<Limb> {};

TEST_P(HingeTwist, DistributesHalfATurnWithoutJumps) {
    const Limb& limb = GetParam();
    const RestSkeleton figure = figureWith(limb);
    const Motion motion = twisted(figure, limb, range(170.0, 190.0, 0.5));
    RetargetReport report;
    const Clip clip = osgSkin::retarget(motion, figure, {}, &report);
    expectSamePose(clip, unshared(motion, figure), figure, {limb.upper, limb.hinge});
    std::vector<double> before;
    for (std::size_t f = 0; f < clip.frames; ++f) {
        const std::vector<double> twists = twistsOf(clip, figure, limb, f);
        EXPECT_NEAR(std::abs(twists[1]), 90.0, 1e-6) << f;
        for (std::size_t i = 0; i < twists.size(); ++i) {
            EXPECT_LT(std::abs(twists[i]), 100.0) << f;
            if (f == 0) continue;
            EXPECT_LT(std::abs(twists[i] - before[i]), 1.0) << f << ", twist " << i;
        }
        before = twists;
    }
    EXPECT_EQ(report.entries[limb.hinge].twistShared, clip.frames);
    EXPECT_EQ(report.entries[limb.upper].twistShared, 0u);
    EXPECT_NE(report.text().find("twisted by more than 90 degrees in 41 samples"),
              std::string::npos);
}

TEST_P(HingeTwist, KeepsAnglesUpTo90Degrees) {
    const Limb& limb = GetParam();
    const RestSkeleton figure = figureWith(limb);
    const Motion motion = twisted(figure, limb, range(-89.0, 89.0, 1.0));
    RetargetReport report;
    const Clip clip = osgSkin::retarget(motion, figure, {}, &report);
    EXPECT_EQ(clip.rotations, unshared(motion, figure).rotations);
    EXPECT_EQ(report.entries[limb.hinge].twistShared, 0u);
}

TEST_P(HingeTwist, IsContinuousAt90Degrees) {
    const Limb& limb = GetParam();
    const RestSkeleton figure = figureWith(limb);
    for (const double sign : {-1.0, 1.0}) {
        std::vector<double> degrees = range(60.0, 260.0, 1.0);
        for (double& angle : degrees) angle *= sign;
        const Motion motion = twisted(figure, limb, degrees);
        const Clip clip = osgSkin::retarget(motion, figure);
        expectSamePose(clip, unshared(motion, figure), figure, {limb.upper, limb.hinge});
        for (std::size_t f = 1; f < clip.frames; ++f)
            for (std::size_t j = 0; j < clip.joints; ++j)
                ASSERT_LT(angleBetween(clip.rotations[(f - 1) * clip.joints + j],
                                       clip.rotations[f * clip.joints + j]),
                          2.5)
                    << sign * degrees[f] << " degrees, joint " << j;
    }
}

INSTANTIATE_TEST_SUITE_P(Limbs, HingeTwist, testing::ValuesIn(kLimbs),
                         [](const auto& limb) { return std::string(limb.param.name); });

TEST(HingeTwist, GoesToTheJointWithLessTwist) {
    const Limb& elbow = kLimbs[0];
    const RestSkeleton figure = figureWith(elbow);
    Motion motion = twisted(figure, elbow, {150.0});
    motion.rotations[kArm] = glm::dquat(1, 0, 0, 0);
    const glm::dvec3 along(1, 0, 0);
    motion.rotations[kHand] = turnDegrees(80.0, along); // more than the whole excess
    std::vector<double> twists = twistsOf(osgSkin::retarget(motion, figure), figure, elbow, 0);
    EXPECT_NEAR(twists[0], 60.0, 1e-6);
    EXPECT_NEAR(twists[2], 80.0, 1e-6);
    motion.rotations[kHand] = turnDegrees(20.0, along); // both become 40
    twists = twistsOf(osgSkin::retarget(motion, figure), figure, elbow, 0);
    EXPECT_NEAR(twists[0], 40.0, 1e-6);
    EXPECT_NEAR(twists[2], 40.0, 1e-6);
    motion.rotations[kHand] = turnDegrees(-70.0, along); // it unwinds
    twists = twistsOf(osgSkin::retarget(motion, figure), figure, elbow, 0);
    EXPECT_NEAR(twists[0], 0.0, 1e-6);
    EXPECT_NEAR(twists[2], -10.0, 1e-6);
}

TEST(HingeTwist, CrossesTwistJointsOfTheUpperArm) {
    RestSkeleton figure = makeFigure(0.0);
    // LeftArm -> LeftArmRoll -> LeftForeArm, and a muscle bone below the arm.
    figure.joints.insert(figure.joints.begin() + 5, {"LeftArmRoll", 4, {3.5, 15, 0}, {}});
    for (std::size_t j = 6; j < figure.joints.size(); ++j)
        if (figure.joints[j].parent >= 5 || j == 6) ++figure.joints[j].parent;
    figure.joints.push_back({"LeftBiceps", 4, {3, 15.3, 0}, glm::dvec3(4, 15.3, 0)});
    const Limb limb{"", 4, 6, 7, 0.0};
    const Motion motion = twisted(figure, limb, range(100.0, 185.0, 5.0));
    const Clip clip = osgSkin::retarget(motion, figure);
    const Clip before = unshared(motion, figure);
    const std::size_t muscle = figure.joints.size() - 1;
    for (std::size_t f = 0; f < clip.frames; ++f) {
        const Placed now = place(clip, figure, f), then = place(before, figure, f);
        for (std::size_t j = 0; j < muscle; ++j)
            ASSERT_LT(glm::length(now.places[j] - then.places[j]), 1e-6) << f << ", joint " << j;
        ASSERT_LT(angleBetween(now.turns[7], then.turns[7]), 1e-6);
        // Everything attached to the upper arm twists with it.
        ASSERT_LT(angleBetween(now.turns[4], now.turns[muscle]), 1e-6);
        ASSERT_GT(angleBetween(now.turns[4], then.turns[4]), 1.0);
        ASSERT_LT(std::abs(twistsOf(clip, figure, limb, f)[1]), 90.0 + 1e-6);
    }
}

TEST(HingeTwist, StartsWithTheShorterAngle) {
    // All samples beyond 180 degrees: 200 degrees become -160.
    const Limb& elbow = kLimbs[0];
    const RestSkeleton figure = figureWith(elbow);
    const Motion motion = twisted(figure, elbow, range(200.0, 220.0, 1.0));
    const Clip clip = osgSkin::retarget(motion, figure);
    for (std::size_t f = 0; f < clip.frames; ++f)
        EXPECT_NEAR(twistsOf(clip, figure, elbow, f)[1], -90.0, 1e-6);
}

} // namespace
