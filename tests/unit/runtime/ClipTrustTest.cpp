// SPDX-License-Identifier: MIT
// What a player of clips is given may change, or be none.
#include <osgSkin/Error>
#include <osgSkinRig/ClipCharacter>
#include <osgSkinRig/ClipPlayer>
#include <osgSkinRig/MakeAnimation>
#include <osgSkinRig/MakeSkeleton>

#include "TubeSkin.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <osg/MatrixTransform>

#include <cmath>
#include <utility>

using osgSkin::ClipPlayer;
using osgSkin::DeformableSkin;
using osgSkin::SampledClip;

namespace {

/// The tube's joints; with `swapped` names of the last two.
osgSkin::RestSkeleton namedRig(bool swapped) {
    osgSkin::RestSkeleton rig;
    rig.add("root", -1, glm::dvec3(0, 0, 0));
    rig.add(swapped ? "end" : "middle", 0, glm::dvec3(0, 2, 0));
    rig.add(swapped ? "middle" : "end", 1, glm::dvec3(0, 4, 0));
    return rig;
}

/// Each joint bends by another angle.
osgSkin::Clip bentMotion() {
    osgSkin::Clip clip;
    clip.frameTime = 0.1;
    clip.frames = 2;
    clip.joints = 3;
    for (std::size_t f = 0; f < clip.frames; ++f) {
        for (const double angle : {0.1, 0.4, 0.9})
            clip.rotations.push_back(glm::angleAxis(angle, glm::dvec3(1, 0, 0)));
        clip.rootPositions.emplace_back(0, 0, 0);
    }
    return clip;
}

osg::ref_ptr<const SampledClip> bentClip(bool swapped) {
    return SampledClip::create(bentMotion(), namedRig(swapped));
}

std::vector<osg::Vec3> skinPosedBy(ClipPlayer& player, const DeformableSkin& skin) {
    EXPECT_TRUE(player.pose());
    return static_cast<const osg::Vec3Array&>(*skin.getDeformedGeometry()->getVertexArray())
        .asVector();
}

/// What a player shows that has never played anything else.
std::vector<osg::Vec3> posedAfresh(const osg::ref_ptr<const osgSkin::SkinModel>& model,
                                   const osg::ref_ptr<const SampledClip>& clip) {
    const auto skin = test::makeSkin();
    skin->setSkin(test::makeGeometry(test::Tube()), model);
    const osg::ref_ptr<ClipPlayer> player = new ClipPlayer;
    player->addSkin(skin);
    player->setLayer(0, {clip});
    return skinPosedBy(*player, *skin);
}

osg::ref_ptr<const osgSkin::SkinModel> modelWithOtherNames() {
    test::Tube tube;
    std::swap(tube.binding.joints[1].name, tube.binding.joints[2].name);
    return tube.model();
}

} // namespace

TEST(ClipTrust, JointsAreFoundByNameAndTheRootByItsMoves) {
    const osg::ref_ptr<const SampledClip> still = bentClip(false);
    EXPECT_EQ(still->find("root"), 0);
    EXPECT_EQ(still->find("end"), 2);
    EXPECT_EQ(still->find("nobody"), -1);
    EXPECT_EQ(still->rootJoint(), 0u); // none is translated
    osgSkin::Clip motion = bentMotion();
    motion.rootPositions[1].x = 3.0;
    const osg::ref_ptr<const SampledClip> going = SampledClip::create(motion, namedRig(false));
    EXPECT_EQ(going->rootJoint(), 0u);
    EXPECT_NEAR(glm::distance(going->sample(1)->translation, going->sample(0)->translation), 3.0,
                1e-12);
}

/// Memory is given out again: a new clip may stand where another one stood.
TEST(ClipTrust, AClipIsNotItsAddress) {
    const auto skin = test::makeSkin();
    const osg::ref_ptr<ClipPlayer> player = new ClipPlayer;
    player->addSkin(skin);
    osg::ref_ptr<const SampledClip> clip = bentClip(false);
    player->setLayer(0, {clip});
    const std::vector<osg::Vec3> before = skinPosedBy(*player, *skin);
    const void* const place = clip.get();
    player->setLayer(0, {});
    EXPECT_FALSE(player->pose()); // nothing plays
    clip = nullptr;
    std::vector<osg::ref_ptr<const SampledClip>> others;
    do others.push_back(bentClip(true));
    while (others.back() != place && others.size() < 3000);
    player->setLayer(0, {others.back()});
    EXPECT_EQ(skinPosedBy(*player, *skin), posedAfresh(skin->getModel(), others.back()));
    EXPECT_NE(skinPosedBy(*player, *skin), before);
    RecordProperty("clipsUntilThen", static_cast<int>(others.size()));
}

TEST(ClipTrust, ASkinMayGetItsModelLater) {
    const osg::ref_ptr<DeformableSkin> skin = new DeformableSkin;
    const osg::ref_ptr<ClipPlayer> player = new ClipPlayer;
    player->addSkin(skin);
    player->setLayer(0, {bentClip(false)});
    EXPECT_FALSE(player->pose());
    skin->setSkin(test::makeGeometry(test::Tube()), test::Tube().model());
    EXPECT_EQ(skinPosedBy(*player, *skin), posedAfresh(skin->getModel(), bentClip(false)));
    skin->setSkin(test::makeGeometry(test::Tube()), modelWithOtherNames());
    EXPECT_EQ(skinPosedBy(*player, *skin), posedAfresh(skin->getModel(), bentClip(false)));
}

/// What was baked is of the model that the character had then.
TEST(ClipTrust, ABakedSkinMayGetAnotherModel) {
    const auto skeleton = test::makeBones();
    skeleton->addChild(test::makeSkin());
    const auto character = osgSkin::ClipCharacter::create(*skeleton);
    const auto clip = bentClip(false);
    character->bake(clip);
    const auto copy = character->makeInstance(false);
    auto& skin = dynamic_cast<DeformableSkin&>(*copy.node->getChild(0)->asGroup()->getChild(0));
    copy.player->setLayer(0, {clip});
    EXPECT_EQ(skinPosedBy(*copy.player, skin), posedAfresh(skin.getModel(), clip));
    skin.setSkin(test::makeGeometry(test::Tube()), modelWithOtherNames());
    EXPECT_EQ(skinPosedBy(*copy.player, skin), posedAfresh(skin.getModel(), clip));
}

TEST(ClipTrust, EverySkinOfACharacterIsBaked) {
    const auto skeleton = test::makeBones();
    for (int i = 0; i < 2; ++i) {
        const osg::ref_ptr<osg::MatrixTransform> place =
            new osg::MatrixTransform(osg::Matrix::translate(100.0 * i, 0, 0));
        place->addChild(test::makeSkin());
        skeleton->addChild(place);
    }
    const auto character = osgSkin::ClipCharacter::create(*skeleton);
    const auto clip = bentClip(false);
    character->bake(clip);
    EXPECT_NEAR(character->bakedBounds().xMax(), 101.0f, 1.0f);
    EXPECT_NEAR(character->bakedBounds().xMin(), -1.0f, 1.0f);
    const auto copy = character->makeInstance(false);
    copy.player->setLayer(0, {clip});
    ASSERT_TRUE(copy.player->pose());
    std::size_t skins = 0;
    for (unsigned i = 0; i < copy.node->getNumChildren(); ++i) {
        const auto* skin =
            dynamic_cast<DeformableSkin*>(copy.node->getChild(i)->asGroup()->getChild(0));
        if (!skin) continue;
        ++skins;
        const auto& posed =
            static_cast<const osg::Vec3Array&>(*skin->getDeformedGeometry()->getVertexArray());
        EXPECT_EQ(posed.asVector(), posedAfresh(skin->getModel(), clip)) << i;
        EXPECT_TRUE(skin->getBoundingBox().valid());
    }
    EXPECT_EQ(skins, 2u);
}

TEST(ClipTrust, NothingIsNotAdded) {
    const osg::ref_ptr<ClipPlayer> player = new ClipPlayer;
    player->addSkin(nullptr);
    player->addRigid(nullptr, "root", osg::Matrixd());
    player->setLayer(0, {bentClip(false)});
    EXPECT_TRUE(player->pose());
}

TEST(ClipTrust, ABakeThatFailsLeavesAllAsItWas) {
    const auto skeleton = test::makeBones();
    skeleton->addChild(test::makeSkin());
    const auto character = osgSkin::ClipCharacter::create(*skeleton);
    osgSkin::Clip bad = bentMotion();
    bad.rotations.back().w = std::nan(""); // of the last sample
    EXPECT_THROW(character->bake(SampledClip::create(bad, namedRig(false))), osgSkin::Error);
    EXPECT_FALSE(character->bakedBounds().valid());
    character->bake(bentClip(false));
    EXPECT_TRUE(character->bakedBounds().valid());
}

/// A key that stands at the end of all times must not fill the memory.
TEST(ClipTrust, EndlessClipsAreNotSampled) {
    osgSkin::Clip slow = bentMotion();
    slow.frameTime = 1e12;
    const auto animation = osgSkin::makeAnimation(slow, namedRig(false));
    const auto skeleton = osgSkin::makeSkeleton(namedRig(false));
    EXPECT_THROW(SampledClip::create(*animation, *skeleton), osgSkin::Error);
    slow.frameTime = 0.1;
    const auto good = osgSkin::makeAnimation(slow, namedRig(false));
    EXPECT_THROW(SampledClip::create(*good, *skeleton, 1e300), osgSkin::Error);
    EXPECT_EQ(SampledClip::create(*good, *skeleton, 10.0)->sampleCount(), 2u);
}

/// osgAnimation stretches keys to the duration that an animation was given.
TEST(ClipTrust, SamplesAreTakenAsFastAsTheAnimationPlays) {
    osgSkin::Clip motion = bentMotion();
    motion.rotations[4] = glm::angleAxis(1.4, glm::dvec3(1, 0, 0)); // the middle one turns by 1
    const auto animation = osgSkin::makeAnimation(motion, namedRig(false));
    const auto skeleton = osgSkin::makeSkeleton(namedRig(false));
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

/// Clips that move other bones: none shows in the next one, nor in the scene.
TEST(ClipTrust, SamplingLeavesTheSkeletonAsItIs) {
    const auto skeleton = osgSkin::makeSkeleton(namedRig(false));
    const auto whole = osgSkin::makeAnimation(bentMotion(), namedRig(false));
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

/// A callback of the application's own may come before the one that moves the bone.
TEST(ClipTrust, BonesMayHaveOtherCallbacksFirst) {
    const auto skeleton = osgSkin::makeSkeleton(namedRig(false));
    osg::Node& root = *skeleton->getChild(0);
    const osg::ref_ptr<osg::Callback> update = root.getUpdateCallback();
    const osg::ref_ptr<osg::NodeCallback> own = new osg::NodeCallback;
    own->setNestedCallback(update);
    root.setUpdateCallback(own);
    const auto animation = osgSkin::makeAnimation(bentMotion(), namedRig(false));
    const auto clip = SampledClip::create(*animation, *skeleton, 10.0);
    EXPECT_NEAR(glm::angle(clip->sample(0)[clip->find("root")].rotation), 0.1, 1e-6);
}
