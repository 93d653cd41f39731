// SPDX-License-Identifier: GPL-3.0-or-later
#include "regions/Regions.h"

#include <gtest/gtest.h>

using namespace osgSkin;

TEST(FacesLimb, IsTrueForTheTorsosSideBesideAHangingArm) {
    PlannedJoint arm;
    arm.centre = {2.0, 0.0, 0.0};
    arm.boneAxis = {0.0, -1.0, 0.0};
    arm.boneLength = 3.0;
    const double radius = 0.5;
    const glm::dvec3 outwards(1, 0, 0), inwards(-1, 0, 0);
    EXPECT_TRUE(facesLimb(arm, radius, {1.0, -1.0, 0.0}, outwards));
    EXPECT_TRUE(facesLimb(arm, radius, {1.0, 0.5, 0.0}, outwards)) << "above the shoulder";
    EXPECT_FALSE(facesLimb(arm, radius, {1.0, -1.0, 0.0}, inwards)) << "a very thick arm's";
    EXPECT_FALSE(facesLimb(arm, radius, {1.5, -1.0, 0.0}, outwards)) << "in the armpit";
    EXPECT_FALSE(facesLimb(arm, radius, {2.5, -1.0, 0.0}, outwards)) << "the arm's own";
    EXPECT_FALSE(facesLimb(arm, radius, {1.0, -1.0, 0.0}, {0, 0, 1})) << "the chest";
}
