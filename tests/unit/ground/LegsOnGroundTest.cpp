// SPDX-License-Identifier: MIT
#include "ground/LegsOnGround.h"

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace {

using osgSkin::ClipLeg;
using osgSkin::GroundPlane;
using osgSkin::LegsOnGround;

constexpr double kLeg = 0.9, kAnkle = 0.08, kStep = 1.0 / 60.0;
const glm::dmat4 kStays(1.0);

/// A leg that stands still, bent by a length.
ClipLeg standing(double x, double bent) {
    const double half = std::sqrt(0.25 * kLeg * kLeg - bent * bent);
    ClipLeg leg;
    leg.ankle = {x, 0.0, kAnkle};
    leg.knee = {x, -bent, kAnkle + half};
    leg.hip = {x, 0.0, kAnkle + 2.0 * half};
    leg.sole = {glm::dvec3(x, 0.06, 0.0), glm::dvec3(x, -0.12, 0.0), glm::dvec3(x, -0.2, 0.0)};
    leg.knees = {0, -1, 0};
    return leg;
}

std::array<ClipLeg, 2> standing(double bent = 0.05) {
    return {standing(0.1, bent), standing(-0.1, bent)};
}

LegsOnGround::FindGround heightOf(double left, double right) {
    return [=](const glm::dvec3& point) {
        return GroundPlane{{point.x, point.y, point.x > 0.0 ? left : right}};
    };
}

glm::dvec3 kneeOf(const ClipLeg& leg, const LegsOnGround& legs, std::size_t side) {
    return leg.hip + glm::dvec3(0, 0, legs.lift()) + legs.turns(side).thigh * (leg.knee - leg.hip);
}

glm::dvec3 ankleOf(const ClipLeg& leg, const LegsOnGround& legs, std::size_t side) {
    return kneeOf(leg, legs, side) + legs.turns(side).shin * (leg.ankle - leg.knee);
}

TEST(LegsOnGround, ChangeNothingOnTheClipsFloor) {
    LegsOnGround legs(0.0, kLeg);
    for (int i = 0; i < 3; ++i) {
        legs.step(standing(), kStep, kStays, heightOf(0.0, 0.0));
        EXPECT_NEAR(legs.lift(), 0.0, 1e-12);
        for (std::size_t side = 0; side < 2; ++side) {
            EXPECT_NEAR(
                glm::distance(ankleOf(standing()[side], legs, side), standing()[side].ankle), 0.0,
                1e-12);
            EXPECT_NEAR(glm::distance(kneeOf(standing()[side], legs, side), standing()[side].knee),
                        0.0, 1e-7);
        }
    }
}

TEST(LegsOnGround, StandAtDifferentHeights) {
    LegsOnGround legs(0.0, kLeg);
    legs.step(standing(), kStep, kStays, heightOf(0.2, -0.05));
    EXPECT_NEAR(ankleOf(standing()[0], legs, 0).z, kAnkle + 0.2, 1e-9);
    EXPECT_NEAR(ankleOf(standing()[1], legs, 1).z, kAnkle - 0.05, 1e-9);
    EXPECT_LT(kneeOf(standing()[0], legs, 0).y, -0.2);
}

TEST(LegsOnGround, BendStraightLegsForward) {
    for (const double bent : {0.0, -0.005}) { // a clip may bend a knee back a little
        LegsOnGround legs(0.0, kLeg);
        const std::array<ClipLeg, 2> clip = standing(bent);
        legs.step(clip, kStep, kStays, heightOf(0.15, 0.0));
        EXPECT_LT(kneeOf(clip[0], legs, 0).y, -0.1);
        EXPECT_NEAR(kneeOf(clip[0], legs, 0).x, 0.1, 1e-6);
    }
}

TEST(LegsOnGround, TurnFeetToTheSlope) {
    LegsOnGround legs(0.0, kLeg);
    const double slope = std::tan(0.35);
    const glm::dvec3 normal = glm::normalize(glm::dvec3(0.0, slope, 1.0));
    legs.step(standing(), kStep, kStays, [&](const glm::dvec3& point) {
        return GroundPlane{{point.x, point.y, -slope * point.y}, normal};
    });
    for (std::size_t side = 0; side < 2; ++side) {
        const glm::dvec3 up = legs.turns(side).foot * glm::dvec3(0, 0, 1);
        EXPECT_NEAR(std::atan2(up.y, up.z), 0.35, 1e-6);
    }
}

TEST(LegsOnGround, KeepTheClipWhereThereIsNoGround) {
    LegsOnGround legs(0.0, kLeg);
    const auto none = [](const glm::dvec3&) { return std::optional<GroundPlane>(); };
    legs.step(standing(), kStep, kStays, heightOf(0.2, 0.2));
    EXPECT_GT(legs.lift(), 0.1);
    for (int i = 0; i < 60; ++i) legs.step(standing(), kStep, kStays, none);
    EXPECT_NEAR(legs.lift(), 0.0, 1e-4);
    EXPECT_NEAR(ankleOf(standing()[0], legs, 0).z, kAnkle, 1e-4);
}

/// The ground rises by a step under a standing figure, or the figure is put on it.
TEST(LegsOnGround, EaseSteps) {
    LegsOnGround legs(0.0, kLeg);
    legs.step(standing(), kStep, kStays, heightOf(0.0, 0.0));
    double height = ankleOf(standing()[0], legs, 0).z, lift = legs.lift();
    for (int i = 0; i < 60; ++i) {
        legs.step(standing(), kStep, kStays, heightOf(0.18, 0.18));
        const double now = ankleOf(standing()[0], legs, 0).z;
        EXPECT_LT(std::abs(now - height), 0.05);
        EXPECT_LE(std::abs(legs.lift() - lift), 0.03);
        height = now;
        lift = legs.lift();
    }
    EXPECT_NEAR(height, kAnkle + 0.18, 1e-4);
    EXPECT_NEAR(lift, 0.18, 1e-4);
    // The figure jumps up to where its feet are.
    legs.step(standing(), kStep, glm::translate(glm::dmat4(1.0), glm::dvec3(0, 0, -0.18)),
              heightOf(0.0, 0.0));
    EXPECT_NEAR(ankleOf(standing()[0], legs, 0).z, kAnkle, 0.03);
}

TEST(LegsOnGround, FollowMovingGround) {
    LegsOnGround legs(0.0, kLeg);
    double height = 0.0;
    for (int i = 0; i < 60; ++i, height -= 0.015)
        legs.step(standing(), kStep, kStays, heightOf(height, height));
    EXPECT_NEAR(ankleOf(standing()[0], legs, 0).z, kAnkle + height + 0.015, 1e-6);
}

TEST(LegsOnGround, BeginAgainAfterAPauseAndAJump) {
    LegsOnGround legs(0.0, kLeg);
    legs.step(standing(), kStep, kStays, heightOf(0.0, 0.0));
    legs.step(standing(), 1.0, kStays, heightOf(0.2, 0.2));
    EXPECT_NEAR(legs.lift(), 0.2, 1e-9);
    legs.step(standing(), kStep, glm::translate(glm::dmat4(1.0), glm::dvec3(2, 0, 0)),
              heightOf(-0.1, -0.1));
    EXPECT_NEAR(legs.lift(), -0.1, 1e-9);
}

} // namespace
