// SPDX-License-Identifier: MIT
// Joints by role, motions by name, and saved characters, which loadCharacter() takes like any
// other.
#include "Command.h"
#include "ExpectContains.h"
#include "FindNodes.h"
#include "Notices.h"
#include "UpdateAt.h"

#include <osgSkin/Error>
#include <osgSkinCharacter/LoadCharacter>

#include <gtest/gtest.h>
#include <osgDB/WriteFile>

#include <filesystem>
#include <functional>
#include <string>

namespace {

using osgSkin::Character;
using osgSkin::loadCharacter;

const std::string kThrower = OSGSKIN_DATA "/thrower.skin";

std::string save(const Character& character, const std::string& extension) {
    std::string file = test::makeTestFolder() + "/saved." + extension;
    EXPECT_TRUE(osgDB::writeNodeFile(*character.root, file));
    return file;
}

std::string errorOf(const std::function<void()>& call) {
    try {
        call();
    } catch (const osgSkin::Error& error) {
        return error.what();
    }
    return "no error";
}

std::string nameOf(Character& character, const std::string& role) {
    return character.boneByRole(role)->getName();
}

} // namespace

TEST(SavedCharacter, HasSkeletonRolesAndMotions) {
    Character thrower = loadCharacter(kThrower);
    for (const char* extension : {"osgb", "osgt"}) {
        const test::Notices notices;
        Character saved = loadCharacter(save(thrower, extension));
        EXPECT_EQ(notices.warnings(), "");
        EXPECT_FALSE(saved.hasBody());
        EXPECT_EQ(saved.skin.skins.size(), thrower.skin.skins.size());
        EXPECT_EQ(saved.roles.roles, thrower.roles.roles);
        EXPECT_EQ(nameOf(saved, "LeftUpperArm"), nameOf(thrower, "LeftUpperArm"));
        for (const char* role : {"Head", "RightHand", "LeftFoot"})
            EXPECT_LT((saved.restPosition(role) - thrower.restPosition(role)).length(), 1e-5)
                << role;
        ASSERT_EQ(saved.motions.size(), thrower.motions.size());
        EXPECT_EQ(saved.motions[0].name(), thrower.motions[0].name());
    }
}

TEST(SavedCharacter, MovesAsBefore) {
    Character thrower = loadCharacter(kThrower);
    Character saved = loadCharacter(save(thrower, "osgb"));
    for (const double time : {0.0, 0.4, 1.2})
        for (Character* each : {&thrower, &saved}) test::updateAt(*each->root, time);
    const auto handOf = [](Character& character) {
        return character.boneByRole("RightHand")->getMatrixInSkeletonSpace().getTrans();
    };
    EXPECT_LT((handOf(thrower) - handOf(saved)).length(), 1e-4);
}

TEST(SavedCharacter, SaysThatOptionsOfBindingHaveNoEffect) {
    const std::string file = save(loadCharacter(kThrower), "osgb");
    osgSkin::LoadOptions options;
    options.shapes = osgSkin::BindOptions::Shapes::None;
    const Character saved = loadCharacter(file, options);
    ASSERT_EQ(saved.notes.size(), 1u);
    test::expectContains(saved.notes[0], "bound already");
    EXPECT_TRUE(loadCharacter(file).notes.empty());
}

TEST(SavedCharacter, WithSeveralSkeletonsHasSkinsAlone) {
    const Character one = loadCharacter(kThrower), other = loadCharacter(kThrower);
    const osg::ref_ptr<osg::Group> both = new osg::Group;
    both->addChild(one.root);
    both->addChild(other.root);
    const std::string file = test::makeTestFolder() + "/both.osgb";
    ASSERT_TRUE(osgDB::writeNodeFile(*both, file));
    Character loaded = loadCharacter(file);
    EXPECT_EQ(loaded.skin.skins.size(), 2 * one.skin.skins.size());
    EXPECT_EQ(loaded.skeleton, nullptr);
    test::expectContains(errorOf([&] { loaded.boneByRole("Head"); }), "none of its joints");
}

TEST(JointsByRole, AreFoundWhateverTheirNames) {
    struct Case {
        std::string file;
        const char *upperArm, *hand;
    };
    const std::string characters = OSGSKIN_SHARED_DATA "/characters/";
    for (const Case& each : {Case{kThrower, "LeftArm", "RightHand"},
                             Case{characters + "robot.glb", "UpperArm.L", "Palm2.R"},
                             Case{characters + "Knight.glb", "upperarm.l", "wrist.r"}}) {
        if (!std::filesystem::exists(each.file)) continue;
        SCOPED_TRACE(each.file);
        Character character = loadCharacter(each.file);
        EXPECT_EQ(nameOf(character, "LeftUpperArm"), each.upperArm);
        EXPECT_EQ(nameOf(character, "RightHand"), each.hand);
        EXPECT_GT(character.restPosition("LeftHand").x(), character.restPosition("RightHand").x());
        EXPECT_GT(character.restPosition("Head").z(), character.restPosition("LeftFoot").z());
    }
}

TEST(JointsByRole, RejectsUnknownRole) {
    Character thrower = loadCharacter(kThrower);
    test::expectContains(errorOf([&] { thrower.bone("LeftArn"); }), "did you mean \"LeftArm\"");
    const std::string why = errorOf([&] { thrower.jointByRole("LeftUperArm"); });
    test::expectContains(why, kThrower + ": no joint is known to be the \"LeftUperArm\"");
    test::expectContains(why, "did you mean \"LeftUpperArm\"?");
}

TEST(MotionsByName, PlayAloneAndFromTheirStart) {
    Character character = loadCharacter(OSGSKIN_TEST_DATA "/character/good.skin");
    test::updateAt(*character.root, 0.0);
    character.play("later");
    EXPECT_TRUE(character.manager->isPlaying("later"));
    EXPECT_FALSE(character.manager->isPlaying("move"));
    test::expectContains(errorOf([&] { character.play("latr"); }), "did you mean \"later\"?");
}
