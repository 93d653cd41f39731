// SPDX-License-Identifier: MIT
// Retargeting of small figures, and of motions of CMU.
#include "ExpectError.h"
#include "Figure.h"
#include "JointIndex.h"
#include "Paths.h"

#include <osgSkinImport/ImportMotion>
#include <osgSkinImport/ImportSkeleton>
#include <osgSkinRig/Retarget>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace {

using osgSkin::Clip;
using osgSkin::Motion;
using osgSkin::RestSkeleton;
using osgSkin::RetargetReport;

/// Every joint rotates by a different angle; the root walks and hops.
Motion wave(const RestSkeleton& figure, std::size_t frames) {
    Motion motion = standStill(figure, frames);
    for (std::size_t f = 0; f < frames; ++f) {
        const double t = static_cast<double>(f);
        for (std::size_t j = 0; j < figure.joints.size(); ++j)
            motion.rotations[f * figure.joints.size() + j] =
                turnDegrees(20.0 * std::sin(t + static_cast<double>(j)),
                            {1.0, static_cast<double>(j % 3), 0.5});
        motion.rootPositions[f] += glm::dvec3(0.3 * t, 0.5 * std::sin(t), -0.1 * t);
    }
    return motion;
}

TEST(Retarget, ToTheSameSkeletonIsTheIdentity) {
    const RestSkeleton figure = makeFigure(30.0);
    const Motion motion = wave(figure, 40);
    RetargetReport report;
    const Clip clip = osgSkin::retarget(motion, figure, {}, &report);
    ASSERT_EQ(clip.frames, 40u);
    ASSERT_EQ(clip.joints, figure.joints.size());
    EXPECT_EQ(clip.frameTime, motion.frameTime);
    EXPECT_EQ(clip.name, motion.name);
    EXPECT_DOUBLE_EQ(report.scale, 1.0);
    for (std::size_t i = 0; i < clip.rotations.size(); ++i)
        EXPECT_LT(angleBetween(clip.rotations[i], motion.rotations[i]), 1e-6);
    for (std::size_t f = 0; f < clip.frames; ++f) {
        const glm::dvec3 shift = clip.rootPositions[f] - motion.rootPositions[f];
        EXPECT_LT(glm::length(shift - report.offset), 1e-9);
        EXPECT_NEAR(shift.x, 0.0, 1e-12);
        EXPECT_NEAR(shift.z, 0.0, 1e-12);
    }
}

TEST(Retarget, ZeroPoseGivesRestPose) {
    const RestSkeleton figure = makeFigure(30.0);
    const Clip clip = osgSkin::retarget(standStill(figure, 3), figure);
    for (const glm::dquat& q : clip.rotations) EXPECT_LT(angleBetween(q, {1, 0, 0, 0}), 1e-9);
    EXPECT_LT(glm::length(clip.rootPositions[2] - figure.joints[0].centre), 1e-9);
}

TEST(Retarget, AlignsLimbsOnly) {
    const RestSkeleton rig = makeFigure(48.0);
    RestSkeleton zeroPose = makeFigure(0.0);
    zeroPose.joints[2].centre.z += 1.0; // a head that leans: the trunk is not aligned to it
    zeroPose.joints[8].centre.x += 1.0; // broader hips, seen from a joint of zero length
    zeroPose.joints[9].centre.x += 1.0;
    zeroPose.joints[10].centre.x += 1.0;
    RetargetReport report;
    const Clip clip = osgSkin::retarget(standStill(zeroPose, 1), rig, {}, &report);
    const Placed placed = place(clip, rig, 0);
    struct Expected {
        const char* joint;
        double degrees;
    };
    for (const Expected& expected :
         {Expected{"Hips", 0.0}, Expected{"Spine", 0.0}, Expected{"Head", 0.0},
          Expected{"LeftShoulder", 0.0}, Expected{"LeftArm", 48.0}, Expected{"LeftForeArm", 48.0},
          Expected{"LeftHand", 48.0}, Expected{"LHipJoint", 0.0}, Expected{"LeftUpLeg", 0.0}}) {
        const std::size_t j = jointIndex(rig, expected.joint);
        EXPECT_NEAR(report.entries[j].alignmentDegrees, expected.degrees, 1e-9) << expected.joint;
        EXPECT_NEAR(angleBetween(placed.turns[j], {1, 0, 0, 0}), expected.degrees, 1e-9)
            << expected.joint;
    }
    const glm::dvec3 forearm =
        placed.places[jointIndex(rig, "LeftHand")] - placed.places[jointIndex(rig, "LeftForeArm")];
    EXPECT_LT(angleBetween(forearm, {1, 0, 0}), 1e-9);
}

TEST(Retarget, MissingJointsKeepTheirRestPose) {
    RestSkeleton rig = makeFigure(48.0);
    rig.joints[6].name = "LeftPaw";
    const Clip clip = osgSkin::retarget(standStill(makeFigure(0.0), 1), rig);
    EXPECT_LT(angleBetween(clip.rotations[6], {1, 0, 0, 0}), 1e-9);
}

TEST(Retarget, JointsWithoutADirectionFollowTheLimb) {
    RestSkeleton rig = makeFigure(48.0);
    RestSkeleton zeroPose = makeFigure(0.0);
    zeroPose.joints[6].tip.reset(); // the motion's hand has no length
    const Clip clip = osgSkin::retarget(standStill(zeroPose, 1), rig);
    EXPECT_LT(angleBetween(clip.rotations[6], {1, 0, 0, 0}), 1e-9);
}

/// Exporters write a bone of no length with rounding errors, in metres or in centimetres.
TEST(Retarget, IgnoresRoundingErrors) {
    for (const double unit : {0.01, 1.0, 100.0}) {
        RestSkeleton rig = makeFigure(48.0), zeroPose = makeFigure(0.0);
        zeroPose.joints[6].tip = zeroPose.joints[6].centre + glm::dvec3(0.0, 3e-7, 2e-7);
        for (RestSkeleton* skeleton : {&rig, &zeroPose})
            for (osgSkin::RestJoint& joint : skeleton->joints) {
                joint.centre *= unit;
                if (joint.tip) *joint.tip *= unit;
            }
        const Clip clip = osgSkin::retarget(standStill(zeroPose, 1), rig);
        EXPECT_LT(angleBetween(clip.rotations[6], {1, 0, 0, 0}), 1e-9) << unit;
    }
}

TEST(Retarget, HandsPointToTheFingers) {
    RestSkeleton rig = makeFigure(0.0);
    const glm::dvec3 hand = rig.joints[6].centre;
    rig.joints[6].tip.reset();
    rig.joints.push_back({"LeftThumb", 6, hand + glm::dvec3(0.3, 0, 1), {}});
    rig.joints.push_back({"LeftFingers", 6, hand + glm::dvec3(1, 0, 0), {}});
    RestSkeleton zeroPose = rig;
    zeroPose.joints[11].centre = hand + glm::dvec3(0, 0, 1);
    RetargetReport report;
    osgSkin::retarget(standStill(zeroPose, 1), rig, {}, &report);
    EXPECT_NEAR(report.entries[6].alignmentDegrees, 0.0, 1e-9);
}

TEST(Retarget, MapsNamesInOrder) {
    RestSkeleton rig = makeFigure(0.0);
    rig.joints[6].name = "LeftHandFinger1";
    rig.joints[5].name = "Elbow";
    RestSkeleton zeroPose = makeFigure(0.0);
    zeroPose.joints[6].name = "LFingers";
    Motion motion = standStill(zeroPose, 1);
    motion.rotations[5] = turnDegrees(30, {0, 0, 1});
    motion.rotations[6] = turnDegrees(20, {0, 0, 1});
    RetargetReport report;
    const Clip clip =
        osgSkin::retarget(motion, rig, {{{"Elbow", "LeftForeArm"}, {"Head", ""}}}, &report);
    EXPECT_EQ(report.entries[5].motionJoint, "LeftForeArm");
    EXPECT_EQ(report.entries[6].motionJoint, "LFingers");
    EXPECT_EQ(report.entries[2].motionJoint, "");
    EXPECT_EQ(report.unusedMotionJoints, std::vector<std::string>{"Head"});
    EXPECT_NEAR(angleBetween(clip.rotations[5], {1, 0, 0, 0}), 30.0, 1e-9);
    EXPECT_NEAR(angleBetween(clip.rotations[6], {1, 0, 0, 0}), 20.0, 1e-9);
}

TEST(Retarget, ScalesTranslationByHipHeight) {
    const RestSkeleton rig = makeFigure(0.0, 0.5);
    Motion motion = standStill(makeFigure(0.0), 2);
    motion.rootPositions[1] += glm::dvec3(4, 0, -2);
    RetargetReport report;
    const Clip clip = osgSkin::retarget(motion, rig, {}, &report);
    EXPECT_NEAR(report.scale, 0.5, 1e-12);
    EXPECT_LT(glm::length(clip.rootPositions[0] - glm::dvec3(0, 5, 0)), 1e-9);
    EXPECT_LT(glm::length(clip.rootPositions[1] - glm::dvec3(2, 5, -1)), 1e-9);
    EXPECT_LT(glm::length(clip.rootPositions[1] -
                          (report.scale * motion.rootPositions[1] + report.offset)),
              1e-9);
}

TEST(Retarget, IgnoresTheActorsOrigin) {
    const RestSkeleton rig = makeFigure(0.0, 0.5);
    RestSkeleton actor = makeFigure(0.0);
    const glm::dvec3 aside(3, 0, -2);
    for (osgSkin::RestJoint& joint : actor.joints) {
        joint.centre += aside;
        if (joint.tip) *joint.tip += aside;
    }
    Motion motion = standStill(actor, 2);
    motion.rootPositions[1] += glm::dvec3(4, 0, -2);
    const Clip clip = osgSkin::retarget(motion, rig);
    EXPECT_LT(glm::length(clip.rootPositions[0] - glm::dvec3(0, 5, 0)), 1e-9);
    EXPECT_LT(glm::length(clip.rootPositions[1] - glm::dvec3(2, 5, -1)), 1e-9);
}

TEST(Retarget, StandsOnTheRigsFloor) {
    const RestSkeleton rig = makeFigure(0.0);
    Motion motion = standStill(makeFigure(0.0), 100);
    for (std::size_t f = 0; f < 100; ++f) {
        motion.rootPositions[f].y += 7.0;              // the capture's own floor level
        if (f >= 60) motion.rootPositions[f].y += 5.0; // most of the time on a ladder
    }
    motion.rootPositions[10].y -= 3.0; // one bad sample
    const Clip clip = osgSkin::retarget(motion, rig);
    EXPECT_NEAR(clip.rootPositions[0].y, 10.0, 1e-9);
    EXPECT_NEAR(clip.rootPositions[99].y, 15.0, 1e-9);
}

/// A skeleton below an additional root, with every joint's index increased by one.
RestSkeleton onGround(const RestSkeleton& figure) {
    RestSkeleton rig;
    rig.joints.push_back({"Ground", -1, {0, 0, 0}, {}});
    for (osgSkin::RestJoint joint : figure.joints) {
        ++joint.parent;
        rig.joints.push_back(joint);
    }
    return rig;
}

TEST(Retarget, ExtraRootKeepsTheMotion) {
    const RestSkeleton rig = makeFigure(48.0);
    const Motion motion = wave(makeFigure(30.0), 20);
    const Clip with = osgSkin::retarget(motion, onGround(rig));
    const Clip without = osgSkin::retarget(motion, rig);
    for (std::size_t f = 0; f < without.frames; ++f)
        for (std::size_t j = 0; j < without.joints; ++j)
            ASSERT_LT(angleBetween(with.rotations[f * with.joints + j + 1],
                                   without.rotations[f * without.joints + j]),
                      1e-6)
                << rig.joints[j].name;
}

TEST(Retarget, RigMayHaveAnExtraRoot) {
    const RestSkeleton rig = onGround(makeFigure(0.0));
    Motion motion = standStill(makeFigure(0.0), 1);
    motion.rotations[0] = turnDegrees(90, {0, 1, 0});
    motion.rootPositions[0] += glm::dvec3(3, 0, 4);
    const Clip clip = osgSkin::retarget(motion, rig);
    const Placed placed = place(clip, rig, 0);
    EXPECT_LT(glm::length(placed.places[1] - glm::dvec3(3, 10, 4)), 1e-9);
    EXPECT_LT(angleBetween(clip.rotations[0], {1, 0, 0, 0}), 1e-9);
    EXPECT_NEAR(angleBetween(placed.turns[1], {1, 0, 0, 0}), 90.0, 1e-9);
}

TEST(RetargetNotes, ReportLimbsAtRest) {
    const RestSkeleton figure = makeFigure(0.0);
    RestSkeleton other = figure;
    RetargetReport report;
    osgSkin::retarget(standStill(figure, 1), figure, {}, &report);
    EXPECT_TRUE(report.notes.empty());

    other.joints[4].name = "Fin"; // the motion has another name for the upper arm
    osgSkin::retarget(standStill(other, 1), figure, {}, &report);
    ASSERT_EQ(report.notes.size(), 1u);
    EXPECT_EQ(report.notes[0].find("no motion data for \"LeftArm\" of the rig"), 0u)
        << report.notes[0];
    EXPECT_NE(report.text().find("note: no motion data"), std::string::npos);
    osgSkin::retarget(standStill(other, 1), figure, {{{"LeftArm", ""}}}, &report);
    EXPECT_TRUE(report.notes.empty()) << "wanted so";

    for (std::size_t j = 0; j < other.joints.size(); ++j)
        other.joints[j].name = "part" + std::to_string(j);
    other.joints[2].name = "Head";
    osgSkin::retarget(standStill(figure, 1), other, {}, &report);
    ASSERT_EQ(report.notes.size(), 1u);
    EXPECT_EQ(report.notes[0].find("the rig has no joint for \"Hips\", \"Spine\", "
                                   "\"LeftArm\", \"LeftForeArm\" and 4 more of the motion"),
              0u)
        << report.notes[0];

    RestSkeleton stranger = other;
    for (osgSkin::RestJoint& joint : stranger.joints) joint.name = "x" + joint.name;
    stranger.joints[2].name = "Head";
    osgSkin::retarget(standStill(stranger, 1), other, {}, &report);
    ASSERT_EQ(report.notes.size(), 1u);
    EXPECT_EQ(report.notes[0].find("only 1 of the rig's 11 joints match"), 0u) << report.notes[0];

    stranger = other;
    osgSkin::retarget(standStill(stranger, 1), other, {}, &report);
    EXPECT_TRUE(report.notes.empty());
    stranger.joints[5].name = "'part5'";
    osgSkin::retarget(standStill(stranger, 1), other, {}, &report);
    ASSERT_EQ(report.notes.size(), 1u);
    EXPECT_EQ(report.notes[0].find("no motion data for \"part5\" of the rig; \"'part5'\" of the "
                                   "motion not used; expected"),
              0u)
        << report.notes[0];

    other = figure;
    other.joints[2].name = "Top";
    osgSkin::retarget(standStill(other, 1), figure, {}, &report);
    ASSERT_EQ(report.notes.size(), 1u);
    EXPECT_EQ(report.notes[0].find("no motion data for \"Head\" of the rig"), 0u)
        << report.notes[0];
}

TEST(RetargetErrors, NameTheMismatch) {
    const RestSkeleton figure = makeFigure(0.0);
    const Motion motion = standStill(figure, 1);
    expectError(
        [&] {
            osgSkin::retarget(motion, figure, {{{"Tail", "Spine"}}});
        },
        "the map names the joint \"Tail\", which the rig does not have");
    expectError(
        [&] {
            osgSkin::retarget(motion, figure, {{{"Spine", "Tail"}}});
        },
        "\"Tail\", which the motion does not have");
    RestSkeleton stranger;
    stranger.joints.push_back({"Trunk", -1, {}, {}});
    expectError([&] { osgSkin::retarget(motion, stranger); }, "no joint of the rig has a joint");
    expectError([&] { osgSkin::retarget(motion, {}); }, "skeleton: no joint");
}

using osgSkin::Clip;
using osgSkin::Motion;
using osgSkin::RestSkeleton;

struct Limb {
    const char* from;
    const char* to;
};

constexpr Limb kLimbs[] = {
    {"Arm", "ForeArm"}, {"ForeArm", "Hand"}, {"UpLeg", "Leg"}, {"Leg", "Foot"}};

class CmuClip : public testing::TestWithParam<const char*> {
protected:
    void SetUp() override {
        const std::string rigPath = sharedData("makehuman/rig/cmu_mb_neutral.bvh");
        const std::string path = sharedData(std::string("cmu/mb/") + GetParam());
        OSGSKIN_NEEDS(rigPath);
        OSGSKIN_NEEDS(path);
        rig = osgSkin::importSkeleton(rigPath);
        motion = osgSkin::importMotion(path, 1);
        osgSkin::RetargetOptions options;
        options.collarsFollow = false;
        clip = osgSkin::retarget(motion, rig, options, &report);
    }

    RestSkeleton rig;
    Motion motion;
    Clip clip;
    osgSkin::RetargetReport report;
};

TEST_P(CmuClip, LimbsPointWhereTheMotionsLimbsPoint) {
    for (std::size_t f = 0; f < clip.frames; f += 7) {
        const Placed ours = place(clip, rig, f);
        const Placed theirs = place(motion, f);
        for (const char* side : {"Left", "Right"})
            for (const Limb& bone : kLimbs) {
                const std::string from = std::string(side) + bone.from;
                const std::string to = std::string(side) + bone.to;
                const glm::dvec3 a =
                    ours.places[jointIndex(rig, to)] - ours.places[jointIndex(rig, from)];
                const glm::dvec3 b = theirs.places[jointIndex(motion.skeleton, to)] -
                                     theirs.places[jointIndex(motion.skeleton, from)];
                ASSERT_LT(angleBetween(a, b), 0.1) << from << ", frame " << f;
            }
    }
}

/// The rig's sole is as flat as the motion's, whatever the slopes of the two skeletons' foot bones.
TEST_P(CmuClip, FeetKeepTheirHeading) {
    for (const std::string name : {"LeftFoot", "RightFoot"}) {
        const auto ours = static_cast<std::size_t>(rig.find(name));
        for (std::size_t f = 0; f < clip.frames; f += 7) {
            const glm::dvec3 up(0, 1, 0); // the sole's normal at rest
            ASSERT_LT(angleBetween(place(clip, rig, f).turns[ours] * up,
                                   place(motion, f).turns[jointIndex(motion.skeleton, name)] * up),
                      1e-3)
                << name << ", frame " << f;
        }
    }
}

TEST_P(CmuClip, TrunkTurnsWithTheMotion) {
    for (std::size_t f = 0; f < clip.frames; f += 7) {
        const Placed ours = place(clip, rig, f);
        const Placed theirs = place(motion, f);
        for (const char* name : {"Hips", "Spine", "Spine1", "Neck", "Head", "LeftShoulder"})
            ASSERT_LT(angleBetween(ours.turns[jointIndex(rig, name)],
                                   theirs.turns[jointIndex(motion.skeleton, name)]),
                      1e-3)
                << name << ", frame " << f;
    }
}

TEST_P(CmuClip, MapsEveryRigJoint) {
    for (const osgSkin::RetargetReport::Entry& entry : report.entries)
        EXPECT_FALSE(entry.motionJoint.empty()) << entry.rigJoint;
    EXPECT_TRUE(report.unusedMotionJoints.empty());
}

INSTANTIATE_TEST_SUITE_P(Files, CmuClip,
                         testing::Values("12_01_walk_pybvh.bvh", "01_01.bvh",
                                         "124_01_pitch_excerpt_120hz.bvh"),
                         [](const auto& file) {
                             return "clip" + std::string(file.param).substr(0, 5);
                         });

class CmuWalk : public CmuClip {};

TEST_P(CmuWalk, FeetStandOnTheFloorOfTheRestPose) {
    constexpr double bodyHeight = 16.4; // decimetres
    const std::size_t feet[] = {jointIndex(rig, "LeftFoot"), jointIndex(rig, "RightFoot"),
                                jointIndex(rig, "LeftToeBase"), jointIndex(rig, "RightToeBase")};
    for (std::size_t f = 0; f < clip.frames; ++f) {
        const Placed placed = place(clip, rig, f);
        double lowest = 1e9;
        for (const std::size_t j : feet)
            lowest = std::min(lowest, placed.places[j].y - rig.joints[j].centre.y);
        ASSERT_LT(std::abs(lowest), 0.03 * bodyHeight) << "frame " << f;
    }
}

TEST_P(CmuWalk, HandsHangBelowTheShoulders) {
    for (std::size_t f = 0; f < clip.frames; ++f) {
        const Placed placed = place(clip, rig, f);
        for (const char* side : {"Left", "Right"})
            ASSERT_LT(placed.places[jointIndex(rig, std::string(side) + "Hand")].y,
                      placed.places[jointIndex(rig, std::string(side) + "Arm")].y - 2.0)
                << side << ", frame " << f;
    }
}

INSTANTIATE_TEST_SUITE_P(Files, CmuWalk, testing::Values("12_01_walk_pybvh.bvh"));

} // namespace
