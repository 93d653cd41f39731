// SPDX-License-Identifier: MIT
// Characters whose parts are copied, and skins whose bones come and go.
#include "Notices.h"
#include "PlayedFigure.h"

#include <osgSkin/Error>
#include <osgSkinRig/ClipCharacter>

#include <osg/Switch>
#include <osg/observer_ptr>

#include <random>

using namespace played;
using osgSkin::ClipPlayer;
using osgSkin::SampledClip;

TEST(ClipPlayer, RigidPartsMayStandInGroupsBelowTheirBones) {
    Character character(someClip(12, 0.8));
    osg::Group& bone = *character.rigid->getParent(0);
    const osg::ref_ptr<osg::Group> group = new osg::Group;
    group->addChild(character.rigid);
    bone.replaceChild(character.rigid, group);
    const auto copies = osgSkin::ClipCharacter::create(*character.scene);
    const auto copy = copies->makeInstance();
    copy.player->setLayer(0, {copies->sample(*copies->animations().front(), 30.0), 4.0 * kFrame});
    ASSERT_TRUE(copy.player->pose());
    character.update(1.0 + 4.0 * kFrame); // the manager starts at its first update
    character.update(4.0 * kFrame);
    osg::NodePath path = character.rigid->getParentalNodePaths(character.scene).front();
    const osg::Matrix expected = osg::computeLocalToWorld(path);
    const auto& rigid = dynamic_cast<osg::MatrixTransform&>(*copy.node->getChild(1));
    for (int i = 0; i < 16; ++i)
        EXPECT_NEAR(rigid.getMatrix().ptr()[i], expected.ptr()[i], 1e-6) << i;
    // One that moves it away from its bone is not followed.
    const osg::ref_ptr<osg::MatrixTransform> aside =
        new osg::MatrixTransform(osg::Matrixd::translate(1, 0, 0));
    aside->addChild(character.rigid);
    bone.replaceChild(group, aside);
    EXPECT_THROW(osgSkin::ClipCharacter::create(*character.scene), osgSkin::Error);
}

TEST(ClipPlayer, BakedBoundsHoldTheSkinBetweenSamples) {
    Character character(someClip(12, 0.0));
    const auto copies = osgSkin::ClipCharacter::create(*character.scene);
    std::mt19937_64 random(17);
    std::uniform_real_distribution<double> at(-1.0, 3.0);
    for (const double speed : {0.3, 0.8, 2.6, 3.5}) { // the last ones turn joints half around
        const auto clip = SampledClip::create(someClip(12, speed), character.rig);
        copies->bake(clip);
        const auto copy = copies->makeInstance();
        osgSkin::DeformableSkin& skin = skinOf(*copy.node);
        double mean = 0.0;
        constexpr int kTimes = 400;
        for (int i = 0; i < kTimes; ++i) {
            copy.player->setLayer(0, {clip, at(random) * clip->duration(), 1.0, i % 2 == 0});
            osg::BoundingBox tight;
            for (const osg::Vec3& p : posedBy(*copy.player, skin)) {
                ASSERT_TRUE(skin.getBoundingBox().contains(p)) << speed;
                tight.expandBy(p);
            }
            const osg::Vec3d is = skin.getBoundingBox()._max - skin.getBoundingBox()._min;
            const osg::Vec3d least = tight._max - tight._min;
            mean += is.x() * is.y() * is.z() / (least.x() * least.y() * least.z()) / kTimes;
        }
        if (speed < 1.0) {
            EXPECT_LE(mean, 1.2) << speed;
        }
    }
}

TEST(ClipCharacter, InstancesBeginAtRest) {
    Character character(someClip(12, 0.8));
    const Vertices rest = verticesOf(character.skin->getRestGeometry());
    character.update(0.1);
    character.update(0.3);
    ASSERT_GT(difference(verticesOf(*character.skin), rest), 0.1);
    const auto copy = osgSkin::ClipCharacter::create(*character.scene)->makeInstance();
    EXPECT_EQ(difference(verticesOf(skinOf(*copy.node)), rest), 0.0);
}

TEST(ClipCharacter, InstancesLookAsTheCharacterDoes) {
    Character character(someClip(12, 0.8));
    osg::Group& upright = *character.scene->getChild(0)->asGroup();
    upright.getOrCreateStateSet()->setMode(GL_BLEND, osg::StateAttribute::ON);
    character.rigid->getOrCreateStateSet()->setMode(GL_FOG, osg::StateAttribute::ON);
    const osg::ref_ptr<osg::Switch> choice = new osg::Switch;
    character.skeleton->addChild(choice);
    for (const bool on : {true, false}) {
        character.skin->getParent(0)->removeChild(character.skin);
        choice->addChild(character.skin, on);
        upright.setNodeMask(on ? 0x30u : 0x10u);
        const auto copy = osgSkin::ClipCharacter::create(*character.scene)->makeInstance();
        const osg::Node &skin = *copy.node->getChild(0), &rigid = *copy.node->getChild(1);
        for (const osg::Node* part : {&skin, &rigid}) {
            ASSERT_NE(part->getStateSet(), nullptr);
            EXPECT_EQ(part->getStateSet()->getMode(GL_BLEND), osg::StateAttribute::ON);
        }
        EXPECT_EQ(rigid.getStateSet()->getMode(GL_FOG), osg::StateAttribute::ON);
        EXPECT_EQ(skin.getNodeMask(), on ? 0x30u : 0u);
        EXPECT_EQ(rigid.getNodeMask(), on ? 0x30u : 0x10u);
    }
}

/// Neither keeps the other, where nothing else does.
TEST(SkinBones, ASkinMayStandBelowABone) {
    osg::observer_ptr<osgSkin::DeformableSkin> skin;
    {
        Character character(someClip(12, 0.8));
        character.skeleton->removeChild(character.skin);
        Character::findBone(*character.skeleton, "middle")->addChild(character.skin);
        character.update(0.1);
        skin = character.skin;
    }
    EXPECT_FALSE(skin.valid());
}

TEST(SkinBones, AreLookedForAgainWhereOneIsMovedOut) {
    Character character(someClip(12, 0.8));
    const osg::ref_ptr<osgAnimation::Bone> old = Character::findBone(*character.skeleton, "middle");
    const osg::ref_ptr<osg::Group> parent = old->getParent(0), elsewhere = new osg::Group;
    const osg::ref_ptr<osgAnimation::Bone> bone = new osgAnimation::Bone("middle");
    bone->setInvBindMatrixInSkeletonSpace(old->getInvBindMatrixInSkeletonSpace());
    bone->setMatrixInSkeletonSpace(osg::Matrixd::translate(0, 50, 0));
    character.update(0.1);
    parent->addChild(bone);
    parent->removeChild(old);
    elsewhere->addChild(old);
    character.update(0.2);
    double highest = 0.0;
    for (const osg::Vec3& p : verticesOf(*character.skin))
        highest = std::max(highest, double(p.y()));
    EXPECT_GT(highest, 40.0);
}

TEST(SkinBones, AreMissedOnce) {
    Character character(someClip(12, 0.8)), other(someClip(12, 0.8));
    for (Character* each : {&character, &other}) {
        const osg::ref_ptr<osgAnimation::Bone> end = Character::findBone(*each->skeleton, "end");
        end->getParent(0)->removeChild(end);
    }
    const osg::ref_ptr<osgSkin::UpdateDeformableSkin> shared = new osgSkin::UpdateDeformableSkin;
    const test::Notices notices;
    for (int frame = 0; frame < 10; ++frame)
        for (Character* each : {&character, &other})
            EXPECT_TRUE(shared->pose(*each->skin, *each->skeleton));
    EXPECT_EQ(notices.lines(), 1u) << notices.text();
}

TEST(ClipPlayer, BlendsBetweenBakedClipsAreBoundedToo) {
    Character character(someClip(12, 0.0));
    const auto copies = osgSkin::ClipCharacter::create(*character.scene);
    const auto slow = SampledClip::create(someClip(12, 0.3), character.rig);
    const auto fast = SampledClip::create(someClip(9, 1.2), character.rig);
    copies->bake(slow);
    copies->bake(fast);
    const auto copy = copies->makeInstance();
    osgSkin::DeformableSkin& skin = skinOf(*copy.node);
    const auto expectHeld = [&] {
        for (const osg::Vec3& p : posedBy(*copy.player, skin))
            ASSERT_TRUE(skin.getBoundingBox().contains(p, 1e-5f));
    };
    for (int i = 0; i < 60; ++i) {
        copy.player->setLayer(0, {slow, 0.013 * i});
        copy.player->setLayer(1, {fast, 0.017 * i});
        for (const double weight : {0.0, 0.4, 1.0}) {
            copy.player->setWeight(weight);
            expectHeld();
        }
        copy.player->setRoot(ClipPlayer::Root::InPlace);
        expectHeld();
        copy.player->setRoot(ClipPlayer::Root::Moving);
    }
}
