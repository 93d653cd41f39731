// SPDX-License-Identifier: MIT
// A twist that runs through 180 degrees: UpdateDeformableSkin lets it run on, unless told
// otherwise.
#include "PlayedFigure.h"
#include "TubeSkin.h"

#include <osgSkin/UpdateDeformableSkin>
#include <osgSkinRig/ClipCharacter>

#include <osgUtil/UpdateVisitor>

#include <gtest/gtest.h>

namespace {

const double kDegree = osg::PI / 180.0;

class TwistUnwrap : public testing::Test {
protected:
    TwistUnwrap() {
        skin->setUpdateCallback(callback);
        skeleton->addChild(skin);
    }

    /// The middle joint's twist, in degrees, after an update at `time` with its bone turned.
    double twistAt(double time, double degrees) {
        auto& root = static_cast<osgAnimation::Bone&>(*skeleton->getChild(0));
        auto& middle = static_cast<osgAnimation::Bone&>(*root.getChild(0));
        auto& end = static_cast<osgAnimation::Bone&>(*middle.getChild(0));
        middle.setMatrixInSkeletonSpace(
            osg::Matrix::rotate(degrees * kDegree, osg::Vec3d(0, 1, 0)) *
            osg::Matrix::translate(0, 2, 0));
        end.setMatrixInSkeletonSpace(osg::Matrix::translate(0, 2, 0) *
                                     middle.getMatrixInSkeletonSpace());
        const osg::ref_ptr<osg::FrameStamp> stamp = new osg::FrameStamp;
        stamp->setSimulationTime(time);
        osgUtil::UpdateVisitor update;
        update.setFrameStamp(stamp);
        skeleton->accept(update);
        return skin->getPose().transform(1).split.twistAngle / kDegree;
    }

    osg::ref_ptr<osgAnimation::Skeleton> skeleton = test::makeBones();
    osg::ref_ptr<osgSkin::DeformableSkin> skin = test::makeSkin();
    osg::ref_ptr<osgSkin::UpdateDeformableSkin> callback = new osgSkin::UpdateDeformableSkin;
};

} // namespace

TEST_F(TwistUnwrap, OnByDefault) {
    EXPECT_TRUE(callback->getUnwrapTwist());
    twistAt(0.0, 170.0);
    EXPECT_NEAR(twistAt(0.1, 190.0), 190.0, 1e-9);
    callback->setUnwrapTwist(false);
    twistAt(0.15, 170.0);
    EXPECT_NEAR(twistAt(0.2, 190.0), -170.0, 1e-9);
}

TEST_F(TwistUnwrap, RunsOnThroughHalfATurnAndBack) {
    double time = 0.0;
    for (double degrees = 0.0; degrees < 270.0; degrees += 10.0)
        ASSERT_NEAR(twistAt(time += 0.05, degrees), degrees, 1e-9);
    for (double degrees = 260.0; degrees > -270.0; degrees -= 10.0)
        ASSERT_NEAR(twistAt(time += 0.05, degrees), degrees, 1e-9);
}

TEST_F(TwistUnwrap, DoesNotWindUp) {
    double time = 0.0;
    for (double degrees = 0.0; degrees < 2000.0; degrees += 10.0) {
        const double twist = twistAt(time += 0.05, degrees);
        ASSERT_LT(std::abs(twist), 270.0) << degrees;
        if (std::abs(std::remainder(degrees, 360.0)) < 90.0) {
            ASSERT_NEAR(twist, std::remainder(degrees, 360.0), 1e-9) << degrees;
        }
    }
}

/// A clip whose end is far from its beginning, played over and over.
TEST_F(TwistUnwrap, EachRoundOfALoopIsLikeTheFirst) {
    const double clip[] = {-30.0, 30.0, 100.0, 170.0, 220.0, 250.0};
    double time = 0.0;
    for (int round = 0; round < 4; ++round)
        for (const double degrees : clip)
            ASSERT_NEAR(twistAt(time += 0.05, degrees), degrees, 1e-9) << round;
}

/// Whoever poses frames of a motion in any order, as baking does, gets the same ones.
TEST_F(TwistUnwrap, PoseWithoutAnUpdateDependsOnTheBonesAlone) {
    twistAt(0.0, 170.0);
    EXPECT_NEAR(twistAt(0.1, 190.0), 190.0, 1e-9);
    for (int i = 0; i < 2; ++i) {
        EXPECT_TRUE(callback->pose(*skin, *skeleton));
        EXPECT_NEAR(skin->getPose().transform(1).split.twistAngle / kDegree, -170.0, 1e-9);
    }
}

TEST_F(TwistUnwrap, SkinRunsOnToo) {
    double time = 0.0;
    for (double degrees = 0.0; degrees < 270.0; degrees += 10.0) {
        twistAt(time += 0.05, degrees);
        // Halfway up the middle joint's region half of the twist is taken, of what is left over
        // 2 pi too. The ring of vertices at the joint has ratio one half.
        const auto& vertices =
            static_cast<const osg::Vec3Array&>(*skin->getDeformedGeometry()->getVertexArray());
        const osg::Vec3 at = vertices[std::size_t(8) * 12]; // height 2, at angle 0
        const double half = 0.5 * degrees * kDegree;
        ASSERT_NEAR(at.x(), std::cos(half), 1e-5) << degrees;
        ASSERT_NEAR(at.z(), -std::sin(half), 1e-5) << degrees;
    }
}

TEST_F(TwistUnwrap, StartsAfreshOnASeek) {
    double time = 1.0;
    const auto wind = [&] {
        for (double degrees = 100.0; degrees <= 200.0; degrees += 20.0)
            twistAt(time += 0.05, degrees);
        EXPECT_NEAR(skin->getPose().transform(1).split.twistAngle / kDegree, 200.0, 1e-9);
    };
    wind();
    EXPECT_NEAR(twistAt(time += 1.0, 200.1), -159.9, 1e-9);
    wind();
    EXPECT_NEAR(twistAt(time -= 1.0, 200.1), -159.9, 1e-9);
    wind();
    callback->startTwistAfresh();
    EXPECT_NEAR(twistAt(time += 0.01, 200.0), -160.0, 1e-9);
    wind();
    EXPECT_NEAR(twistAt(time += 0.05, 20.0), 20.0, 1e-9); // too far to be one motion
    wind();
    callback->setUnwrapTwist(false);
    twistAt(time += 0.05, 200.0);
    EXPECT_NEAR(twistAt(time += 0.05, 200.1), -159.9, 1e-9);
}

namespace {

/// The middle joint twists by these degrees about the tube, sample by sample.
osgSkin::Clip twistingClip(const std::vector<double>& degrees) {
    osgSkin::Clip clip = played::someClip(degrees.size(), 0.0);
    for (std::size_t f = 0; f < degrees.size(); ++f)
        clip.rotations[3 * f + 1] = glm::angleAxis(degrees[f] * kDegree, glm::dvec3(0, 1, 0));
    return clip;
}

double twistOf(const osgSkin::DeformableSkin& skin) {
    return skin.getPose().transform(1).split.twistAngle / kDegree;
}

const std::vector<double> kThereAndBack{0.0,   40.0,  80.0,  120.0, 160.0, 200.0,
                                        240.0, 200.0, 160.0, 120.0, 80.0,  40.0};

double expectedAt(double samples) {
    const double at = samples - 12.0 * std::floor(samples / 12.0);
    return at <= 6.0 ? 40.0 * at : 40.0 * (12.0 - at);
}

} // namespace

TEST(ClipTwist, RunsOnThroughHalfATurnLoopAfterLoop) {
    const osgSkin::Clip clip = twistingClip(kThereAndBack);
    const played::Character character(clip);
    const auto copies = osgSkin::ClipCharacter::create(*character.scene);
    const auto sampled = osgSkin::SampledClip::create(clip, character.rig);
    for (const bool baked : {false, true}) {
        if (baked) copies->bake(sampled);
        const auto copy = copies->makeInstance();
        const osgSkin::DeformableSkin& skin = played::skinOf(*copy.node);
        copy.player->setLayer(0, {sampled});
        for (double samples = 0.0; samples < 40.0; samples += 0.25) {
            ASSERT_TRUE(copy.player->pose());
            ASSERT_NEAR(twistOf(skin), expectedAt(samples), 1e-6) << samples << ", " << baked;
            copy.player->advance(0.25 * played::kFrame);
        }
    }
}

TEST(ClipTwist, StartsAfreshWhereTheTimeJumps) {
    std::vector<double> degrees = kThereAndBack;
    degrees.resize(40, 40.0);
    const osgSkin::Clip clip = twistingClip(degrees);
    const played::Character character(clip);
    const auto copies = osgSkin::ClipCharacter::create(*character.scene);
    const auto sampled = osgSkin::SampledClip::create(clip, character.rig);
    const auto poseAt = [&](const osgSkin::ClipCharacter::Instance& copy, double samples) {
        copy.player->setLayer(0, {sampled, samples * played::kFrame});
        EXPECT_TRUE(copy.player->pose());
        return twistOf(played::skinOf(*copy.node));
    };
    const auto copy = copies->makeInstance();
    poseAt(copy, 4.0);
    EXPECT_NEAR(poseAt(copy, 5.0), 200.0, 1e-6);
    poseAt(copy, 30.0);
    EXPECT_NEAR(poseAt(copy, 5.0), -160.0, 1e-6); // by more than kSeekSeconds
    // What was baked depends on the clip's time alone.
    copies->bake(sampled);
    const auto baked = copies->makeInstance();
    for (const double samples : {5.0, 30.0, 5.0, 5.25}) {
        EXPECT_NEAR(poseAt(baked, samples), samples > 20.0 ? 40.0 : expectedAt(samples), 1e-6);
        EXPECT_NEAR(poseAt(baked, 5.5), 220.0, 1e-6) << samples;
    }
}
