// SPDX-License-Identifier: MIT
// Layers of clips, compared with the same blends computed here.
#include "PlayedFigure.h"

#include <osgSkin/Error>
#include <osgSkinMotion/ClipPlayer>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

using namespace played;

using osgSkin::ClipPlayer;
using osgSkin::JointSample;
using osgSkin::SampledClip;
using Names = std::vector<std::string>;

namespace {

/// A share of a rotation, the short way.
glm::dquat partOf(const glm::dquat& q, double share) {
    const double sign = q.w < 0.0 ? -1.0 : 1.0;
    const glm::dvec3 axis = sign * glm::dvec3(q.x, q.y, q.z);
    const double sine = glm::length(axis);
    if (sine == 0.0) return {1.0, 0.0, 0.0, 0.0};
    const double half = share * std::atan2(sine, sign * q.w);
    return {std::cos(half), axis * (std::sin(half) / sine)};
}

JointSample over(const JointSample& below, const JointSample& above, double weight) {
    return {partOf(above.rotation * glm::conjugate(below.rotation), weight) * below.rotation,
            below.translation + weight * (above.translation - below.translation),
            below.scale + weight * (above.scale - below.scale)};
}

JointSample plus(const JointSample& below, const JointSample& from, const JointSample& to,
                 double weight) {
    return {partOf(to.rotation * glm::conjugate(from.rotation), weight) * below.rotation,
            below.translation + weight * (to.translation - from.translation),
            below.scale * (1.0 + weight * (to.scale / from.scale - 1.0))};
}

/// All joints of the tube rotate, move and change their size.
osg::ref_ptr<const SampledClip> livelyClip(double seed) {
    std::vector<SampledClip::Joint> joints;
    for (const osgSkin::RestJoint& joint : tubeRig().joints)
        joints.push_back({joint.name, joint.parent, joint.centre});
    std::vector<JointSample> samples;
    for (int i = 0; i < 30; ++i) {
        const double at = seed + i / 5.0 + 0.1 * (i % 3);
        const glm::dvec3 axis(std::cos(at), 1.0, std::sin(at));
        samples.push_back({glm::angleAxis(1.5 * std::sin(at), glm::normalize(axis)), 0.2 * axis,
                           1.0 + 0.2 * std::cos(at)});
    }
    return SampledClip::create("lively", joints, samples, kFrame);
}

/// A player and a skin that shows what it plays.
struct Layered {
    osg::ref_ptr<osgSkin::DeformableSkin> skin = test::makeSkin();
    osg::ref_ptr<ClipPlayer> player = new ClipPlayer;

    Layered() { player->addSkin(skin); }
    void expectJoint(std::size_t joint, const JointSample& expected) const {
        const osgSkin::JointTransform is = skin->getPose().transform(joint);
        EXPECT_NEAR(std::abs(glm::dot(is.rotation, expected.rotation)), 1.0, 1e-12) << joint;
        EXPECT_LE(glm::length(is.translation - expected.translation), 1e-6) << joint;
        EXPECT_NEAR(is.scale, expected.scale, 1e-6) << joint;
    }
    /// Of all joints, where layer 0 alone is not masked.
    void expectClip(const SampledClip& clip, double time, bool loop = true) const {
        std::vector<JointSample> joints(3);
        clip.evaluate(time, loop, joints.data());
        for (std::size_t j = 0; j < 3; ++j) expectJoint(j, joints[j]);
    }
};

ClipPlayer::Layer layerOf(const osg::ref_ptr<const SampledClip>& clip, double time, double weight,
                          const Names& joints = {}, bool additive = false, double reference = 0.0) {
    return {clip, time, 1.0, true, weight, joints, additive, reference};
}

} // namespace

TEST(ClipLayers, BlendUpwardsWithMasksAndAdditiveClips) {
    const ClipPlayer::Layer layers[] = {
        layerOf(livelyClip(0.0), 0.0, 1.0),
        layerOf(livelyClip(1.0), 0.1, 0.3),
        layerOf(livelyClip(2.0), 0.2, 0.7, {"middle", "end"}),
        layerOf(livelyClip(3.0), 0.0, 1.0, {"end"}),
        layerOf(livelyClip(4.0), 0.3, 0.6, {}, true, 0.17),
        layerOf(livelyClip(5.0), 0.0, 1.0, {"root", "end"}, true, 2.0 * kFrame),
        layerOf(livelyClip(6.0), 0.0, 0.0),
        layerOf(livelyClip(7.0), 0.0, 0.45, {"middle"}),
    };
    Layered figure;
    std::size_t index = 0;
    for (const ClipPlayer::Layer& layer : layers) figure.player->setLayer(index++, layer);
    for (double time = 0.0; time < 1.0; time += 0.037) {
        ASSERT_TRUE(figure.player->pose());
        for (std::size_t j = 0; j < 3; ++j) {
            JointSample expected;
            for (const ClipPlayer::Layer& layer : layers) {
                const std::string& name = layer.clip->joints()[j].name;
                if (!layer.joints.empty() &&
                    std::find(layer.joints.begin(), layer.joints.end(), name) == layer.joints.end())
                    continue;
                std::vector<JointSample> own(3), reference(3);
                layer.clip->evaluate(layer.time + time, true, own.data());
                layer.clip->evaluate(layer.reference, false, reference.data());
                expected = layer.additive ? plus(expected, reference[j], own[j], layer.weight)
                                          : over(expected, own[j], layer.weight);
            }
            figure.expectJoint(j, expected);
        }
        figure.player->advance(0.037);
    }
}

TEST(ClipLayers, LowestOneIsBlendedWithTheRestPose) {
    Layered figure;
    const auto clip = livelyClip(0.0);
    figure.player->setLayer(2, layerOf(clip, 0.0, 0.25, {"middle"}));
    ASSERT_TRUE(figure.player->pose());
    figure.expectJoint(0, {});
    figure.expectJoint(1, over({}, clip->sample(0)[1], 0.25));
    figure.player->setLayer(2, {});
    EXPECT_FALSE(figure.player->pose());
    figure.player->setLayer(ClipPlayer::kMaxLayers, {clip});
    EXPECT_FALSE(figure.player->getLayer(ClipPlayer::kMaxLayers).clip);
}

TEST(ClipLayers, FadeFromThePresentWeightWithAnEasing) {
    Layered figure;
    const auto weightAfter = [&](double seconds) {
        figure.player->advance(seconds);
        return figure.player->getLayer(3).weight;
    };
    figure.player->fade(3, 1.0, 1.0); // no layer: nothing happens
    figure.player->setLayer(3, layerOf(livelyClip(0.0), 0.0, 0.2));
    figure.player->fade(3, 1.0, 0.8);
    EXPECT_NEAR(weightAfter(0.2), 0.4, 1e-12);
    figure.player->fade(3, 0.0, 0.4, ClipPlayer::Easing::Smooth);
    for (const double share : {0.25, 0.5, 0.75, 1.0, 1.0})
        EXPECT_NEAR(weightAfter(0.1), 0.4 * (1.0 - share * share * (3.0 - 2.0 * share)), 1e-12);
    EXPECT_TRUE(figure.player->getLayer(3).clip) << "it can be faded in again";
    figure.player->fade(3, 7.0, 0.0);
    EXPECT_EQ(figure.player->getLayer(3).weight, 1.0);
    figure.player->fade(3, std::nan(""), 0.0);
    EXPECT_EQ(figure.player->getLayer(3).weight, 1.0);
}

TEST(ClipLayers, PlayOnceAndKeepTheLastPoseOrEnd) {
    const auto clip = livelyClip(0.0), other = livelyClip(1.0);
    const double end = 9.0 * kFrame;
    Layered figure;
    figure.player->setLayer(0, {other, 0.0, 0.0});
    figure.player->setLayer(1, {clip, 0.0, 1.0, false});
    figure.player->advance(5.0);
    ASSERT_TRUE(figure.player->pose());
    figure.expectClip(*clip, end);
    for (const double speed : {0.5, -0.5}) { // 0.2 seconds until the end
        ClipPlayer::Layer layer{clip, speed > 0.0 ? end - 0.1 : 0.1, speed, false};
        layer.fadeOut = 0.12;
        figure.player->setLayer(1, layer);
        figure.player->advance(0.1); // the fade begins
        EXPECT_NEAR(figure.player->getLayer(1).weight, 1.0, 1e-12);
        figure.player->advance(0.025);
        EXPECT_NEAR(figure.player->getLayer(1).weight, 0.75, 1e-9);
        figure.player->advance(0.0751);
        EXPECT_FALSE(figure.player->getLayer(1).clip);
        ASSERT_TRUE(figure.player->pose());
        figure.expectClip(*other, 0.0);
        figure.player->setLayer(1, layer);
        figure.player->advance(60.0);
        EXPECT_FALSE(figure.player->getLayer(1).clip);
    }
}

TEST(ClipLayers, SeekAndChangeTheirSpeed) {
    Layered figure;
    const auto clip = livelyClip(0.0);
    figure.player->setLayer(4, {clip});
    figure.player->seek(4, 0.11);
    figure.player->setSpeed(4, -0.5);
    figure.player->advance(0.1);
    ASSERT_TRUE(figure.player->pose());
    figure.expectClip(*clip, 0.06);
    figure.player->seek(4, std::nan(""));
    figure.player->setSpeed(4, std::nan(""));
    EXPECT_EQ(figure.player->getLayer(4).time, 0.0);
    EXPECT_EQ(figure.player->getLayer(4).speed, 0.0);
    figure.player->seek(30, 1.0); // not set: nothing happens
    EXPECT_EQ(figure.player->getLayer(30).time, 0.0);
}

TEST(ClipLayers, StayOverPlayAndPlayOn) {
    Layered figure;
    const auto walk = livelyClip(0.0), run = livelyClip(1.0), nod = livelyClip(2.0);
    figure.player->setLayer(5, layerOf(nod, 0.0, 0.5, {"end"}, true));
    figure.player->play({walk, 0.0, 0.0});
    figure.player->play({run, 0.1, 0.0}, 0.2, ClipPlayer::Easing::Smooth);
    figure.player->advance(0.05);
    EXPECT_NEAR(figure.player->getWeight(), 0.15625, 1e-12);
    figure.player->advance(0.151);
    EXPECT_EQ(figure.player->getLayer(0).clip, run);
    figure.player->seek(5, 6.0 * kFrame);
    ASSERT_TRUE(figure.player->playOn("middle", {walk, 0.2, 0.0}, 0.0));
    ASSERT_TRUE(figure.player->pose());
    figure.expectJoint(0, run->sample(3)[0]);
    figure.expectJoint(1, walk->sample(6)[1]);
    figure.expectJoint(2, plus(walk->sample(6)[2], nod->sample(0)[2], nod->sample(6)[2], 0.5));
}

TEST(ClipLayers, AcceptTheirOwnLayers) {
    Layered figure;
    const auto clip = livelyClip(0.0);
    figure.player->setLayer(0, {clip, 0.1});
    figure.player->setLayer(9, figure.player->getLayer(0));
    figure.player->play(figure.player->getLayer(9));
    ASSERT_TRUE(figure.player->playOn("end", figure.player->getLayer(9), 0.0));
    EXPECT_EQ(figure.player->getLayer(9).time, 0.1);
    ASSERT_TRUE(figure.player->pose());
    figure.expectClip(*clip, 0.1);
}

TEST(ClipLayers, BlendTheRootsMovement) {
    const auto clipOf = [](double speed) { // 0.1 * speed a sample
        return SampledClip::create(someClip(12, speed), tubeRig());
    };
    Layered figure;
    figure.player->setRoot(ClipPlayer::Root::Extracted);
    const auto stepOf = [&] {
        figure.player->advance(kFrame);
        return figure.player->takeRootMotion().x();
    };
    figure.player->setLayer(0, {clipOf(0.2)});
    figure.player->setLayer(3, layerOf(clipOf(0.6), 0.0, 0.5));
    EXPECT_NEAR(stepOf(), 0.04, 1e-9);
    figure.player->setLayer(4, layerOf(clipOf(1.0), 0.0, 1.0, {"middle", "end"}));
    EXPECT_NEAR(stepOf(), 0.04, 1e-9) << "its root is masked";
    figure.player->setLayer(5, layerOf(clipOf(0.4), 0.0, 0.25, {}, true));
    EXPECT_NEAR(stepOf(), 0.05, 1e-9);
    figure.player->setLayer(6, layerOf(clipOf(0.8), 0.0, 0.75));
    EXPECT_NEAR(stepOf(), 0.25 * 0.05 + 0.75 * 0.08, 1e-9);
    // What is removed from the pose is what was reported.
    ASSERT_TRUE(figure.player->pose());
    EXPECT_NEAR(figure.skin->getPose().transform(0).translation.x, 0.0, 1e-9);
}

TEST(ClipLayers, TwistsContinueWhereAnUnseenClipIsSet) {
    osgSkin::Clip twisting = someClip(12, 0.0);
    for (std::size_t f = 0; f < twisting.frames; ++f)
        twisting.rotations[3 * f + 1] = glm::angleAxis(0.5 * double(f), glm::dvec3(0, 1, 0));
    Layered figure;
    figure.player->setLayer(0, {SampledClip::create(twisting, tubeRig())});
    for (int i = 0; i < 8; ++i) {
        ASSERT_TRUE(figure.player->pose());
        figure.player->advance(kFrame);
    }
    figure.player->setLayer(3, layerOf(livelyClip(0.0), 0.0, 0.0, {"end"}));
    figure.player->fade(3, 1.0, 0.3);
    figure.player->advance(0.0);
    ASSERT_TRUE(figure.player->pose());
    EXPECT_NEAR(figure.skin->getPose().transform(1).split.twistAngle, 4.0, 1e-6);
    figure.player->setLayer(3, {livelyClip(0.0)}); // at once: it jumps
    figure.player->setLayer(3, layerOf(livelyClip(0.0), 0.0, 1.0, {"end"}));
    ASSERT_TRUE(figure.player->pose());
    EXPECT_NEAR(figure.skin->getPose().transform(1).split.twistAngle, 4.0 - 2.0 * osg::PI, 1e-6);
}

TEST(JointsBelow, AreFoundByNameAndByRole) {
    const auto clip = livelyClip(0.0);
    EXPECT_EQ(osgSkin::jointsBelow(*clip, "middle"), (Names{"middle", "end"}));
    EXPECT_THROW(osgSkin::jointsBelow(*clip, "tail"), osgSkin::Error);
    EXPECT_THROW(osgSkin::jointsBelow(*clip, "Spine"), osgSkin::Error);
    std::vector<SampledClip::Joint> joints;
    const auto add = [&](const char* name, int parent, const glm::dvec3& centre) {
        joints.push_back({name, parent, centre});
    };
    add("Hips", -1, {0, 10, 0});
    add("LeftUpLeg", 0, {1, 9, 0});
    add("LeftLeg", 1, {1, 5, 0});
    add("LeftFoot", 2, {1, 1, 0});
    add("Spine", 0, {0, 12, 0});
    add("LeftArm", 4, {2, 15, 0});
    add("LeftForeArm", 5, {5, 15, 0});
    add("LeftHand", 6, {8, 15, 0});
    add("Head", 4, {0, 17, 0});
    add("RightUpLeg", 0, {-1, 9, 0});
    add("RightLeg", 9, {-1, 5, 0});
    add("RightFoot", 10, {-1, 1, 0});
    add("RightArm", 4, {-2, 15, 0});
    add("RightForeArm", 12, {-5, 15, 0});
    add("RightHand", 13, {-8, 15, 0});
    const auto body =
        SampledClip::create("body", joints, std::vector<JointSample>(joints.size()), 1.0);
    EXPECT_EQ(osgSkin::jointsBelow(*body, "Spine"),
              (Names{"Spine", "LeftArm", "LeftForeArm", "LeftHand", "Head", "RightArm",
                     "RightForeArm", "RightHand"}));
    EXPECT_EQ(osgSkin::jointsBelow(*body, "LeftLowerArm"), (Names{"LeftForeArm", "LeftHand"}));
    const osg::ref_ptr<osgSkin::ClipPlayer> player = new osgSkin::ClipPlayer;
    EXPECT_TRUE(player->playOn("LeftLowerArm", {body}, 0.0));
    EXPECT_EQ(player->getLayer(osgSkin::ClipPlayer::kPartLayer).joints,
              (Names{"LeftForeArm", "LeftHand"}));
    osgSkin::ClipPlayer::Layer layer{body};
    layer.joints = {"LeftLowerArm", "Head"};
    player->setLayer(3, layer);
    EXPECT_EQ(player->getLayer(3).joints, (Names{"LeftForeArm", "Head"}));
    layer.joints = {"LeftForArm"};
    try {
        player->setLayer(3, layer);
        FAIL() << "expected an error";
    } catch (const osgSkin::Error& error) {
        EXPECT_NE(std::string(error.what()).find("did you mean \"LeftForeArm\"?"),
                  std::string::npos)
            << error.what();
    }
}
