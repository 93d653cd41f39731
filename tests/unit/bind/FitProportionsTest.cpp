// SPDX-License-Identifier: GPL-3.0-or-later
#include "fit/Proportions.h"

#include <gtest/gtest.h>

#include <cmath>

using namespace osgSkin;

namespace {

namespace part = osgSkin::proportions;

/// An upright figure with straight limbs and unusually long thighs, by this factor.
osgSkin::PlacedJoints figure(double thighs) {
    osgSkin::PlacedJoints placed;
    for (const double sign : {1.0, -1.0}) {
        const std::string side = sign > 0.0 ? "Left" : "Right";
        const double x = 0.1 * sign, knee = part::kHipHeight - thighs * part::kThigh;
        placed.addLandmark(side + "UpLeg", {x, part::kHipHeight, 0.0});
        placed.addLandmark(side + "Leg", {x, knee, 0.0});
        placed.addLandmark(side + "Foot", {x, knee - part::kShin, 0.0});
        const double elbow = x + sign * part::kUpperArm;
        placed.addLandmark(side + "Arm", {x, part::kShoulderHeight, 0.0});
        placed.addLandmark(side + "ForeArm", {elbow, part::kShoulderHeight, 0.0});
        placed.addLandmark(side + "Hand",
                           {elbow + sign * part::kForeArm, part::kShoulderHeight, 0.0});
    }
    return placed;
}

} // namespace

TEST(FitProportions, OddityIsTheMeanDeviation) {
    EXPECT_NEAR(osgSkin::oddity(figure(1.0)), 0.0, 1e-12);
    EXPECT_NEAR(osgSkin::oddity(figure(1.3)), std::log(1.3) / 6.0, 1e-12);
    EXPECT_NEAR(osgSkin::oddity(figure(1.0 / 1.3)), std::log(1.3) / 6.0, 1e-12);
    EXPECT_TRUE(std::isfinite(osgSkin::oddity(figure(0.0))));
}
