// SPDX-License-Identifier: MIT
// Poses that come while a figure is shown: at any rate, late, or not at all.
#include "GltfBuilder.h"
#include "UpdateAt.h"

#include <osgSkin/DeformableSkin>
#include <osgSkinCharacter/LoadCharacter>
#include <osgSkinMotion/LivePlayer>

#include <glm/gtc/quaternion.hpp>
#include <glm/trigonometric.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <thread>
#include <vector>

namespace {

using osgSkin::attach;
using osgSkin::Character;
using osgSkin::LivePlayer;
using osgSkin::LiveRetarget;

/// A column of three joints whose middle one is bent about x.
class LivePlayed : public testing::Test {
protected:
    void SetUp() override {
        character = osgSkin::loadCharacter(test::GltfColumn().save("live.gltf"));
        player = attach<LivePlayer>(*character.root, LiveRetarget(character.rest, character.rest));
    }

    /// \param time of the sender
    bool send(double time, double degrees) {
        std::vector<glm::dquat> rotations(character.rest.joints.size(), {1, 0, 0, 0});
        rotations[std::size_t(character.rest.find("middle"))] =
            glm::angleAxis(glm::radians(degrees), glm::dvec3(1, 0, 0));
        return player->receive(time, rotations, character.rest.joints[0].centre);
    }

    /// The bend that is shown at a time of the scene, degrees.
    double bendAt(double time) {
        test::updateAt(*character.root, time);
        const osg::Quat bend = character.bone("middle")->getMatrix().getRotate();
        return glm::degrees(2.0 * std::atan2(bend.x(), bend.w()));
    }

    /// Until a fade from rest has ended: sender and scene are at 0.3 s.
    void begin(double degrees) {
        for (int i = 0; i <= 18; ++i) {
            EXPECT_TRUE(send(i / 60.0, degrees));
            bendAt(i / 60.0);
        }
        EXPECT_NEAR(bendAt(0.3), degrees, 1e-4);
    }

    Character character;
    osg::ref_ptr<LivePlayer> player;
};

} // namespace

TEST_F(LivePlayed, ShowsEachPoseAtTheNextUpdate) {
    begin(10.0);
    for (int i = 1; i <= 20; ++i) {
        EXPECT_TRUE(send(0.3 + i / 60.0, 10.0 + 4.0 * i));
        EXPECT_NEAR(bendAt(0.3 + i / 60.0), 10.0 + 4.0 * i, 1e-4);
        EXPECT_EQ(player->getSilence(), 0.0);
    }
}

TEST_F(LivePlayed, RestsBeforeTheFirstPose) {
    EXPECT_NEAR(bendAt(0.0), 0.0, 1e-6);
    EXPECT_NEAR(bendAt(5.0), 0.0, 1e-6);
    EXPECT_TRUE(std::isinf(player->getSilence()));
}

TEST_F(LivePlayed, HoldsThePoseWhereNoneComes) {
    begin(30.0);
    for (int i = 1; i <= 120; ++i) EXPECT_NEAR(bendAt(0.3 + i / 60.0), 30.0, 1e-4);
    EXPECT_NEAR(player->getSilence(), 2.0, 1e-9);
}

TEST_F(LivePlayed, FadesAfterAPause) {
    begin(0.0);
    double before = bendAt(2.0);
    for (int i = 0; i < 30; ++i) { // the actor has moved on meanwhile
        EXPECT_TRUE(send(2.0 + i / 60.0, 80.0));
        const double now = bendAt(2.0 + (i + 1) / 60.0);
        EXPECT_LE(now - before, 80.0 / 0.2 / 60.0 + 1e-4);
        EXPECT_GE(now, before - 1e-4);
        before = now;
    }
    EXPECT_NEAR(before, 80.0, 1e-4);
}

TEST_F(LivePlayed, DoesNotFadeOverLostPoses) {
    begin(10.0);
    bendAt(0.3 + 1 / 30.0); // two lost at 30 Hz
    bendAt(0.3 + 2 / 30.0);
    EXPECT_TRUE(send(0.4, 25.0));
    EXPECT_NEAR(bendAt(0.399), 25.0, 1e-4);
}

TEST_F(LivePlayed, DropsPosesThatComeTooLate) {
    begin(10.0);
    EXPECT_TRUE(send(1.0, 20.0));
    EXPECT_FALSE(send(0.9, 70.0));
    EXPECT_FALSE(send(1.0, 70.0));
    EXPECT_NEAR(bendAt(0.35), 20.0, 1e-4);
}

TEST_F(LivePlayed, FollowsASenderThatStartsAgain) {
    EXPECT_TRUE(send(100.0, 10.0));
    bendAt(0.0);
    EXPECT_NEAR(bendAt(0.5), 10.0, 1e-4);
    EXPECT_TRUE(send(0.0, 60.0));
    EXPECT_LT(bendAt(0.5 + 1 / 60.0), 20.0); // it fades
    EXPECT_TRUE(send(0.1, 60.0));
    EXPECT_NEAR(bendAt(0.9), 60.0, 1e-4);
}

TEST_F(LivePlayed, RefusesUnusablePoses) {
    begin(10.0);
    std::vector<glm::dquat> rotations(character.rest.joints.size(), {1, 0, 0, 0});
    const glm::dvec3 root = character.rest.joints[0].centre;
    EXPECT_FALSE(player->receive(std::nan(""), rotations, root));
    EXPECT_FALSE(player->receive(1.0, {}, root));
    rotations[0].x = std::numeric_limits<double>::infinity();
    EXPECT_FALSE(player->receive(1.0, rotations, root));
    EXPECT_NEAR(bendAt(0.4), 10.0, 1e-4);
    EXPECT_TRUE(send(0.5, 12.0)); // the time of those does not count
    EXPECT_FALSE((new LivePlayer)->receive(0.0, rotations, root));
}

TEST_F(LivePlayed, HasLayersOnTop) {
    begin(30.0);
    osgSkin::Clip nod;
    nod.name = "nod";
    nod.frameTime = 1.0;
    nod.frames = 1;
    nod.joints = character.rest.joints.size();
    nod.rotations.assign(nod.joints, {1, 0, 0, 0});
    nod.rotations[std::size_t(character.rest.find("middle"))] =
        glm::angleAxis(glm::radians(20.0), glm::dvec3(1, 0, 0));
    nod.rootPositions = {character.rest.joints[0].centre};
    osgSkin::ClipPlayer::Layer layer{osgSkin::SampledClip::create(nod, character.rest)};
    layer.weight = 0.5;
    player->setLayer(3, layer);
    EXPECT_NEAR(bendAt(0.4), 25.0, 1e-4);
}

TEST_F(LivePlayed, BendsTheSkin) {
    begin(0.0);
    const auto& skin = *character.skin.skins.at(0).drawable;
    const osg::BoundingBox before = skin.getBoundingBox();
    send(0.5, 60.0);
    bendAt(0.35);
    EXPECT_GT(skin.getBoundingBox().zMax(), before.zMax() + 0.1f);
}

TEST_F(LivePlayed, ReceivesFromAnotherThread) {
    begin(0.0);
    std::thread sender([&] {
        for (int i = 1; i <= 1000; ++i) send(1.0 + 0.01 * i, 0.05 * i);
    });
    double last = 0.0;
    for (int i = 0; i < 200; ++i) {
        const double now = bendAt(0.4 + 0.01 * i);
        EXPECT_GE(now, last - 1e-3);
        last = now;
    }
    sender.join();
    EXPECT_NEAR(bendAt(3.0), 50.0, 1e-3);
}
