// SPDX-License-Identifier: MIT
//
// Twist that an elbow or a knee cannot have is distributed along the limb.
#include "Figure.h"
#include "Paths.h"

#include <osgSkinImport/ImportMotion>
#include <osgSkinImport/ImportSkeleton>
#include <osgSkinRig/Retarget>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <string>
#include <vector>

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

TEST(FootSkate, OfAFootThatStandsIsNone) {
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
TEST(FootSkate, OfAnotherLegIsWhatItsLengthLacks) {
    const FootSkate foot = reportOf(sway(50, -0.2, 0.2), withLeg(10, 7, 4)).feet.at(0);
    EXPECT_NEAR(foot.worst, (kLeg - 6.0) * 2.0 * std::sin(0.2), 1e-9);
    EXPECT_NEAR(foot.mean, foot.worst, 1e-12);
    EXPECT_NEAR(foot.actorWorst, 0.0, 1e-9);
    EXPECT_EQ(foot.leg, 6.0);
}

/// Legs as long as the actor's under higher hips: the path is scaled by more than the legs are.
TEST(FootSkate, OfAnotherHipScaleIsWhatTheWayHasTooMuch) {
    const RetargetReport report = reportOf(sway(50, -0.2, 0.2), withLeg(12, 9, 5));
    EXPECT_NEAR(report.scale, 1.2, 1e-12);
    EXPECT_NEAR(report.feet.at(0).worst, 0.2 * kLeg * 2.0 * std::sin(0.2), 1e-9);
    EXPECT_NEAR(report.feet.at(0).actorWorst, 0.0, 1e-9);
}

TEST(FootSkate, OfTheActorsOwnIsScaledToTheRig) {
    Motion motion = standStill(makeFigure(0.0), 51); // two seconds
    for (std::size_t f = 0; f < motion.frames; ++f) motion.rootPositions[f].z += 0.01 * double(f);
    const FootSkate foot = reportOf(motion, makeFigure(0.0, 0.5)).feet.at(0);
    EXPECT_EQ(foot.contacts, 1u);
    EXPECT_NEAR(foot.actorWorst, 0.25, 1e-9);
    EXPECT_NEAR(foot.worst, 0.25, 1e-9);
}

/// Stands, steps 3 ahead and 1 up in 0.4 s, and stands again; the second time with a slip of 0.2.
TEST(FootSkate, CountsContactsAndNotTheStepBetween) {
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

TEST(FootSkate, SaysWhereNothingStands) {
    const RetargetReport report = reportOf(standStill(makeFigure(0.0), 1), makeFigure(0.0));
    EXPECT_EQ(report.feet.at(0).contacts, 0u);
    EXPECT_EQ(report.feetText(), "foot LeftFoot: never planted\n");
    RestSkeleton legless = makeFigure(0.0);
    legless.joints.resize(7);
    EXPECT_TRUE(reportOf(standStill(legless, 9), legless).feet.empty());
}

TEST(FootSkate, IsInTheReportsText) {
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

TEST_P(FootSlidingOfActors, IsAsTheReadmeSays) {
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

TEST_P(HingeTwist, OfHalfATurnIsSharedOutWithoutAJump) {
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

TEST_P(HingeTwist, UpToARightAngleStaysToTheLastBit) {
    const Limb& limb = GetParam();
    const RestSkeleton figure = figureWith(limb);
    const Motion motion = twisted(figure, limb, range(-89.0, 89.0, 1.0));
    RetargetReport report;
    const Clip clip = osgSkin::retarget(motion, figure, {}, &report);
    EXPECT_EQ(clip.rotations, unshared(motion, figure).rotations);
    EXPECT_EQ(report.entries[limb.hinge].twistShared, 0u);
}

TEST_P(HingeTwist, DoesNotJumpWhereTheExcessBegins) {
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

TEST(HingeTwist, GoesToTheJointThatHasLess) {
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

TEST(HingeTwist, PassesThroughJointsWithinTheUpperArm) {
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

TEST(HingeTwist, BeginsWithTheShorterAngle) {
    // All samples beyond 180 degrees: 200 degrees become -160.
    const Limb& elbow = kLimbs[0];
    const RestSkeleton figure = figureWith(elbow);
    const Motion motion = twisted(figure, elbow, range(200.0, 220.0, 1.0));
    const Clip clip = osgSkin::retarget(motion, figure);
    for (std::size_t f = 0; f < clip.frames; ++f)
        EXPECT_NEAR(twistsOf(clip, figure, elbow, f)[1], -90.0, 1e-6);
}

} // namespace
