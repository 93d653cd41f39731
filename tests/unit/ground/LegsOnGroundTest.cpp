// SPDX-License-Identifier: MIT
#include "ground/LegsOnGround.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace {

using osgSkin::ClipLeg;
using osgSkin::GroundPlane;
using osgSkin::LegsOnGround;

constexpr double kLeg = 0.9, kAnkle = 0.08, kStep = 1.0 / 60.0;

/// A leg that stands still, bent by a length.
ClipLeg standing(double x, double bent) {
    const double half = std::sqrt(0.25 * kLeg * kLeg - bent * bent);
    ClipLeg leg;
    leg.ankle.set(x, 0.0, kAnkle);
    leg.knee.set(x, -bent, kAnkle + half);
    leg.hip.set(x, 0.0, kAnkle + 2.0 * half);
    leg.sole = {osg::Vec3d(x, 0.06, 0.0), osg::Vec3d(x, -0.12, 0.0), osg::Vec3d(x, -0.2, 0.0)};
    leg.knees.set(0, -1, 0);
    return leg;
}

std::array<ClipLeg, 2> standing(double bent = 0.05) {
    return {standing(0.1, bent), standing(-0.1, bent)};
}

LegsOnGround::FindGround heightOf(double left, double right) {
    return [=](const osg::Vec3d& point) {
        return GroundPlane{{point.x(), point.y(), point.x() > 0.0 ? left : right}};
    };
}

osg::Vec3d kneeOf(const ClipLeg& leg, const LegsOnGround& legs, std::size_t side) {
    return leg.hip + osg::Vec3d(0, 0, legs.lift()) + legs.turns(side).thigh * (leg.knee - leg.hip);
}

osg::Vec3d ankleOf(const ClipLeg& leg, const LegsOnGround& legs, std::size_t side) {
    return kneeOf(leg, legs, side) + legs.turns(side).shin * (leg.ankle - leg.knee);
}

TEST(LegsOnGround, ChangeNothingOnTheClipsFloor) {
    LegsOnGround legs(0.0, kLeg);
    for (int i = 0; i < 3; ++i) {
        legs.step(standing(), kStep, {}, heightOf(0.0, 0.0));
        EXPECT_NEAR(legs.lift(), 0.0, 1e-12);
        for (std::size_t side = 0; side < 2; ++side) {
            EXPECT_NEAR((ankleOf(standing()[side], legs, side) - standing()[side].ankle).length(),
                        0.0, 1e-12);
            EXPECT_NEAR((kneeOf(standing()[side], legs, side) - standing()[side].knee).length(),
                        0.0, 1e-7);
        }
    }
}

TEST(LegsOnGround, StandAtDifferentHeights) {
    LegsOnGround legs(0.0, kLeg);
    legs.step(standing(), kStep, {}, heightOf(0.2, -0.05));
    EXPECT_NEAR(ankleOf(standing()[0], legs, 0).z(), kAnkle + 0.2, 1e-9);
    EXPECT_NEAR(ankleOf(standing()[1], legs, 1).z(), kAnkle - 0.05, 1e-9);
    EXPECT_LT(kneeOf(standing()[0], legs, 0).y(), -0.2);
}

TEST(LegsOnGround, BendStraightLegsForward) {
    for (const double bent : {0.0, -0.005}) { // a clip may bend a knee back a little
        LegsOnGround legs(0.0, kLeg);
        const std::array<ClipLeg, 2> clip = standing(bent);
        legs.step(clip, kStep, {}, heightOf(0.15, 0.0));
        EXPECT_LT(kneeOf(clip[0], legs, 0).y(), -0.1);
        EXPECT_NEAR(kneeOf(clip[0], legs, 0).x(), 0.1, 1e-6);
    }
}

TEST(LegsOnGround, TurnFeetToTheSlope) {
    LegsOnGround legs(0.0, kLeg);
    const double slope = std::tan(0.35);
    osg::Vec3d normal(0.0, slope, 1.0);
    normal.normalize();
    legs.step(standing(), kStep, {}, [&](const osg::Vec3d& point) {
        return GroundPlane{{point.x(), point.y(), -slope * point.y()}, normal};
    });
    for (std::size_t side = 0; side < 2; ++side) {
        const osg::Vec3d up = legs.turns(side).foot * osg::Vec3d(0, 0, 1);
        EXPECT_NEAR(std::atan2(up.y(), up.z()), 0.35, 1e-6);
    }
}

TEST(LegsOnGround, KeepTheClipWhereThereIsNoGround) {
    LegsOnGround legs(0.0, kLeg);
    const auto none = [](const osg::Vec3d&) { return std::optional<GroundPlane>(); };
    legs.step(standing(), kStep, {}, heightOf(0.2, 0.2));
    EXPECT_GT(legs.lift(), 0.1);
    for (int i = 0; i < 60; ++i) legs.step(standing(), kStep, {}, none);
    EXPECT_NEAR(legs.lift(), 0.0, 1e-4);
    EXPECT_NEAR(ankleOf(standing()[0], legs, 0).z(), kAnkle, 1e-4);
}

/// The ground rises by a step under a standing figure, or the figure is put on it.
TEST(LegsOnGround, EaseSteps) {
    LegsOnGround legs(0.0, kLeg);
    legs.step(standing(), kStep, {}, heightOf(0.0, 0.0));
    double height = ankleOf(standing()[0], legs, 0).z(), lift = legs.lift();
    for (int i = 0; i < 60; ++i) {
        legs.step(standing(), kStep, {}, heightOf(0.18, 0.18));
        const double now = ankleOf(standing()[0], legs, 0).z();
        EXPECT_LT(std::abs(now - height), 0.05);
        EXPECT_LE(std::abs(legs.lift() - lift), 0.03);
        height = now;
        lift = legs.lift();
    }
    EXPECT_NEAR(height, kAnkle + 0.18, 1e-4);
    EXPECT_NEAR(lift, 0.18, 1e-4);
    // The figure jumps up to where its feet are.
    legs.step(standing(), kStep, osg::Matrixd::translate(0, 0, -0.18), heightOf(0.0, 0.0));
    EXPECT_NEAR(ankleOf(standing()[0], legs, 0).z(), kAnkle, 0.03);
}

TEST(LegsOnGround, FollowMovingGround) {
    LegsOnGround legs(0.0, kLeg);
    double height = 0.0;
    for (int i = 0; i < 60; ++i, height -= 0.015)
        legs.step(standing(), kStep, {}, heightOf(height, height));
    EXPECT_NEAR(ankleOf(standing()[0], legs, 0).z(), kAnkle + height + 0.015, 1e-6);
}

TEST(LegsOnGround, BeginAgainAfterAPauseAndAJump) {
    LegsOnGround legs(0.0, kLeg);
    legs.step(standing(), kStep, {}, heightOf(0.0, 0.0));
    legs.step(standing(), 1.0, {}, heightOf(0.2, 0.2));
    EXPECT_NEAR(legs.lift(), 0.2, 1e-9);
    legs.step(standing(), kStep, osg::Matrixd::translate(2, 0, 0), heightOf(-0.1, -0.1));
    EXPECT_NEAR(legs.lift(), -0.1, 1e-9);
}

} // namespace
