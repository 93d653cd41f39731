// SPDX-License-Identifier: MIT
// Skeletons, clips and props with unusable numbers are refused before anything plays them.
#include "ExpectError.h"
#include "Figure.h"

#include <osgSkinMotion/ClipPlayer>
#include <osgSkinMotion/MakeAnimation>
#include <osgSkinMotion/Prop>
#include <osgSkinMotion/SampledClip>
#include <osgSkinRig/Motion>
#include <osgSkinRig/Retarget>

#include <gtest/gtest.h>
#include <osg/MatrixTransform>

#include <limits>

namespace {

using osgSkin::Clip;
using osgSkin::RestSkeleton;

constexpr double kInf = std::numeric_limits<double>::infinity();
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

Clip stillClip(const RestSkeleton& rig) {
    Clip clip;
    clip.name = "still";
    clip.frameTime = 0.1;
    clip.frames = 3;
    clip.joints = rig.joints.size();
    clip.rotations.assign(clip.frames * clip.joints, glm::dquat(1, 0, 0, 0));
    clip.rootPositions.assign(clip.frames, rig.joints[0].centre);
    return clip;
}

} // namespace

TEST(RigValidation, RejectsInvalidTipsAndAxes) {
    const RestSkeleton rig = makeFigure(30.0);
    rig.validate();
    const auto refuses = [&](const glm::dvec3& tip, const glm::dquat& frame, const char* why) {
        RestSkeleton spoilt = rig;
        spoilt.joints[2].tip = tip;
        spoilt.joints[4].frame = frame;
        expectError([&] { spoilt.validate(); }, why);
        expectError([&] { osgSkin::retarget(standStill(rig, 2), spoilt); }, why);
    };
    const glm::dquat none(1, 0, 0, 0);
    refuses({0, kNaN, 0}, none, "has a tip that is not finite");
    refuses({0, 0, -2e18}, none, "has a tip that is not finite");
    refuses({0, 18, 0}, {kNaN, 0, 0, 0}, "has axes whose rotation is not unit");
    refuses({0, 18, 0}, {0, 0, 0, 0}, "has axes whose rotation is not unit");
    refuses({0, 18, 0}, {2, 0, 0, 0}, "has axes whose rotation is not unit");
}

TEST(RigValidation, RejectsInvalidClips) {
    const RestSkeleton rig = makeFigure(30.0);
    const auto refuses = [&](void (*spoil)(Clip&), const char* why) {
        Clip clip = stillClip(rig);
        spoil(clip);
        expectError([&] { osgSkin::makeAnimation(clip, rig); }, why);
        expectError([&] { osgSkin::SampledClip::create(clip, rig); }, why);
    };
    refuses(
        [](Clip& clip) {
            clip.rotations[13] = {0, 0, 0, 0};
        },
        "frame 1: joint \"Head\" has a rotation that is not unit");
    refuses([](Clip& clip) { clip.rotations[0].x = kNaN; }, "frame 0: joint \"Hips\"");
    refuses([](Clip& clip) { clip.rootPositions[2].y = kInf; }, "frame 2: the root's position");
    refuses([](Clip& clip) { clip.frameTime = kInf; }, "expected a positive frame time");
    refuses([](Clip& clip) { clip.frameTime = 1e308; }, "expected a positive frame time");
    EXPECT_EQ(osgSkin::SampledClip::create(stillClip(rig), rig)->sampleCount(), 3u);
}

TEST(RigValidation, RejectsPropsOutOfRange) {
    const osgSkin::Motion way = standStill(RestSkeleton{{{"ball", -1, {1, 0, 0}, {}}}}, 2);
    const osg::ref_ptr<osgAnimation::Animation> animation = new osgAnimation::Animation;
    osgSkin::RetargetReport report;
    report.scale = 1e30;
    expectError([&] { osgSkin::makeProp("ball", {}, way, report, *animation); },
                "prop \"ball\": a place in the figure's space is not finite");
    EXPECT_TRUE(animation->getChannels().empty());
}

TEST(RigValidation, PlayerIgnoresInvalidDirection) {
    RestSkeleton rig;
    rig.add("root", -1, glm::dvec3(0.0));
    Clip clip = stillClip(rig);
    for (std::size_t f = 0; f < clip.frames; ++f) clip.rootPositions[f] = {double(f), double(f), 0};
    const osg::ref_ptr<osgSkin::ClipPlayer> player = new osgSkin::ClipPlayer;
    const osg::ref_ptr<osg::MatrixTransform> shown = new osg::MatrixTransform;
    player->addRigid(shown, "root", osg::Matrixd());
    player->setLayer(0, {osgSkin::SampledClip::create(clip, rig), 0.1});
    player->setRoot(osgSkin::ClipPlayer::Root::InPlace, osg::Vec3d(kNaN, 0, 0));
    EXPECT_TRUE(player->pose());
    EXPECT_EQ(shown->getMatrix().getTrans(), osg::Vec3d(0, 1, 0)) << "up along y, as by default";
}

TEST(RigValidation, RetargetsTinyFrameTime) {
    const RestSkeleton rig = makeFigure(30.0);
    osgSkin::Motion motion = standStill(rig, 5);
    motion.frameTime = 1e-300;
    osgSkin::RetargetReport report;
    EXPECT_EQ(osgSkin::retarget(motion, rig, {}, &report).frames, 5u);
}
