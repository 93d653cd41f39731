// SPDX-License-Identifier: MIT
#include "WalkedPath.h"

#include <osgSkin/Error>

#include <osg/ComputeBoundsVisitor>

#include <gtest/gtest.h>

#include <string>

namespace {

using osgSkin::Gaits;
using osgSkin::WalkerOptions;
using osgSkin::WalkerReport;

Gaits::Gait gaitOf(const walking::GaitOf& gait) {
    const osg::ref_ptr<osg::Group> figure =
        walking::makeFigure({walking::idleClip(), walking::gaitClip(gait)});
    WalkerOptions options;
    options.walking = gait.name;
    return osgSkin::makeWalker(*figure, options)->getGaits()->get().walking;
}

TEST(MakeWalker, MeasuresTheStride) {
    const Gaits::Gait walk = gaitOf(walking::walk()), run = gaitOf(walking::run());
    EXPECT_NEAR(walk.stride, walking::kWalkStride, 0.01);
    EXPECT_NEAR(walk.clip->duration(), walking::kWalkTime, 0.02);
    EXPECT_NEAR(run.stride, walking::kRunStride, 0.02);
    EXPECT_NEAR(run.speed(), walking::kRunStride / walking::kRunTime, 0.1);
}

TEST(MakeWalker, MeasuresTheStrideOfClipsOnTheSpot) {
    walking::GaitOf walk = walking::walk(), run = walking::run();
    walk.isOnTheSpot = run.isOnTheSpot = true;
    EXPECT_NEAR(gaitOf(walk).stride, walking::kWalkStride, 0.05);
    EXPECT_NEAR(gaitOf(run).stride, walking::kRunStride, 0.1);
}

TEST(MakeWalker, CutsOneCycleOutOfALongClip) {
    walking::GaitOf walk = walking::walk();
    walk.cycles = 3.3;
    EXPECT_NEAR(gaitOf(walk).stride, walking::kWalkStride, 0.03);
    walk.cycles = 4.0;
    walk.isOnTheSpot = true;
    EXPECT_NEAR(gaitOf(walk).stride, walking::kWalkStride, 0.05);
}

TEST(MakeWalker, TakesWaysInAnyDirection) {
    walking::GaitOf walk = walking::walk();
    walk.direction = 2.0;
    walk.cycles = 2.5;
    EXPECT_NEAR(gaitOf(walk).stride, walking::kWalkStride, 0.03);
}

TEST(MakeWalker, FindsWhenFeetCarry) {
    const Gaits::Gait walk = gaitOf(walking::walk());
    for (const Gaits::Contact& contact : walk.contacts) {
        const double share = contact.end - contact.begin;
        EXPECT_NEAR(share - std::floor(share), 0.6, 0.12);
    }
    // The left foot is in front at the cycle's start, and carries from then on.
    EXPECT_LT(std::abs(std::remainder(walk.contacts[0].begin, 1.0)), 0.1);
    EXPECT_NEAR(walk.contacts[1].begin, 0.5, 0.1);
}

TEST(MakeWalker, FindsClipsByTheirNames) {
    const osg::ref_ptr<osg::Group> figure =
        walking::makeFigure({walking::gaitClip(walking::run()), walking::idleClip(),
                             walking::gaitClip(walking::walk())});
    WalkerReport report;
    osgSkin::makeWalker(*figure, {}, &report);
    EXPECT_EQ(report.walking, "walk");
    EXPECT_EQ(report.running, "run");
    EXPECT_EQ(report.standing, "idle");
    EXPECT_NEAR(report.walkSpeed, 1.5, 0.05);
    EXPECT_LT(report.walkSlide, 0.02);
}

TEST(MakeWalker, TakesTheShortestNameAndTheCalmestClip) {
    std::vector<osgSkin::Clip> clips;
    for (const char* name : {"2H_Melee_Idle", "Idle", "Walking_Backwards", "Walking_A"}) {
        const bool walks = std::string(name).find("Walk") == 0;
        clips.push_back(walks ? walking::gaitClip(walking::walk()) : walking::idleClip());
        clips.back().name = name;
    }
    WalkerReport report;
    osgSkin::makeWalker(*walking::makeFigure(clips), {}, &report);
    EXPECT_EQ(report.standing, "Idle");
    EXPECT_EQ(report.walking, "Walking_A");

    osgSkin::Clip restless = walking::idleClip();
    for (std::size_t f = 0; f < restless.frames; f += 2)
        restless.rotations[f * restless.joints + 3] = glm::angleAxis(1.0, glm::dvec3(0, 0, 1));
    restless.name = "idle_a";
    osgSkin::Clip calm = walking::idleClip();
    calm.name = "idle_b";
    osgSkin::makeWalker(*walking::makeFigure({restless, calm, walking::gaitClip(walking::walk())}),
                        {}, &report);
    EXPECT_EQ(report.standing, "idle_b");
}

TEST(MakeWalker, FindsAWalkWithoutAName) {
    walking::GaitOf walk = walking::walk();
    walk.name = "mixamo.com";
    const osg::ref_ptr<osg::Group> figure = walking::makeFigure({walking::gaitClip(walk)});
    WalkerReport report;
    osgSkin::makeWalker(*figure, {}, &report);
    EXPECT_EQ(report.walking, "mixamo.com");
    EXPECT_EQ(report.running, "");
    EXPECT_EQ(report.standing, "");
}

TEST(MakeWalker, StandsOnTheFloorAboveTheOrigin) {
    const osg::ref_ptr<osgSkin::Walker> walker = walking::makeFigureWalker();
    osg::ComputeBoundsVisitor bounds;
    walker->accept(bounds);
    EXPECT_NEAR(bounds.getBoundingBox().zMin(), 0.0, 1e-4);
    EXPECT_NEAR(bounds.getBoundingBox().zMax(), 1.57, 0.02);
    EXPECT_NEAR(bounds.getBoundingBox().yMin() + bounds.getBoundingBox().yMax(), 0.0, 0.1);
}

TEST(MakeWalker, LooksWhereItIsTold) {
    const osg::ref_ptr<osg::Group> figure =
        walking::makeFigure({walking::idleClip(), walking::gaitClip(walking::walk())});
    for (const auto forward : {WalkerOptions::Forward::PlusX, WalkerOptions::Forward::MinusY}) {
        WalkerOptions options;
        options.forward = forward;
        const osg::ref_ptr<osgSkin::Walker> walker = osgSkin::makeWalker(*figure, options);
        const walking::Vertices vertices = walking::verticesOf(*walker);
        const osgSkin::RestSkeleton rig = walking::figureRig();
        const osg::Vec3d toes = vertices[3 * walking::jointOf(rig, "LeftToeBase")] -
                                vertices[3 * walking::jointOf(rig, "LeftLeg")];
        const osg::Vec3d expected =
            forward == WalkerOptions::Forward::PlusX ? osg::Vec3d(1, 0, 0) : osg::Vec3d(0, -1, 0);
        EXPECT_NEAR(osg::Vec3d(toes.x(), toes.y(), 0) * expected, 0.15, 0.02);
    }
}

void expectError(const std::vector<osgSkin::Clip>& clips, const WalkerOptions& options,
                 const std::string& said) {
    try {
        osgSkin::makeWalker(*walking::makeFigure(clips), options);
        FAIL() << "expected an error";
    } catch (const osgSkin::Error& error) {
        EXPECT_NE(std::string(error.what()).find(said), std::string::npos) << error.what();
    }
}

TEST(MakeWalker, RejectsCharactersThatDoNotWalk) {
    expectError({walking::idleClip()}, {}, "none of the character's clips walks");
    expectError({}, {}, "no clip");
}

TEST(MakeWalker, NamesTheClipsInPlaceOfAnUnknownOne) {
    WalkerOptions options;
    options.walking = "wolk";
    expectError({walking::idleClip(), walking::gaitClip(walking::walk())}, options,
                "did you mean \"walk\"");
}

TEST(MakeWalker, RejectsAClipWithoutSteps) {
    WalkerOptions options;
    options.walking = "idle";
    expectError({walking::idleClip()}, options, "no whole cycle");
}

} // namespace
