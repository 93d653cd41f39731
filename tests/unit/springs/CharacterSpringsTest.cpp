// SPDX-License-Identifier: MIT
#include "GltfBuilder.h"
#include "Notices.h"
#include "UpdateAt.h"

#include <osgSkin/DeformableSkin>
#include <osgSkin/Error>
#include <osgSkinCharacter/CharacterOption>
#include <osgSkinCharacter/LoadCharacter>
#include <osgSkinMotion/ClipCharacter>
#include <osgSkinMotion/SpringBones>

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <string>

namespace {

using nlohmann::json;
using osgSkin::Character;
using osgSkin::find;
using osgSkin::LoadOptions;
using osgSkin::SpringBones;

/// A column whose upper two boxes swing, in a clip that does not move them.
test::GltfColumn makeHair() {
    test::GltfColumn column;
    column.animate("nod", column.joints[0], "rotation", {0, 1}, test::GltfColumn::turns({0, 30}));
    column.json["extensions"]["VRMC_springBone"]["springs"] = {
        {{"joints", {{{"node", 1}, {"gravityPower", 0.2}}, {{"node", 2}}}}}};
    return column;
}

/// How far the middle bone leans to the side; updates the scene at 60 frames a second.
double leanAfterMove(Character& character, int frames = 20) {
    const osg::ref_ptr<osg::MatrixTransform> place = new osg::MatrixTransform;
    place->addChild(character.root);
    for (int i = 0; i < frames; ++i) {
        place->setMatrix(osg::Matrixd::translate(0.1 * i, 0, 0));
        test::updateAt(*place, i / 60.0);
    }
    const auto at = [&](const char* name) {
        return character.bone(name)->getMatrixInSkeletonSpace().getTrans();
    };
    return (at("top") - at("middle")).x();
}

TEST(CharacterSprings, SwingInALoadedVrm) {
    Character character = osgSkin::loadCharacter(makeHair().save("character.vrm"));
    ASSERT_TRUE(find<SpringBones>(*character.skeleton));
    EXPECT_LT(leanAfterMove(character), -0.05);
}

TEST(CharacterSprings, BendTheSkin) {
    LoadOptions off;
    off.springs = false;
    const std::string file = makeHair().save("skinned.vrm");
    Character swings = osgSkin::loadCharacter(file), still = osgSkin::loadCharacter(file, off);
    leanAfterMove(swings);
    leanAfterMove(still);
    const auto top = [](const Character& character) {
        return character.skin.skins.at(0).drawable->getBoundingBox().xMin();
    };
    EXPECT_LT(top(swings), top(still) - 0.05f);
}

TEST(CharacterSprings, AreOffByOption) {
    LoadOptions options;
    EXPECT_TRUE(setOption(options, "springs", "none"));
    Character character = osgSkin::loadCharacter(makeHair().save("stiff.vrm"), options);
    EXPECT_FALSE(find<SpringBones>(*character.skeleton));
    EXPECT_NEAR(leanAfterMove(character), 0.0, 1e-6);
    EXPECT_THROW(setOption(options, "springs", "loose"), osgSkin::Error);
}

TEST(CharacterSprings, SwingWithABonePlayer) {
    Character character = osgSkin::loadCharacter(makeHair().save("played.vrm"));
    const test::Notices notices;
    const auto clips = osgSkin::ClipCharacter::create(*character.root);
    EXPECT_FALSE(notices.say("springs")) << notices.text();
    clips->makeInstance();
    EXPECT_TRUE(notices.say("springs do not swing in copies without bones")) << notices.text();
    const auto player = osgSkin::attach<osgSkin::ClipPlayer>(*character.root);
    player->play({player->clip("nod")}, 0.0);
    EXPECT_LT(leanAfterMove(character), -0.05);
}

TEST(CharacterSprings, LeaveExactPosesAlone) {
    LoadOptions off;
    off.springs = false;
    const std::string file = makeHair().save("posed.vrm");
    Character swings = osgSkin::loadCharacter(file), still = osgSkin::loadCharacter(file, off);
    leanAfterMove(swings);
    for (Character* character : {&swings, &still}) character->poseAt(character->motions[0], 0.5);
    const osg::Matrixd found = swings.bone("top")->getMatrixInSkeletonSpace();
    const osg::Matrixd expected = still.bone("top")->getMatrixInSkeletonSpace();
    for (int i = 0; i < 16; ++i) EXPECT_NEAR(found.ptr()[i], expected.ptr()[i], 1e-9);
    EXPECT_LT(leanAfterMove(swings), -0.05); // and go on
}

/// A `.skin` file with a member "springs" beside a mesh that may have springs of its own.
std::string skinFile(const json& springs, const std::string& mesh) {
    const std::string file = testing::TempDir() + "springs.skin";
    std::ofstream(file) << json{
        {"osgskin", 1}, {"mesh", mesh}, {"bind", "weights"}, {"springs", springs}};
    return file;
}

TEST(CharacterSprings, AreReadFromASkinFile) {
    test::GltfColumn column;
    const std::string mesh = column.save("column.gltf");
    const json spring = {
        {"joints", {"middle"}},
        {"stiffness", 0.5},
        {"gravity", 0.3},
        {"drag", 0.2},
        {"radius", 0.1},
        {"centre", "base"},
        {"colliders",
         {{{"joint", "middle"}, {"from", {1, 0, 0}}, {"radius", 0.3}},
          {{"joint", "base"}, {"from", {0, 0, 0}}, {"to", {0, 0.5, 0}}, {"radius", 0.2}}}}};
    const test::Notices notices;
    Character character = osgSkin::loadCharacter(skinFile(json::array({spring}), mesh));
    EXPECT_FALSE(notices.say("unknown")) << notices.text();
    const SpringBones* const found = find<SpringBones>(*character.skeleton);
    ASSERT_TRUE(found);
    const osgSkin::SpringSettings& settings = found->getSettings();
    ASSERT_EQ(settings.chains.size(), 1u);
    EXPECT_EQ(settings.chains[0].centre, "base");
    ASSERT_EQ(settings.chains[0].joints.size(), 2u);
    const auto& joint = settings.chains[0].joints[1];
    EXPECT_EQ(joint.name, "top");
    EXPECT_EQ(joint.tip, glm::dvec3(0, 3, 0));
    EXPECT_EQ(joint.gravity, glm::dvec3(0, -0.3, 0));
    EXPECT_EQ(joint.stiffness + joint.drag + joint.radius, 0.5 + 0.2 + 0.1);
    ASSERT_EQ(settings.colliders.size(), 2u);
    EXPECT_EQ(settings.colliders[0].start, glm::dvec3(1, 1, 0));
    EXPECT_EQ(settings.colliders[0].end, glm::dvec3(1, 1, 0));
    EXPECT_EQ(settings.colliders[1].end, glm::dvec3(0, 0.5, 0));
}

TEST(CharacterSprings, OfASkinFilesMeshCanBeSwitchedOff) {
    const std::string mesh = makeHair().save("named.vrm");
    EXPECT_TRUE(find<SpringBones>(*osgSkin::loadCharacter(skinFile("file", mesh)).skeleton));
    EXPECT_FALSE(find<SpringBones>(*osgSkin::loadCharacter(skinFile("none", mesh)).skeleton));
}

TEST(CharacterSprings, WithErrorsInASkinFileAreRefused) {
    test::GltfColumn column;
    const std::string mesh = column.save("column.gltf");
    const json good = {{"joints", {"middle"}}};
    const auto with = [&](const char* member, const json& value) {
        json spring = good;
        spring[member] = value;
        return json::array({spring});
    };
    const std::vector<std::pair<json, std::string>> cases{
        {json::array({{{"stiffness", 1}}}), "springs[0]: "},
        {with("joints", {"midle"}), "no joint is called \"midle\", expected one of \"base\""},
        {with("centre", "hips"), "springs: no joint is called \"hips\""},
        {with("drag", 1.5), "springs[0].drag: expected 0 to 1"},
        {with("stiffness", -1), "springs[0].stiffness: expected 0 to 1000"},
        {with("gravity", "down"), "springs[0].gravity: expected a number"},
        {with("colliders", {{{"radius", 1}}}), "springs[0].colliders[0]: "},
        {with("colliders", {{{"joint", "top"}}}), "springs[0].colliders[0]: "},
        {with("colliders", {{{"joint", "no"}, {"radius", 1}}}), "no joint is called \"no\""},
        {"loose", "springs: expected \"file\" or \"none\", found \"loose\""},
    };
    for (const auto& [springs, expected] : cases) {
        const std::string file = skinFile(springs, mesh);
        try {
            osgSkin::loadCharacter(file);
            ADD_FAILURE() << springs;
        } catch (const osgSkin::Error& error) {
            EXPECT_EQ(std::string(error.what()).rfind(file, 0), 0u) << error.what();
            EXPECT_NE(std::string(error.what()).find(expected), std::string::npos) << error.what();
        }
    }
}

} // namespace
