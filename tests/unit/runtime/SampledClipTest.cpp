// SPDX-License-Identifier: MIT
#include "BentClip.h"
#include "Turns.h"

#include <osgSkin/Error>
#include <osgSkinMotion/ClipCharacter>
#include <osgSkinMotion/MakeAnimation>
#include <osgSkinRig/MakeSkeleton>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

using namespace played;
using osgSkin::SampledClip;

TEST(SampledClip, FindsTheSamplesAtATime) {
    const auto clip = SampledClip::create(someClip(10, 0.3), tubeRig());
    ASSERT_EQ(clip->sampleCount(), 10u);
    EXPECT_NEAR(clip->duration(), 10.0 * kFrame, 1e-12);
    const auto expectInterval = [&](double time, bool loop, std::size_t from, std::size_t to,
                                    double share) {
        SCOPED_TRACE(time);
        const SampledClip::Interval interval = clip->intervalAt(time, loop);
        EXPECT_EQ(interval.from, from);
        EXPECT_EQ(interval.to, to);
        EXPECT_NEAR(interval.share, share, 1e-6);
    };
    for (std::size_t i = 0; i < 10; ++i)
        for (const double loops : {-3.0, 0.0, 1000.0}) {
            const SampledClip::Interval interval =
                clip->intervalAt(loops * clip->duration() + double(i) * kFrame, true);
            EXPECT_EQ(interval.from, i);
            EXPECT_EQ(interval.share, 0.0);
        }
    expectInterval(9.5 * kFrame, true, 9, 0, 0.5);
    expectInterval(-0.25 * kFrame, true, 9, 0, 0.75);
    expectInterval(9.5 * kFrame, false, 9, 9, 0.0);
    expectInterval(-1.0, false, 0, 0, 0.0);
    expectInterval(std::numeric_limits<double>::quiet_NaN(), true, 0, 0, 0.0);
    expectInterval(std::numeric_limits<double>::infinity(), false, 0, 0, 0.0);
    const auto single = SampledClip::create(someClip(1, 0.3), tubeRig());
    EXPECT_EQ(single->intervalAt(17.3, true).from, 0u);
    EXPECT_EQ(single->intervalAt(-17.3, true).to, 0u);
}

TEST(SampledClip, BlendMatchesSlerp) {
    std::mt19937_64 random(3);
    std::uniform_real_distribution<double> share(0.0, 1.0);
    for (int i = 0; i < 20000; ++i) {
        osgSkin::JointSample a, b;
        a.rotation = test::randomRotation(random);
        // Small and large angles, on both sides of the switch from the sines to a series.
        const double angle = i % 2 == 0 ? 1.2 * share(random) : 1e-6 * share(random);
        b.rotation = a.rotation * glm::angleAxis(angle, test::randomUnit(random));
        if (i % 3 == 0) b.rotation = -b.rotation;
        const double t = share(random);
        const glm::dquat between = osgSkin::blend(a, b, t).rotation;
        const glm::dquat exact = glm::slerp(a.rotation, b.rotation, t);
        ASSERT_NEAR(std::abs(glm::dot(between, exact)), 1.0, 1e-14) << angle;
        ASSERT_NEAR(glm::length(between), 1.0, 1e-14);
        ASSERT_NEAR(glm::angle(glm::conjugate(a.rotation) *
                               (glm::dot(between, a.rotation) < 0.0 ? -between : between)),
                    t * angle, 1e-7);
    }
}

TEST(SampledClip, RejectsInvalidClipsAndRates) {
    EXPECT_THROW(SampledClip::create(osgSkin::Clip(), tubeRig()), osgSkin::Error);
    const osg::ref_ptr<osgAnimation::Animation> none = new osgAnimation::Animation;
    const osgAnimation::Animation& animation = *none;
    const osg::ref_ptr<osgAnimation::Skeleton> empty = new osgAnimation::Skeleton;
    EXPECT_THROW(SampledClip::create(animation, *empty), osgSkin::Error);
    const auto skeleton = osgSkin::makeSkeleton(tubeRig());
    for (const double rate : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN()})
        EXPECT_THROW(SampledClip::create(animation, *skeleton, rate), osgSkin::Error);
    EXPECT_EQ(SampledClip::create(animation, *skeleton)->sampleCount(), 1u);
    osg::ref_ptr<osg::Group> nothing = new osg::Group;
    EXPECT_THROW(osgSkin::ClipCharacter::create(*nothing), osgSkin::Error);
}

TEST(SampledClip, FindsJointsAndTheRoot) {
    const osg::ref_ptr<const SampledClip> still = bentClip();
    EXPECT_EQ(still->find("root"), 0);
    EXPECT_EQ(still->find("end"), 2);
    EXPECT_EQ(still->find("nobody"), -1);
    EXPECT_EQ(still->rootJoint(), 0u); // no joint is translated
    osgSkin::Clip motion = bentMotion();
    motion.rootPositions[1].x = 3.0;
    const osg::ref_ptr<const SampledClip> going = SampledClip::create(motion, tubeRig());
    EXPECT_EQ(going->rootJoint(), 0u);
    EXPECT_NEAR(glm::distance(going->sample(1)->translation, going->sample(0)->translation), 3.0,
                1e-12);
}

/// A key at the end of all times must not fill the memory.
TEST(SampledClip, RejectsTooManySamples) {
    osgSkin::Clip slow = bentMotion();
    slow.frameTime = 1e12;
    const auto animation = osgSkin::makeAnimation(slow, tubeRig());
    const auto skeleton = osgSkin::makeSkeleton(tubeRig());
    EXPECT_THROW(SampledClip::create(*animation, *skeleton), osgSkin::Error);
    slow.frameTime = 0.1;
    const auto good = osgSkin::makeAnimation(slow, tubeRig());
    EXPECT_THROW(SampledClip::create(*good, *skeleton, 1e300), osgSkin::Error);
    EXPECT_EQ(SampledClip::create(*good, *skeleton, 10.0)->sampleCount(), 2u);
}

/// osgAnimation stretches keys to the animation's duration.
TEST(SampledClip, FollowsTheAnimationsDuration) {
    osgSkin::Clip motion = bentMotion();
    motion.rotations[4] = glm::angleAxis(1.4, glm::dvec3(1, 0, 0)); // the middle one rotates by 1
    const auto animation = osgSkin::makeAnimation(motion, tubeRig());
    const auto skeleton = osgSkin::makeSkeleton(tubeRig());
    const auto own = SampledClip::create(*animation, *skeleton, 40.0);
    animation->setDuration(2.0 * animation->getDuration());
    const auto slow = SampledClip::create(*animation, *skeleton, 20.0);
    ASSERT_EQ(slow->sampleCount(), own->sampleCount());
    EXPECT_NEAR(slow->duration(), 2.0 * own->duration(), 1e-6);
    for (std::size_t i = 0; i < own->sampleCount(); ++i)
        EXPECT_NEAR(glm::angle(slow->sample(i)[1].rotation), glm::angle(own->sample(i)[1].rotation),
                    1e-5);
    EXPECT_GT(glm::angle(own->sample(own->sampleCount() / 2)[1].rotation),
              glm::angle(own->sample(0)[1].rotation) + 0.3);
}

/// Clips that move other bones: none affects the next one, nor the scene.
TEST(SampledClip, SamplingDoesNotMoveTheSkeleton) {
    const auto skeleton = osgSkin::makeSkeleton(tubeRig());
    const auto whole = osgSkin::makeAnimation(bentMotion(), tubeRig());
    const auto onlyOf = [&whole](const char* bone) {
        const osg::ref_ptr<osgAnimation::Animation> animation = new osgAnimation::Animation;
        for (const auto& channel : whole->getChannels())
            if (channel->getTargetName() == bone) animation->addChannel(channel->clone());
        return animation;
    };
    const auto middle = SampledClip::create(*onlyOf("middle"), *skeleton, 10.0);
    const auto end = SampledClip::create(*onlyOf("end"), *skeleton, 10.0);
    const auto angleIn = [](const SampledClip& clip, const char* joint) {
        return glm::angle(clip.sample(0)[clip.find(joint)].rotation);
    };
    EXPECT_NEAR(angleIn(*middle, "middle"), 0.4, 1e-6);
    EXPECT_NEAR(angleIn(*middle, "end"), 0.0, 1e-6);
    EXPECT_NEAR(angleIn(*end, "end"), 0.9, 1e-6);
    EXPECT_NEAR(angleIn(*end, "middle"), 0.0, 1e-6);
}

/// The application's own callback may come before the one that moves the bone.
TEST(SampledClip, AcceptsCallbacksBeforeUpdateBone) {
    const auto skeleton = osgSkin::makeSkeleton(tubeRig());
    osg::Node& root = *skeleton->getChild(0);
    const osg::ref_ptr<osg::Callback> update = root.getUpdateCallback();
    const osg::ref_ptr<osg::NodeCallback> own = new osg::NodeCallback;
    own->setNestedCallback(update);
    root.setUpdateCallback(own);
    const auto animation = osgSkin::makeAnimation(bentMotion(), tubeRig());
    const auto clip = SampledClip::create(*animation, *skeleton, 10.0);
    EXPECT_NEAR(glm::angle(clip->sample(0)[clip->find("root")].rotation), 0.1, 1e-6);
}
