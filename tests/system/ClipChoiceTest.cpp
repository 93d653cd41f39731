// SPDX-License-Identifier: MIT
// Choosing one motion of a file with several, in a .skin file and in options.
#include "ExpectContains.h"
#include "GltfBuilder.h"
#include "SkinFiles.h"
#include "WhyRefused.h"

#include <osgSkinCharacter/LoadCharacter>

#include <glm/gtc/quaternion.hpp>
#include <gtest/gtest.h>

#include <cmath>

namespace {

using osgSkin::Character;
using test::GltfColumn;

/// A column with clips "Armature|still_Armature", "Armature|bow" and "twist", which rotate by 0, 30
/// and 60 degrees.
std::string movesFile() {
    GltfColumn column;
    double angle = 0.0;
    for (const char* name : {"Armature|still_Armature", "Armature|bow", "twist"}) {
        column.animate(name, column.joints[1], "rotation", {0.0, 1.0},
                       GltfColumn::turns({angle, angle}));
        angle += 30.0;
    }
    return column.save("moves.gltf");
}

/// A .skin file over the column itself.
std::string skinFile(const std::string& motions) {
    return test::saveSkin(testing::TempDir() + "choice.skin",
                          R"(, "rigid": [], "motions": [)" + motions + "]", "moves.gltf", "");
}

double angleOf(const osgSkin::CharacterMotion& motion, const Character& character) {
    const int joint = character.rest.find("middle");
    const glm::dquat& q = motion.clip.rotations.at(std::size_t(joint));
    return 2.0 * std::atan2(std::abs(q.x), q.w) * 57.29577951308232;
}

} // namespace

TEST(ClipChoice, BySkinFile) {
    movesFile();
    const Character character =
        osgSkin::loadCharacter(skinFile(R"({"file": "moves.gltf", "clip": "bow"},
                    {"file": "moves.gltf", "clip": 2},
                    {"file": "moves.gltf", "clip": "twist", "name": "turn"},
                    {"file": "moves.gltf"})"));
    ASSERT_EQ(character.motions.size(), 4u);
    const char* const names[] = {"bow", "moves 2", "turn", "moves"};
    const double angles[] = {30, 60, 60, 0};
    for (std::size_t m = 0; m < 4; ++m) {
        EXPECT_EQ(character.motions[m].name(), names[m]);
        EXPECT_NEAR(angleOf(character.motions[m], character), angles[m], 0.01) << names[m];
    }
    const std::string why = test::whyRefused(skinFile(R"({"file": "moves.gltf", "clip": "fly"})"));
    test::expectContains(
        why, R"(no clip "fly", expected one of 0 "Armature|still_Armature", 1 "Armature|bow", 2)");
    test::expectContains(test::whyRefused(skinFile(R"({"file": "moves.gltf", "clip": true})")),
                         "motions[0].clip");
}

/// A clip that moves only the face keeps its number, and is not the first one.
TEST(ClipChoice, NumbersCountAllClipsOfTheFile) {
    GltfColumn column;
    for (const char* name : {"blink", "walk", "run"})
        column.animate(name, column.joints[1], "rotation", {0.0, 1.0},
                       GltfColumn::turns({name[0] == 'r' ? 60.0 : 30.0, 60.0}));
    column.json["animations"][0]["channels"][0]["target"]["path"] = "weights";
    column.save("blinks.gltf");
    const auto skin = [](const std::string& clip) {
        return test::saveSkin(testing::TempDir() + "blinks.skin",
                              R"(, "rigid": [], "motions": [{"file": "blinks.gltf")" + clip + "}]",
                              "blinks.gltf", "");
    };
    for (const auto& [clip, angle] :
         {std::pair("", 30), std::pair(R"(, "clip": 1)", 30), std::pair(R"(, "clip": 2)", 60)}) {
        const Character character = osgSkin::loadCharacter(skin(clip));
        ASSERT_EQ(character.motions.size(), 1u);
        EXPECT_NEAR(angleOf(character.motions[0], character), angle, 0.01) << clip;
    }
    test::expectContains(test::whyRefused(skin(R"(, "clip": 0)")), "clip \"blink\" moves no joint");
}

TEST(ClipChoice, ByOption) {
    const std::string moves = movesFile();
    const std::string skin = skinFile("");
    for (const auto& [wanted, angle] : {std::pair<std::string, double>{"bow", 30},
                                        {"Armature|bow", 30},
                                        {"still", 0},
                                        {"2", 60},
                                        {"twist", 60}}) {
        osgSkin::LoadOptions options;
        options.motion = moves + "#" + wanted;
        const Character character = osgSkin::loadCharacter(skin, options);
        ASSERT_EQ(character.motions.size(), 1u);
        EXPECT_EQ(character.motions[0].name(), wanted);
        EXPECT_NEAR(angleOf(character.motions[0], character), angle, 0.01) << wanted;
    }
    const std::string why = test::whyRefused(skin, "motion=" + moves + "#fly");
    test::expectContains(why, R"(no clip "fly")");
    test::expectContains(test::whyRefused(skin, "motion=nowhere.gltf#bow"), "neither");
    // For a rigged model's own clips, the part after the bar is enough.
    osgSkin::LoadOptions own;
    own.motion = "bow";
    EXPECT_EQ(osgSkin::loadCharacter(moves, own).motions.front().name(), "Armature|bow");
    // Blender repeats the object's name behind it.
    own.motion = "still";
    EXPECT_EQ(osgSkin::loadCharacter(moves, own).motions.front().name(), "Armature|still_Armature");
}
