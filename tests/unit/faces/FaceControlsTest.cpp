// SPDX-License-Identifier: MIT
#include "TubeSkin.h"

#include <osgSkin/SetMorph>
#include <osgSkinMotion/FaceControls>

#include <gtest/gtest.h>

#include <limits>
#include <string>
#include <vector>

namespace {

using osgSkin::attach;
using osgSkin::DeformableSkin;
using osgSkin::FaceControls;
using Names = std::vector<std::string>;

constexpr float kNone = std::numeric_limits<float>::quiet_NaN();

osg::ref_ptr<DeformableSkin> makeFaceSkin(const Names& names) {
    osg::ref_ptr<DeformableSkin> skin = test::makeSkin();
    std::vector<osgSkin::MorphTarget> targets;
    for (const std::string& name : names)
        targets.push_back({name, 0.0f, {0}, {{0.1f, 0.0f, 0.0f}}, {}, {}});
    const std::size_t vertices = skin->getModel()->vertexCount();
    skin->setMorphTargets(osgSkin::MorphTargets::create(targets, vertices));
    return skin;
}

osg::ref_ptr<osg::Group> makeFace(const std::vector<Names>& skins) {
    osg::ref_ptr<osg::Group> result = new osg::Group;
    for (const Names& names : skins) result->addChild(makeFaceSkin(names));
    return result;
}

const DeformableSkin& skinOf(const osg::Group& face, unsigned int index) {
    return dynamic_cast<const DeformableSkin&>(*face.getChild(index));
}

using Floats = std::vector<float>;

} // namespace

TEST(FaceControls, MoveAllSkinsByTheirOwnNames) {
    const auto face = makeFace({{"frown", "jawOpen"}, {"teeth.jawOpen"}, {"browDown"}});
    const auto controls = attach<FaceControls>(*face, Names{"jawOpen"});
    EXPECT_TRUE(controls->set("jawOpen", 0.4f));
    EXPECT_EQ(skinOf(*face, 0).getMorphWeights(), (Floats{0.0f, 0.4f}));
    EXPECT_EQ(skinOf(*face, 1).getMorphWeights(), Floats{0.4f});
    EXPECT_EQ(skinOf(*face, 2).getMorphWeights(), Floats{0.0f});
}

TEST(FaceControls, SetAllNamesAtOnce) {
    const auto face = makeFace({{"Blink", "smile", "scar"}});
    osgSkin::setMorph(*face, "scar", 0.7f);
    const Names& names = osgSkin::faceNames(osgSkin::FaceVocabulary::ArKit);
    const auto controls = attach<FaceControls>(*face, names);
    Floats weights(names.size(), 0.0f);
    const auto set = [&](const std::string& name, float weight) {
        weights[std::size_t(std::find(names.begin(), names.end(), name) - names.begin())] = weight;
    };
    set("eyeBlinkLeft", 1.0f);
    set("mouthSmileLeft", 0.5f);
    set("mouthSmileRight", 1.0f);
    EXPECT_TRUE(controls->set(weights));
    const Floats found = skinOf(*face, 0).getMorphWeights();
    EXPECT_NEAR(found[0], 0.5f, 1e-6f);
    EXPECT_NEAR(found[1], 0.75f, 1e-6f);
    EXPECT_EQ(found[2], 0.7f) << "no name moves it";
    EXPECT_TRUE(controls->set(Floats(names.size(), 0.0f)));
    EXPECT_EQ(skinOf(*face, 0).getMorphWeights(), (Floats{0.0f, 0.0f, 0.7f}));
    EXPECT_FALSE(controls->set(Floats(names.size() - 1, 1.0f)));
    EXPECT_EQ(skinOf(*face, 0).getMorphWeights(), (Floats{0.0f, 0.0f, 0.7f}));
}

TEST(FaceControls, LimitSums) {
    const auto face = makeFace({{"aa", "smile"}});
    const auto controls = attach<FaceControls>(*face, Names{"jawOpen", "viseme_aa", "smile"});
    EXPECT_TRUE(controls->set(Floats{0.75f, 0.75f, -3.0f}));
    EXPECT_EQ(skinOf(*face, 0).getMorphWeights(), (Floats{1.0f, 0.0f}));
    EXPECT_TRUE(controls->set(Floats{0.25f, 0.5f, 7.0f}));
    EXPECT_EQ(skinOf(*face, 0).getMorphWeights(), (Floats{0.75f, 1.0f}));
}

TEST(FaceControls, KeepWeightsWhereNoneIsGiven) {
    const auto face = makeFace({{"aa", "smile"}});
    const auto controls = attach<FaceControls>(*face, Names{"aa", "smile"});
    EXPECT_TRUE(controls->set(Floats{0.5f, 0.25f}));
    EXPECT_TRUE(controls->set(Floats{kNone, 0.75f}));
    EXPECT_EQ(skinOf(*face, 0).getMorphWeights(), (Floats{0.5f, 0.75f}));
    EXPECT_FALSE(controls->set("aa", kNone));
    EXPECT_EQ(skinOf(*face, 0).getMorphWeights(), (Floats{0.5f, 0.75f}));
}

TEST(FaceControls, TellOfNamesThatMoveNothing) {
    const auto face = makeFace({{"jawOpen"}});
    const auto controls = attach<FaceControls>(*face, Names{"jawOpen", "tongueOut", "viseme_sil"});
    EXPECT_EQ(controls->matches()[0].kind, osgSkin::FaceMatch::Kind::Own);
    EXPECT_EQ(controls->matches()[1].kind, osgSkin::FaceMatch::Kind::None);
    EXPECT_FALSE(controls->set("tongueOut", 1.0f));
    EXPECT_EQ(controls->matches()[2].kind, osgSkin::FaceMatch::Kind::Rest);
    EXPECT_FALSE(controls->set("viseme_sil", 1.0f));
    EXPECT_FALSE(controls->set("eyeBlinkLeft", 1.0f));
    EXPECT_EQ(skinOf(*face, 0).getMorphWeights(), Floats{0.0f});
}

/// As programs send them by VMC: VRM 0's names, and the model's own.
TEST(FaceControls, MatchNamesWhenTheyFirstCome) {
    const auto face = makeFace({{"happy", "blinkLeft", "aa", "joyful"}});
    const auto controls = attach<FaceControls>(*face);
    const std::size_t given = controls->matches().size();
    EXPECT_TRUE(controls->set("Joy", 0.5f));
    EXPECT_TRUE(controls->set("Blink_L", 0.25f));
    EXPECT_TRUE(controls->set("A", 1.0f));
    EXPECT_TRUE(controls->set("JOYFUL", 0.75f));
    EXPECT_EQ(skinOf(*face, 0).getMorphWeights(), (Floats{0.5f, 0.25f, 1.0f, 0.75f}));
    EXPECT_TRUE(controls->set("joy", 0.125f)) << "the same name as \"Joy\"";
    EXPECT_EQ(skinOf(*face, 0).getMorphWeights(), (Floats{0.125f, 0.25f, 1.0f, 0.75f}));
    EXPECT_FALSE(controls->set("glasses", 1.0f));
    EXPECT_EQ(controls->matches().size(), given + 5);
    EXPECT_TRUE(controls->set(Floats(given, 0.0f)));
    for (int i = 0; i < 1200; ++i)
        EXPECT_FALSE(controls->set("stranger" + std::to_string(i), 1.0f));
    EXPECT_LE(controls->matches().size(), 1024u);
}

TEST(FaceControls, OutliveSkinsAndTheirTargets) {
    const auto face = makeFace({{"smile", "jawOpen"}, {"jawOpen"}});
    const auto controls = attach<FaceControls>(*face, Names{"jawOpen"});
    dynamic_cast<DeformableSkin&>(*face->getChild(0)).setMorphTargets(nullptr);
    EXPECT_TRUE(controls->set("jawOpen", 0.5f));
    EXPECT_EQ(skinOf(*face, 1).getMorphWeights(), Floats{0.5f});
    face->removeChildren(0, 2);
    EXPECT_TRUE(controls->set("jawOpen", 1.0f));
}
