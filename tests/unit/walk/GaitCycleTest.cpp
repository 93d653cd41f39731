// SPDX-License-Identifier: MIT
// Cycles that are cut out of clips.
#include "walk/GaitCycle.h"
#include "WalkingFigure.h"
#include "feet/FootTrack.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace {

using osgSkin::SampledClip;

osgSkin::WalkingBody figureBody() {
    const osgSkin::RestSkeleton rig = walking::figureRig();
    osgSkin::WalkingBody body;
    for (std::size_t side = 0; side < 2; ++side) {
        const std::string name = side == 0 ? "Left" : "Right";
        body.ankles[side] = walking::jointOf(rig, name + "Foot");
        body.balls[side] = rig.joints[walking::jointOf(rig, name + "ToeBase")].centre;
    }
    body.forward = {0.0, -1.0, 0.0};
    body.leg = walking::kThigh + walking::kShin;
    return body;
}

} // namespace

TEST(FootTrack, FindsThePeriodOfSteps) {
    std::vector<double> ahead;
    for (int i = 0; i < 120; ++i) ahead.push_back(std::cos(glm::two_pi<double>() * i / 40.0));
    EXPECT_EQ(osgSkin::findPeriod(ahead, true), 40u);
    EXPECT_EQ(osgSkin::findPeriod(ahead, false), 40u);
    EXPECT_EQ(osgSkin::findPeriod({ahead.begin() + 5, ahead.begin() + 50}, false), 40u);
    for (double& value : ahead) value += 1.5; // the left foot stays in front
    EXPECT_EQ(osgSkin::findPeriod(ahead, true), 0u);
}

TEST(GaitCycle, ContinuesItsBeginning) {
    walking::GaitOf gait = walking::walk();
    gait.cycles = 2.4; // it ends within a step
    const osg::ref_ptr<const SampledClip> clip =
        SampledClip::create(walking::gaitClip(gait), walking::figureRig());
    EXPECT_FALSE(osgSkin::isLoop(*clip));
    double slide = 1.0;
    const osgSkin::Gaits::Gait cycle = osgSkin::findCycle(*clip, figureBody(), 0.0, slide);
    EXPECT_TRUE(osgSkin::isLoop(*cycle.clip));
    EXPECT_NEAR(cycle.stride, walking::kWalkStride, 0.02);
    EXPECT_LT(slide, 0.02);
    for (const osgSkin::Gaits::Contact& contact : cycle.contacts) {
        const double carries = contact.end - contact.begin;
        EXPECT_NEAR(carries - std::floor(carries), gait.carries, 0.1);
    }
}
