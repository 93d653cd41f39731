// SPDX-License-Identifier: MIT
// A twist that passes through 180 degrees, of a skeleton and of a clip.
#include "Notices.h"
#include "PlayedFigure.h"
#include "TubeSkin.h"
#include "UpdateAt.h"

#include <osgSkin/UpdateDeformableSkin>
#include <osgSkinMotion/ClipCharacter>

#include <gtest/gtest.h>
#include <osg/Group>

#include <cmath>
#include <vector>

namespace {

const double kDegree = osg::PI / 180.0;

/// The middle joint's twist, in degrees.
double twistOf(const osgSkin::DeformableSkin& skin) {
    return skin.getPose().transform(1).split.twistAngle / kDegree;
}

class ContinuousTwist : public testing::Test {
protected:
    ContinuousTwist() {
        skin->setUpdateCallback(callback);
        skeleton->addChild(skin);
    }

    /// The twist after an update at `time` with its bone rotated.
    double twistAt(double time, double degrees) {
        test::rotateMiddle(*skeleton, degrees * kDegree, osg::Vec3d(0, 1, 0));
        test::updateAt(*skeleton, time);
        return twistOf(*skin);
    }

    osg::ref_ptr<osgAnimation::Skeleton> skeleton = test::makeBones();
    osg::ref_ptr<osgSkin::DeformableSkin> skin = test::makeSkin();
    osg::ref_ptr<osgSkin::UpdateDeformableSkin> callback = new osgSkin::UpdateDeformableSkin;
};

} // namespace

TEST_F(ContinuousTwist, IsOnByDefault) {
    EXPECT_TRUE(callback->getUnwrapTwist());
    twistAt(0.0, 170.0);
    EXPECT_NEAR(twistAt(0.1, 190.0), 190.0, 1e-9);
    callback->setUnwrapTwist(false);
    twistAt(0.15, 170.0);
    EXPECT_NEAR(twistAt(0.2, 190.0), -170.0, 1e-9);
}

TEST_F(ContinuousTwist, PassesThroughHalfATurnAndBack) {
    double time = 0.0;
    for (double degrees = 0.0; degrees < 270.0; degrees += 10.0)
        ASSERT_NEAR(twistAt(time += 0.05, degrees), degrees, 1e-9);
    for (double degrees = 260.0; degrees > -270.0; degrees -= 10.0)
        ASSERT_NEAR(twistAt(time += 0.05, degrees), degrees, 1e-9);
}

TEST_F(ContinuousTwist, StaysBelow270Degrees) {
    double time = 0.0;
    for (double degrees = 0.0; degrees < 2000.0; degrees += 10.0) {
        const double twist = twistAt(time += 0.05, degrees);
        ASSERT_LT(std::abs(twist), 270.0) << degrees;
        if (std::abs(std::remainder(degrees, 360.0)) < 90.0) {
            ASSERT_NEAR(twist, std::remainder(degrees, 360.0), 1e-9) << degrees;
        }
    }
}

/// A looping clip whose end is far from its beginning.
TEST_F(ContinuousTwist, RepeatsInEachLoop) {
    const double clip[] = {-30.0, 30.0, 100.0, 170.0, 220.0, 250.0};
    double time = 0.0;
    for (int round = 0; round < 4; ++round)
        for (const double degrees : clip)
            ASSERT_NEAR(twistAt(time += 0.05, degrees), degrees, 1e-9) << round;
}

/// Posing a motion's frames in any order, as baking does, gives the same results.
TEST_F(ContinuousTwist, PoseWithoutUpdateDependsOnlyOnTheBones) {
    twistAt(0.0, 170.0);
    EXPECT_NEAR(twistAt(0.1, 190.0), 190.0, 1e-9);
    for (int i = 0; i < 2; ++i) {
        EXPECT_TRUE(callback->pose(*skin, *skeleton));
        EXPECT_NEAR(twistOf(*skin), -170.0, 1e-9);
    }
}

TEST_F(ContinuousTwist, VerticesFollowIt) {
    double time = 0.0;
    for (double degrees = 0.0; degrees < 270.0; degrees += 10.0) {
        twistAt(time += 0.05, degrees);
        // Halfway up the middle joint's region, half of the twist is applied, including any excess
        // over 2 pi. The ring of vertices at the joint has ratio one half.
        const osg::Vec3 at = test::verticesOf(*skin)[std::size_t(8) * 12]; // height 2, at angle 0
        const double half = 0.5 * degrees * kDegree;
        ASSERT_NEAR(at.x(), std::cos(half), 1e-5) << degrees;
        ASSERT_NEAR(at.z(), -std::sin(half), 1e-5) << degrees;
    }
}

TEST_F(ContinuousTwist, FollowsABoneThatIsAddedAgain) {
    osg::Group* const root = skeleton->getChild(0)->asGroup();
    const osg::ref_ptr<osg::Group> middle = root->getChild(0)->asGroup();
    twistAt(0.0, 10.0);
    for (int round = 0; round < 2; ++round) {
        root->removeChild(middle);
        const test::Notices notices;
        test::updateAt(*skeleton, 0.0);
        EXPECT_EQ(twistOf(*skin), 0.0);
        root->addChild(middle);
        EXPECT_NEAR(twistAt(0.1, 30.0), 30.0, 1e-9);
    }
}

TEST_F(ContinuousTwist, BoneScaledToZeroDoesNotStopOthers) {
    twistAt(0.0, 0.0);
    auto& root = static_cast<osgAnimation::Bone&>(*skeleton->getChild(0));
    osgAnimation::Bone& middle = test::middleOf(*skeleton);
    auto& end = static_cast<osgAnimation::Bone&>(*middle.getChild(0));
    const osg::Matrixd moved = osg::Matrix::translate(7, 0, 0);
    root.setMatrixInSkeletonSpace(moved);
    const osg::Matrixd nothing =
        osg::Matrix::scale(0, 0, 0) * osg::Matrix::translate(0, 2, 0) * moved;
    middle.setMatrixInSkeletonSpace(nothing);
    end.setMatrixInSkeletonSpace(osg::Matrix::translate(0, 2, 0) * nothing);
    const test::Notices notices;
    test::updateAt(*skeleton, 0.0);
    EXPECT_EQ(notices.text(), "");
    const auto& rest =
        static_cast<const osg::Vec3Array&>(*skin->getRestGeometry()->getVertexArray());
    const std::vector<osg::Vec3> now = test::verticesOf(*skin);
    for (unsigned int v = 0; v < now.size(); ++v) {
        if (rest[v].y() < 0.5f) {
            EXPECT_LT((now[v] - rest[v] * moved).length(), 1e-4f) << v;
        }
        if (rest[v].y() > 3.5f) {
            EXPECT_LT((now[v] - osg::Vec3(7, 2, 0)).length(), 0.01f) << v;
        }
    }
}

TEST_F(ContinuousTwist, WarnsOnceAboutASkinWithoutASkeleton) {
    const osg::ref_ptr<osg::Group> beside = new osg::Group;
    beside->addChild(skeleton);
    skeleton->removeChild(skin);
    beside->addChild(skin);
    const test::Notices notices;
    for (int i = 0; i < 3; ++i) test::updateAt(*beside, i);
    EXPECT_EQ(notices.lines(), 1u);
    EXPECT_TRUE(notices.say("is below no osgAnimation::Skeleton")) << notices.text();
}

TEST_F(ContinuousTwist, ResetsWhenTimeOrTwistJumps) {
    double time = 1.0;
    const auto wind = [&] {
        for (double degrees = 100.0; degrees <= 200.0; degrees += 20.0)
            twistAt(time += 0.05, degrees);
        EXPECT_NEAR(twistOf(*skin), 200.0, 1e-9);
    };
    wind();
    EXPECT_NEAR(twistAt(time += 1.0, 200.1), -159.9, 1e-9);
    wind();
    EXPECT_NEAR(twistAt(time -= 1.0, 200.1), -159.9, 1e-9);
    wind();
    callback->startTwistAfresh();
    EXPECT_NEAR(twistAt(time += 0.01, 200.0), -160.0, 1e-9);
    wind();
    EXPECT_NEAR(twistAt(time += 0.05, 20.0), 20.0, 1e-9); // too far for a continuous motion
    wind();
    callback->setUnwrapTwist(false);
    twistAt(time += 0.05, 200.0);
    EXPECT_NEAR(twistAt(time += 0.05, 200.1), -159.9, 1e-9);
}

namespace {

/// The middle joint twists by these degrees about the tube, one per sample.
osgSkin::Clip twistingClip(const std::vector<double>& degrees) {
    osgSkin::Clip clip = played::someClip(degrees.size(), 0.0);
    for (std::size_t f = 0; f < degrees.size(); ++f)
        clip.rotations[3 * f + 1] = glm::angleAxis(degrees[f] * kDegree, glm::dvec3(0, 1, 0));
    return clip;
}

const std::vector<double> kThereAndBack{0.0,   40.0,  80.0,  120.0, 160.0, 200.0,
                                        240.0, 200.0, 160.0, 120.0, 80.0,  40.0};

double expectedAt(double samples) {
    const double at = samples - 12.0 * std::floor(samples / 12.0);
    return at <= 6.0 ? 40.0 * at : 40.0 * (12.0 - at);
}

} // namespace

TEST(ClipTwist, PassesThroughHalfATurnInEachLoop) {
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

TEST(ClipTwist, ResetsWhenTimeJumps) {
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
    // Baked data depend on the clip's time alone.
    copies->bake(sampled);
    const auto baked = copies->makeInstance();
    for (const double samples : {5.0, 30.0, 5.0, 5.25}) {
        EXPECT_NEAR(poseAt(baked, samples), samples > 20.0 ? 40.0 : expectedAt(samples), 1e-6);
        EXPECT_NEAR(poseAt(baked, 5.5), 220.0, 1e-6) << samples;
    }
}
