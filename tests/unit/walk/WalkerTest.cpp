// SPDX-License-Identifier: MIT
#include "WalkedPath.h"

#include <osgSkin/CharacterGroup>

#include <gtest/gtest.h>

#include <cmath>
#include <string>

namespace {

using walking::Course;
using walking::slideOn;
using walking::Walk;

class WalkerAtRate : public testing::TestWithParam<double> {};

TEST_P(WalkerAtRate, FeetStayWhileItWalks) {
    EXPECT_LT(slideOn(Course(), 1.0 / GetParam()), 0.01);
}

TEST_P(WalkerAtRate, FeetStayWhileItRuns) {
    Course course;
    course.speed = [](double) { return 3.0; };
    EXPECT_LT(slideOn(course, 1.0 / GetParam()), 0.01);
}

TEST_P(WalkerAtRate, FeetStayThroughAStartAndAStop) {
    Course course;
    course.speed = [](double t) { return t < 1.0 || t > 5.0 ? 0.0 : 1.4; };
    course.seconds = 7.0;
    EXPECT_LT(slideOn(course, 1.0 / GetParam()), 0.02);
    course.speed = [](double t) { return 3.0 * std::clamp(std::min(t - 1.0, 6.0 - t), 0.0, 1.0); };
    course.seconds = 8.0;
    EXPECT_LT(slideOn(course, 1.0 / GetParam()), 0.02);
}

TEST_P(WalkerAtRate, FeetStayOnACurve) {
    Course course;
    course.turn = [](double) { return 0.5; };
    EXPECT_LT(slideOn(course, 1.0 / GetParam()), 0.02);
}

INSTANTIATE_TEST_SUITE_P(Walker, WalkerAtRate, testing::Values(20.0, 60.0, 100.0));

TEST_P(WalkerAtRate, FeetRollOverTheirTips) {
    walking::GaitOf gait = walking::walk();
    gait.roll = 0.6;
    Walk walk(osgSkin::makeWalker(
        *walking::makeFigure({walking::idleClip(), walking::gaitClip(gait)}), {}));
    const osgSkin::RestSkeleton rig = walking::figureRig();
    const double dt = 1.0 / GetParam();
    double slide = 0.0, highest = 0.0;
    walking::Vertices before;
    for (double t = 0.0; t < 6.0; t += dt) {
        walk.show({1.4 * t, 0, 0}, 0.0, dt);
        const walking::Vertices now = walking::verticesOf(*walk.transform);
        for (const char* side : {"Left", "Right"}) {
            const std::size_t ball = 3 * walking::jointOf(rig, side + std::string("Foot"));
            const std::size_t tip = 3 * walking::jointOf(rig, side + std::string("ToeBase")) + 2;
            highest = std::max(highest, now[ball].z() - now[tip].z());
            for (const std::size_t point : {ball, tip}) {
                ASSERT_GT(now[point].z(), -0.005) << t;
                if (before.empty() || now[point].z() > 0.004 || before[point].z() > 0.004) continue;
                slide += 0.5 * std::abs(now[point].x() - before[point].x());
            }
        }
        before = now;
    }
    EXPECT_GT(highest, 0.03);
    EXPECT_LT(slide / (1.4 * 6.0), 0.02);
}

TEST(Walker, StandsUntilItIsMoved) {
    Walk walk;
    walk.show({5, 5, 0}, 1.0, 0.05);
    const walking::Vertices before = walking::verticesOf(*walk.transform);
    for (int i = 0; i < 20; ++i) walk.show({5, 5, 0}, 1.0, 0.05);
    EXPECT_EQ(walking::difference(before, walking::verticesOf(*walk.transform)), 0.0);
}

TEST(Walker, PhaseFollowsTheWay) {
    // The same way in other steps of time and of place.
    double phase = -1.0;
    for (const double dt : {0.01, 0.02, 0.05}) {
        Walk walk;
        for (double t = 0.0; t < 4.001; t += dt) walk.show({1.5 * t, 0, 0}, 0.0, dt);
        if (phase >= 0.0) {
            EXPECT_NEAR(std::remainder(walk.walker->phase() - phase, 1.0), 0.0, 0.06);
        }
        phase = walk.walker->phase();
        EXPECT_NEAR(walk.walker->speed(), 1.5, 0.05);
    }
}

TEST(Walker, OneStrideIsOneCycle) {
    Walk walk;
    double x = 0.0;
    for (; x < 3.0; x += 0.03) walk.show({x, 0, 0}, 0.0, 0.02);
    const double before = walk.walker->phase();
    for (int i = 0; i < 50; ++i) walk.show({x += 0.03, 0, 0}, 0.0, 0.02);
    const double missing = std::remainder(walk.walker->phase() - before, 1.0);
    EXPECT_NEAR(missing, 0.0, 0.02);
}

TEST(Walker, WalksBackOnRewind) {
    Walk walk;
    double x = 0.0;
    for (int i = 0; i < 100; ++i) walk.show({x += 0.03, 0, 0}, 0.0, 0.02);
    const double before = walk.walker->phase();
    for (int i = 0; i < 20; ++i) walk.show({x += 0.03, 0, 0}, 0.0, 0.02);
    for (int i = 0; i < 20; ++i) walk.show({x -= 0.03, 0, 0}, 0.0, 0.02);
    EXPECT_NEAR(std::remainder(walk.walker->phase() - before, 1.0), 0.0, 0.1);
    EXPECT_LT(walk.walker->speed(), 0.0);
}

TEST(Walker, TeleportTakesNoStep) {
    Walk walk;
    double x = 0.0;
    for (int i = 0; i < 100; ++i) walk.show({x += 0.03, 0, 0}, 0.0, 0.02);
    const double before = walk.walker->phase();
    const double feet = walk.balls()[0].x() - x;
    walk.show({x + 50.0, 20, 0}, 0.0, 0.02);
    EXPECT_EQ(walk.walker->phase(), before);
    EXPECT_NEAR(walk.balls()[0].x() - (x + 50.0), feet, 0.05);
    EXPECT_NEAR(walk.walker->speed(), 1.5, 0.3);
}

TEST(Walker, StandsAfterAStop) {
    Walk walk;
    walk.show({0, 0, 0}, 0.0, 0.05);
    const walking::Vertices standing = walking::verticesOf(*walk.walker);
    double x = 0.0;
    for (int i = 0; i < 47; ++i) walk.show({x += 0.07, 0, 0}, 0.0, 0.05);
    EXPECT_GT(walking::difference(standing, walking::verticesOf(*walk.walker)), 0.2);
    for (int i = 0; i < 40; ++i) walk.show({x, 0, 0}, 0.0, 0.05);
    EXPECT_LT(walking::difference(standing, walking::verticesOf(*walk.walker)), 0.06);
    const walking::Vertices stopped = walking::verticesOf(*walk.walker);
    for (int i = 0; i < 20; ++i) walk.show({x, 0, 0}, 0.0, 0.05);
    EXPECT_EQ(walking::difference(stopped, walking::verticesOf(*walk.walker)), 0.0);
}

TEST(Walker, StepsRoundOnTheSpot) {
    Walk walk;
    walk.show({0, 0, 0}, 0.0, 0.02);
    const walking::Vertices standing = walking::verticesOf(*walk.walker);
    for (int i = 1; i <= 100; ++i) walk.show({0, 0, 0}, 0.02 * i, 0.02);
    for (int i = 0; i < 100; ++i) walk.show({0, 0, 0}, 2.0, 0.02);
    // Seen from the walker, it stands as before: its feet have come along.
    for (const auto& [a, b] : {std::pair{standing, walking::verticesOf(*walk.walker)}})
        EXPECT_LT(walking::difference(a, b), 0.12);
}

TEST(Walker, StrideScalesWithTheTransformAbove) {
    const osg::Vec3d scale(2, 1.5, 1.8); // along, across, up
    Walk walk;
    double x = 0.0;
    for (; x < 6.0; x += 0.06) walk.show({x, 0, 0}, 0.0, 0.02, scale);
    const double before = walk.walker->phase();
    for (int i = 0; i < 50; ++i) walk.show({x += 0.06, 0, 0}, 0.0, 0.02, scale);
    EXPECT_NEAR(std::remainder(walk.walker->phase() - before, 1.0), 0.0, 0.02);
    EXPECT_NEAR(walk.walker->speed(), 1.5, 0.02); // in its own units
}

TEST(Walker, RunsWhereItIsFast) {
    const auto highest = [](double speed) {
        Walk walk;
        double most = 0.0;
        for (double t = 0.0; t < 4.0; t += 0.02) {
            walk.show({speed * t, 0, 0}, 0.0, 0.02);
            const auto balls = walk.balls();
            if (t > 2.0) most = std::max(most, std::min(balls[0].z(), balls[1].z()));
        }
        return most;
    };
    EXPECT_LT(highest(1.4), 0.01); // one foot is always on the floor
    EXPECT_GT(highest(3.2), 0.01); // it flies
}

TEST(Walker, SetMotionWalksWithoutTraversals) {
    const osg::ref_ptr<osgSkin::Walker> walker = walking::makeFigureWalker();
    for (int i = 0; i <= 100; ++i) walker->setMotion({0.03 * i, 0, 0}, 0.0, 1.5, 0.02);
    EXPECT_EQ(walker->speed(), 1.5);
    Walk walk;
    for (int i = 0; i <= 100; ++i) walk.show({0.03 * i, 0, 0}, 0.0, 0.02);
    EXPECT_NEAR(std::remainder(walker->phase() - walk.walker->phase(), 1.0), 0.0, 0.1);
    walker->setMotion({3.03, 0, 0}, 0.0, std::nan(""), 0.02); // ignored
    EXPECT_EQ(walker->speed(), 1.5);
}

TEST(Walker, WavesOnceWhileItWalks) {
    Walk walk;
    const std::size_t hand = 3 * walking::jointOf(walking::figureRig(), "RightHand");
    double x = 0.0;
    const auto handHeight = [&] {
        walk.show({x += 0.03, 0, 0}, 0.0, 0.02);
        return walking::verticesOf(*walk.transform)[hand].z();
    };
    for (int i = 0; i < 50; ++i) EXPECT_LT(handHeight(), 1.2);
    EXPECT_FALSE(walk.walker->play("fly"));
    EXPECT_TRUE(walk.walker->play("wave"));
    for (int i = 0; i < 25; ++i) handHeight();
    EXPECT_GT(handHeight(), 1.5);
    for (int i = 0; i < 75; ++i) handHeight();
    EXPECT_LT(handHeight(), 1.2);
}

TEST(Walker, WalksInACharacterGroupAsAlone) {
    const osg::ref_ptr<osgSkin::CharacterGroup> group = new osgSkin::CharacterGroup;
    const osg::ref_ptr<osgSkin::Walker> figure = walking::makeFigureWalker();
    figure->setVaried(false);
    std::vector<osg::ref_ptr<osg::MatrixTransform>> places;
    std::vector<Walk> alone;
    for (int i = 0; i < 10; ++i) {
        places.push_back(new osg::MatrixTransform);
        places.back()->addChild(osg::clone(figure.get(), osg::CopyOp()));
        group->addChild(places.back());
        alone.emplace_back(osg::clone(figure.get(), osg::CopyOp()));
    }
    for (int frame = 0; frame < 60; ++frame) {
        for (std::size_t i = 0; i < places.size(); ++i) {
            const osg::Vec3d position(0.01 * double(i + 1) * frame, 0, 0);
            places[i]->setMatrix(osg::Matrix::translate(position));
            alone[i].show(position, 0.0, 0.02);
        }
        const osg::ref_ptr<osg::FrameStamp> stamp = new osg::FrameStamp;
        stamp->setFrameNumber(static_cast<unsigned int>(frame) + 1);
        stamp->setSimulationTime(0.02 * (frame + 1));
        osgUtil::UpdateVisitor visitor;
        visitor.setFrameStamp(stamp);
        group->accept(visitor);
        for (std::size_t i = 0; i < places.size(); ++i)
            ASSERT_LT(walking::difference(walking::verticesOf(*places[i]),
                                          walking::verticesOf(*alone[i].transform)),
                      1e-5);
    }
    EXPECT_EQ(group->ordinaryChildren(), 0u);
}

} // namespace
