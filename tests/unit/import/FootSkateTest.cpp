// SPDX-License-Identifier: MIT
// How far planted feet slide.
#include "Figure.h"
#include "Paths.h"

#include <osgSkinImport/ImportMotion>
#include <osgSkinImport/ImportSkeleton>
#include <osgSkinRig/Retarget>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

namespace {

using osgSkin::FootSkate;
using osgSkin::Motion;
using osgSkin::RestSkeleton;
using osgSkin::RetargetReport;

constexpr double kLeg = 8.0; ///< of makeFigure()

RetargetReport reportOf(const Motion& motion, const RestSkeleton& rig) {
    RetargetReport report;
    osgSkin::retarget(motion, rig, {}, &report);
    return report;
}

/// The figure sways over its fixed foot: hips on a circle around it, leg straight, sole flat.
Motion sway(std::size_t frames, double from, double to) {
    Motion motion = standStill(makeFigure(0.0), frames);
    for (std::size_t f = 0; f < frames; ++f) {
        const double a = from + (to - from) * double(f) / double(frames - 1);
        glm::dquat* turns = &motion.rotations[f * motion.skeleton.joints.size()];
        turns[8] = glm::angleAxis(a, glm::dvec3(0, 0, 1));
        turns[10] = glm::angleAxis(-a, glm::dvec3(0, 0, 1));
        motion.rootPositions[f] += glm::dvec3(-kLeg * std::sin(a), kLeg * (std::cos(a) - 1.0), 0);
    }
    return motion;
}

/// The leg's joints at other heights, with the same ankle and sole.
RestSkeleton withLeg(double hips, double upLeg, double knee) {
    RestSkeleton rig = makeFigure(0.0);
    for (const std::size_t j : {0u, 7u}) rig.joints[j].centre.y = hips;
    rig.joints[8].centre.y = upLeg;
    rig.joints[9].centre.y = knee;
    return rig;
}

TEST(FootSkate, IsZeroForAStandingFoot) {
    for (const double size : {1.0, 0.1, 30.0}) {
        const RetargetReport report = reportOf(sway(50, -0.2, 0.2), makeFigure(48.0, size));
        ASSERT_EQ(report.feet.size(), 1u);
        const FootSkate& foot = report.feet[0];
        EXPECT_EQ(foot.rigJoint, "LeftFoot");
        EXPECT_EQ(foot.motionJoint, "LeftFoot");
        EXPECT_NEAR(foot.leg, kLeg * size, 1e-9 * size);
        EXPECT_EQ(foot.contacts, 1u);
        EXPECT_EQ(foot.frames, 50u);
        for (const double slid : {foot.mean, foot.worst, foot.actorMean, foot.actorWorst})
            EXPECT_NEAR(slid, 0.0, 1e-9 * size);
    }
}

/// Hips as high as the actor's over shorter legs: the hips follow the path of the longer ones.
TEST(FootSkate, GrowsWithLegLengthDifference) {
    const FootSkate foot = reportOf(sway(50, -0.2, 0.2), withLeg(10, 7, 4)).feet.at(0);
    EXPECT_NEAR(foot.worst, (kLeg - 6.0) * 2.0 * std::sin(0.2), 1e-9);
    EXPECT_NEAR(foot.mean, foot.worst, 1e-12);
    EXPECT_NEAR(foot.actorWorst, 0.0, 1e-9);
    EXPECT_EQ(foot.leg, 6.0);
}

/// Legs as long as the actor's under higher hips: the path is scaled by more than the legs are.
TEST(FootSkate, GrowsWithHipScale) {
    const RetargetReport report = reportOf(sway(50, -0.2, 0.2), withLeg(12, 9, 5));
    EXPECT_NEAR(report.scale, 1.2, 1e-12);
    EXPECT_NEAR(report.feet.at(0).worst, 0.2 * kLeg * 2.0 * std::sin(0.2), 1e-9);
    EXPECT_NEAR(report.feet.at(0).actorWorst, 0.0, 1e-9);
}

TEST(FootSkate, ScalesTheActorsOwnSliding) {
    Motion motion = standStill(makeFigure(0.0), 51); // two seconds
    for (std::size_t f = 0; f < motion.frames; ++f) motion.rootPositions[f].z += 0.01 * double(f);
    const FootSkate foot = reportOf(motion, makeFigure(0.0, 0.5)).feet.at(0);
    EXPECT_EQ(foot.contacts, 1u);
    EXPECT_NEAR(foot.actorWorst, 0.25, 1e-9);
    EXPECT_NEAR(foot.worst, 0.25, 1e-9);
}

/// Stands, steps 3 ahead and 1 up in 0.4 s, and stands again; the second time with a slip of 0.2.
TEST(FootSkate, CountsContactsWithoutSteps) {
    Motion motion = standStill(makeFigure(0.0), 70);
    for (std::size_t f = 0; f < motion.frames; ++f) {
        const double share = std::clamp((double(f) - 30.0) / 10.0, 0.0, 1.0);
        motion.rootPositions[f] += glm::dvec3(0, std::sin(share * 3.14159265), 3.0 * share);
        if (f > 50) motion.rootPositions[f].x += std::min(0.2, 0.02 * double(f - 50));
    }
    const FootSkate foot = reportOf(motion, makeFigure(0.0)).feet.at(0);
    EXPECT_EQ(foot.contacts, 2u);
    EXPECT_NEAR(foot.worst, 0.2, 1e-9);
    EXPECT_NEAR(foot.mean, 0.1, 1e-9);
    EXPECT_GE(foot.worstFrame, 40u);
    EXPECT_LE(foot.worstFrame, 42u);
    EXPECT_NEAR(double(foot.frames), 59.0, 3.0);
}

TEST(FootSkate, NeedsALowFoot) {
    Motion motion = standStill(makeFigure(0.0), 100);
    for (std::size_t f = 0; f < 100; ++f)
        motion.rootPositions[f] += f < 50 ? glm::dvec3(0.001 * double(f), 0, 0)
                                          : glm::dvec3(0.01 * double(f), 0.06 * kLeg, 0);
    const FootSkate foot = reportOf(motion, makeFigure(0.0)).feet.at(0);
    EXPECT_EQ(foot.contacts, 1u);
    EXPECT_NEAR(foot.worst, 0.049, 1e-3);
}

TEST(FootSkate, ReportsMotionsWithoutContact) {
    const RetargetReport report = reportOf(standStill(makeFigure(0.0), 1), makeFigure(0.0));
    EXPECT_EQ(report.feet.at(0).contacts, 0u);
    EXPECT_EQ(report.feetText(), "foot LeftFoot: never planted\n");
    RestSkeleton legless = makeFigure(0.0);
    legless.joints.resize(7);
    EXPECT_TRUE(reportOf(standStill(legless, 9), legless).feet.empty());
}

TEST(FootSkate, IsPartOfTheReport) {
    RetargetReport report = reportOf(sway(50, -0.2, 0.2), withLeg(10, 7, 4));
    const std::string line = "foot LeftFoot: 1 contact, slides by 13.2 % of the leg in the mean, "
                             "13.2 % at worst (from frame 0); the actor's own: 0.0 %, 0.0 %\n";
    EXPECT_EQ(report.feetText(), line);
    EXPECT_NE(report.text().find(line), std::string::npos);
    FootSkate hanging;
    hanging.rigJoint = "RightFoot";
    report.feet.insert(report.feet.begin(), hanging);
    EXPECT_EQ(report.feetText(), "foot RightFoot: never planted\n" + line);
}

/// The values in the README's table: over all contacts of both feet, in hundredths of the leg.
struct Actor {
    const char* path; ///< below the shared data
    std::size_t skip; ///< calibration poses
    std::size_t contacts;
    double mean, worst, actorMean, actorWorst;
};

const Actor kActors[] = {
    {"cmu/mb/12_01_walk_pybvh.bvh", 1, 8, 4.0, 4.8, 2.3, 3.2},
    {"cmu/mb/01_01.bvh", 1, 32, 5.5, 9.4, 2.0, 5.1},
    {"cmu/mb/01_03.bvh", 1, 35, 2.9, 7.7, 2.4, 5.9},
    {"cmu/mb/124_01_pitch_excerpt_120hz.bvh", 1, 1, 2.3, 2.3, 1.4, 1.4},
    {"cmu/max/131_01.bvh", 1, 19, 2.2, 4.9, 2.4, 5.8},
    {"cmu/daz/02_05.bvh", 1, 70, 1.5, 3.3, 1.3, 2.3},
    {"cmu/daz/06_15.bvh", 1, 10, 2.5, 5.0, 1.4, 2.3},
    {"cmu/daz/13_30.bvh", 1, 44, 2.9, 10.0, 1.7, 4.5},
};

class FootSlidingOfActors : public testing::TestWithParam<Actor> {};

} // namespace

TEST_P(FootSlidingOfActors, MatchesTheReadme) {
    const Actor& expected = GetParam();
    const std::string rig = sharedData("makehuman/rig/cmu_mb_neutral.bvh");
    const std::string path = sharedData(expected.path);
    OSGSKIN_NEEDS(rig);
    OSGSKIN_NEEDS(path);
    const RetargetReport report =
        reportOf(osgSkin::importMotion(path, expected.skip), osgSkin::importSkeleton(rig));
    ASSERT_EQ(report.feet.size(), 2u);
    std::size_t contacts = 0;
    double mean = 0.0, worst = 0.0, actorMean = 0.0, actorWorst = 0.0;
    for (const FootSkate& foot : report.feet) {
        const double percent = 100.0 / foot.leg, count = double(foot.contacts);
        contacts += foot.contacts;
        mean += percent * foot.mean * count;
        actorMean += percent * foot.actorMean * count;
        worst = std::max(worst, percent * foot.worst);
        actorWorst = std::max(actorWorst, percent * foot.actorWorst);
    }
    ASSERT_GT(contacts, 0u);
    mean /= double(contacts);
    actorMean /= double(contacts);
    std::printf("%s: %zu contacts, slides %.1f %%, %.1f %%; the actor's own %.1f %%, %.1f %%\n",
                expected.path, contacts, mean, worst, actorMean, actorWorst);
    EXPECT_EQ(contacts, expected.contacts);
    EXPECT_NEAR(mean, expected.mean, 0.051);
    EXPECT_NEAR(worst, expected.worst, 0.051);
    EXPECT_NEAR(actorMean, expected.actorMean, 0.051);
    EXPECT_NEAR(actorWorst, expected.actorWorst, 0.051);
}

INSTANTIATE_TEST_SUITE_P(Files, FootSlidingOfActors, testing::ValuesIn(kActors),
                         [](const auto& tested) {
                             std::string name =
                                 std::filesystem::path(tested.param.path).stem().string();
                             return name.substr(0, name.find('_', 4));
                         });
