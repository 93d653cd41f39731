// SPDX-License-Identifier: MIT
// Contacts of feet in clips, layers in step and blend spaces.
#include "WalkingFigure.h"

#include <osgSkin/Error>
#include <osgSkinMotion/BlendSpace>
#include <osgSkinMotion/ClipPlayer>

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

namespace {

using osgSkin::BlendSpace;
using osgSkin::ClipPlayer;
using osgSkin::FootContacts;
using osgSkin::SampledClip;
using Clip = osg::ref_ptr<const SampledClip>;

Clip sampled(const osgSkin::Clip& clip) {
    return SampledClip::create(clip, walking::figureRig());
}

ClipPlayer::Layer inStep(const Clip& clip, double time = 0.0) {
    ClipPlayer::Layer layer{clip, time};
    layer.inStep = true;
    return layer;
}

/// The difference of two layers' phases, from -0.5 to 0.5.
double phaseBetween(const ClipPlayer& player, std::size_t a, std::size_t b) {
    const auto phaseOf = [&](std::size_t index) {
        const ClipPlayer::Layer& layer = player.getLayer(index);
        return layer.clip->footContacts().phaseAt(layer.time);
    };
    const double between = phaseOf(a) - phaseOf(b);
    return between - std::round(between);
}

} // namespace

TEST(FootContacts, AreThoseOfAWalk) {
    for (const bool isOnTheSpot : {false, true})
        for (const double cycles : {1.0, 3.0}) {
            walking::GaitOf gait = walking::walk();
            gait.isOnTheSpot = isOnTheSpot;
            gait.cycles = cycles;
            const Clip clip = sampled(walking::gaitClip(gait));
            const FootContacts& contacts = clip->footContacts();
            EXPECT_NEAR(glm::length(contacts.velocity + glm::dvec3(0.0, 1.5, 0.0)), 0.0, 0.1);
            ASSERT_EQ(contacts.steps.size(), static_cast<std::size_t>(2.0 * cycles));
            // The middles of the stances of gaitClip().
            EXPECT_NEAR(contacts.phaseAt(0.0) - std::round(contacts.phaseAt(0.0)), 0.0, 0.03);
            EXPECT_NEAR(contacts.phaseAt(0.5) - contacts.phaseAt(0.0), 0.5, 0.03);
            for (const FootContacts::Contact& contact : contacts.all)
                EXPECT_NEAR(contact.end - contact.begin, 0.6, 0.1);
        }
}

TEST(FootContacts, AreNoneWithoutSteps) {
    EXPECT_FALSE(sampled(walking::idleClip())->footContacts().hasSteps());
    EXPECT_TRUE(sampled(walking::idleClip())->footContacts().all.empty());
}

TEST(FootContacts, HaveATimeForEachPhase) {
    const FootContacts contacts{{}, {}, {0.3, 0.7}, 1.0};
    for (const double time : {-7.2, 0.0, 0.3, 0.5, 0.7, 0.95, 1.3, 12.6}) {
        EXPECT_NEAR(contacts.timeAt(contacts.phaseAt(time)), time, 1e-12);
        EXPECT_NEAR(contacts.phaseAt(time + 1.0), contacts.phaseAt(time) + 1.0, 1e-12);
    }
    EXPECT_NEAR(contacts.phaseAt(0.7), 0.5, 1e-12);
    EXPECT_NEAR(contacts.rateAt(0.4), 0.5 / 0.4, 1e-12);
    EXPECT_NEAR(contacts.rateAt(0.1), 0.5 / 0.6, 1e-12);
}

TEST(FootEvents, AreCalledOnceForEachStep) {
    const Clip walk = sampled(walking::gaitClip(walking::walk()));
    const osg::ref_ptr<ClipPlayer> player = new ClipPlayer;
    std::string steps;
    player->addFootEvents(walk, [&](ClipPlayer&, std::size_t foot) { steps += "LR"[foot]; });
    player->setLayer(0, {walk, 0.1});
    for (int i = 0; i < 200; ++i) player->advance(0.01);
    EXPECT_EQ(steps, "RLRL");
}

TEST(LayersInStep, ShareTheirPhase) {
    const Clip walk = sampled(walking::gaitClip(walking::walk())),
               run = sampled(walking::gaitClip(walking::run()));
    const osg::ref_ptr<ClipPlayer> player = new ClipPlayer;
    player->play(inStep(walk));
    player->advance(0.37);
    EXPECT_DOUBLE_EQ(player->getLayer(0).time, 0.37); // alone it plays as ever
    player->play(inStep(run, 0.6), 0.4);
    double before = 0.37;
    for (int i = 0; i < 20; ++i) {
        player->advance(0.01);
        EXPECT_NEAR(phaseBetween(*player, 0, 1), 0.0, 1e-9);
        EXPECT_GT(player->getLayer(0).time, before);
        before = player->getLayer(0).time;
    }
    // Fades back from where it is.
    const double weight = player->getWeight();
    player->play(inStep(walk), 0.4);
    EXPECT_EQ(player->getLayer(1).clip, walk);
    EXPECT_NEAR(player->getWeight(), 1.0 - weight, 1e-12);
    player->advance(0.5);
    EXPECT_EQ(player->getLayer(0).clip, walk);
}

TEST(LayersInStep, LeaveClipsWithoutStepsAlone) {
    const Clip walk = sampled(walking::gaitClip(walking::walk())),
               idle = sampled(walking::idleClip());
    const osg::ref_ptr<ClipPlayer> player = new ClipPlayer;
    player->play(inStep(walk, 0.2));
    player->play(inStep(idle, 0.3), 1.0);
    player->advance(0.25);
    EXPECT_DOUBLE_EQ(player->getLayer(0).time, 0.45);
    EXPECT_DOUBLE_EQ(player->getLayer(1).time, 0.55);
}

TEST(RootFromFeet, MovesAClipOnTheSpot) {
    walking::GaitOf gait = walking::walk();
    gait.isOnTheSpot = true;
    const osg::ref_ptr<ClipPlayer> player = new ClipPlayer;
    player->setRoot(ClipPlayer::Root::FromFeet, osg::Vec3d(0, 0, 1));
    player->setLayer(0, {sampled(walking::gaitClip(gait))});
    for (int i = 0; i < 100; ++i) player->advance(0.02);
    const osg::Vec3d moved = player->takeRootMotion();
    EXPECT_NEAR((moved - osg::Vec3d(0.0, -3.0, 0.0)).length(), 0.0, 0.2);
}

TEST(Phase, IsOneForEachLoopedLayer) {
    const Clip walk = sampled(walking::gaitClip(walking::walk())),
               idle = sampled(walking::idleClip());
    const osg::ref_ptr<ClipPlayer> player = new ClipPlayer;
    player->setLayer(0, {walk});
    player->setLayer(1, {idle});
    player->setLayer(2, {idle, 0.3, 1.0, false});
    player->setPhase(0.25);
    EXPECT_NEAR(walk->footContacts().phaseAt(player->getLayer(0).time), 0.25, 1e-12);
    EXPECT_NEAR(player->getLayer(1).time, 0.25 * idle->duration(), 1e-12);
    EXPECT_EQ(player->getLayer(2).time, 0.3);
}

TEST(JointWeights, AreSharesOfALayersWeight) {
    const Clip idle = sampled(walking::idleClip()), wave = sampled(walking::waveClip());
    const osg::ref_ptr<ClipPlayer> player = new ClipPlayer;
    const osg::ref_ptr<osg::MatrixTransform> arm = new osg::MatrixTransform;
    player->addRigid(arm, "RightArm", osg::Matrixd());
    const auto angleWith = [&](const std::vector<double>& weights) {
        player->setLayer(0, {idle, 0.0, 0.0});
        ClipPlayer::Layer layer{wave, 0.0, 0.0, true, 0.8, {"RightArm", "RightHand"}};
        layer.jointWeights = weights;
        player->setLayer(1, layer);
        EXPECT_TRUE(player->pose());
        double angle = 0.0;
        osg::Vec3d axis;
        arm->getMatrix().getRotate().getRotate(angle, axis);
        return angle;
    };
    EXPECT_NEAR(angleWith({}), 0.8 * 2.5, 1e-9);
    EXPECT_NEAR(angleWith({1.0, 0.0}), 0.8 * 2.5, 1e-9);
    EXPECT_NEAR(angleWith({0.25}), 0.2 * 2.5, 1e-9);
    EXPECT_NEAR(angleWith({0.0, 1.0}), 0.0, 1e-9);
    EXPECT_NEAR(angleWith({7.0}), 0.8 * 2.5, 1e-9);
}

TEST(BlendSpace, WeighsNeighbours) {
    const Clip idle = sampled(walking::idleClip());
    const auto line = BlendSpace::create({{idle, {0, 0}}, {idle, {1.5, 0}}, {idle, {3.5, 0}}});
    const struct {
        double speed;
        std::vector<double> weights;
    } cases[] = {{-1.0, {1, 0, 0}},        {0.0, {1, 0, 0}},       {0.75, {0.5, 0.5, 0}},
                 {1.5, {0, 1, 0}},         {2.0, {0, 0.75, 0.25}}, {9.0, {0, 0, 1}},
                 {std::nan(""), {1, 0, 0}}};
    for (const auto& [speed, weights] : cases)
        for (std::size_t i = 0; i < 3; ++i)
            EXPECT_NEAR(line->weights({speed, 0.0})[i], weights[i], 1e-12) << speed;
    const auto cross = BlendSpace::create(
        {{idle, {0, 0}}, {idle, {1, 0}}, {idle, {-1, 0}}, {idle, {0, 1}}, {idle, {0, -1}}});
    const std::vector<double> diagonal = cross->weights({0.5, 0.5});
    EXPECT_NEAR(diagonal[1], diagonal[3], 1e-12);
    EXPECT_NEAR(diagonal[2] + diagonal[4], 0.0, 1e-12);
}

TEST(BlendSpace, PlaysItsClipsInStep) {
    const Clip walk = sampled(walking::gaitClip(walking::walk())),
               run = sampled(walking::gaitClip(walking::run()));
    const auto space = BlendSpace::create({{walk, {1.5, 0}}, {run, {3.2, 0}}});
    const osg::ref_ptr<ClipPlayer> player = new ClipPlayer;
    player->setRoot(ClipPlayer::Root::FromFeet, osg::Vec3d(0, 0, 1));
    for (const double speed : {1.5, 2.0, 2.6, 3.2}) {
        space->play(*player, {speed, 0.0}, 3);
        player->advance(1.0 / 60.0);
        player->takeRootMotion();
        for (int i = 0; i < 120; ++i) {
            space->play(*player, {speed, 0.0}, 3);
            player->advance(1.0 / 60.0);
            EXPECT_NEAR(phaseBetween(*player, 3, 4), 0.0, 1e-9);
        }
        EXPECT_NEAR(player->takeRootMotion().length() / 2.0, speed, 0.12 * speed);
    }
}

TEST(BlendSpace, RefusesUnusableEntries) {
    const Clip idle = sampled(walking::idleClip());
    EXPECT_THROW(BlendSpace::create({}), osgSkin::Error);
    EXPECT_THROW(BlendSpace::create({{nullptr, {0, 0}}}), osgSkin::Error);
    EXPECT_THROW(BlendSpace::create({{idle, {1, 0}}, {idle, {1, 0}}}), osgSkin::Error);
    EXPECT_THROW(BlendSpace::create({{idle, {std::nan(""), 0}}}), osgSkin::Error);
}
