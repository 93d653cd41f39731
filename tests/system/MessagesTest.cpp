// SPDX-License-Identifier: MIT
// Messages about a user's mistakes: a suggestion, the known names, and the file at fault.
#include "Command.h"
#include "ExpectContains.h"
#include "GltfBuilder.h"
#include "Notices.h"
#include "SkinFiles.h"
#include "WhyRefused.h"

#include <osgSkinCharacter/CharacterOption>

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <string>

namespace {

using test::expectContains;

using test::kTubeFolder;

/// Writes a glTF file with the clips "Idle Loop" and "Walk".
std::string clipsFile() {
    test::GltfColumn column;
    for (const char* name : {"Idle Loop", "Walk"})
        column.animate(name, column.joints[1], "rotation", {0.0, 1.0},
                       test::GltfColumn::turns({0.0, 30.0}));
    return column.save("messages_clips.gltf");
}

} // namespace

TEST(Messages, SuggestOptionsInOptionStrings) {
    for (const auto& [text, meant] : {std::pair("shape=fast", "shapes"),
                                      {"Shapes=none", "shapes"},
                                      {"avoid-body=on", "avoidBody"},
                                      {"maxFilesMB=3", "maxFileMB"},
                                      {"montion=run", "motion"}}) {
        const test::Notices notices;
        test::loadOptions(text);
        const std::string word(text, std::string(text).find('='));
        EXPECT_EQ(notices.warnings(),
                  "unknown option \"" + word + "\" ignored; did you mean \"" + meant + "\"?\n");
    }
    const test::Notices notices; // these belong to other readers
    test::loadOptions("noRotation dds_flip noTexturesInIveFile precision=6 Compressor=zlib Ascii");
    EXPECT_EQ(notices.text(), "");
}

TEST(Messages, SuggestFittingWhereNoSkeletonIsNamed) {
    const std::string file = test::makeTestFolder() + "/alone.skin";
    std::ofstream(file) << R"({"osgskin": 1, "mesh": ")" << OSGSKIN_DATA << R"(/thrower.obj"})";
    expectContains(test::whyRefused(file), R"(set "skeleton" to a file, or to { "fit": true })");
}

TEST(Messages, NameAFormatThatNothingReads) {
    const std::string file = test::makeTestFolder() + "/figure.m3dx";
    std::ofstream(file) << "3DMO";
    expectContains(test::whyRefused(file), "figure.m3dx: neither this build of Assimp nor "
                                           "OpenSceneGraph reads .m3dx files; expected glTF");
}

TEST(Messages, SuggestOptionsOnCommandLines) {
    const std::string folder = test::makeTestFolder();
    for (const std::string program : {OSGSKIN_BAKE, OSGSKIN_VIEWER}) {
        const test::CommandResult result =
            test::runCommand(program + " '" + kTubeFolder + "good.skin' --shape fast", folder);
        EXPECT_EQ(result.status, 2);
        expectContains(result.err, "; did you mean \"--shapes\"?");
    }
}

TEST(Messages, SuggestMembersOfSkinFiles) {
    const std::string folder = test::makeTestFolder();
    const test::Notices notices;
    EXPECT_EQ(test::whyRefused(
                  test::saveSkin(folder + "/tube.skin", R"(, "shape": "fast", "colour": "red")")),
              "read");
    expectContains(notices.warnings(), "shape: unknown member ignored; did you mean \"shapes\"?");
    expectContains(notices.warnings(),
                   "colour: unknown member ignored, expected one of \"osgskin\"");
    expectContains(notices.warnings(), "\"unit\"");
}

TEST(Messages, ListJoints) {
    const std::string folder = test::makeTestFolder();
    const std::string known = ", expected one of \"arm\", \"base\"; did you mean \"arm\"?";
    const auto refusal = [&](const std::string& members) {
        return test::whyRefused(test::saveSkin(folder + "/tube.skin", members));
    };
    expectContains(refusal(R"(, "rigid": ["armm"])"),
                   "rigid joint \"armm\" is not in the skeleton" + known);
    expectContains(refusal(R"(, "joints": {"Arm": {"skip": true}})"),
                   "joint \"Arm\" is not in the skeleton" + known);
    expectContains(refusal(R"(, "muscles": [{"name": "m", "joint": "rig:arm"}])"),
                   "joint \"rig:arm\" is not in the skeleton" + known);
    std::ofstream(folder + "/weights.json") << R"({"weights": {"amr": [[0, 1]]}})";
    expectContains(refusal(R"(, "weights": "weights.json")"),
                   "weights.amr: not a joint of the skeleton" + known);
    const std::string motion =
        R"(, "motions": [{"file": ")" + kTubeFolder + R"(move.bvh", "joints": )";
    expectContains(refusal(motion + R"({"armm": "arm"}}])"), "which the rig does not have" + known);
    expectContains(refusal(motion + R"({"arm": "armm"}}])"),
                   "which the motion does not have" + known);
    expectContains(refusal(R"(, "names": {"mine": {"Hip": "base"}})"), "did you mean \"Hips\"?");
}

TEST(Messages, ListMotions) {
    const std::string clips = clipsFile(), folder = test::makeTestFolder();
    expectContains(test::whyRefused(clips, "motion=walk2"),
                   ", expected one of \"Idle Loop\", \"Walk\"; did you mean \"Walk\"?");
    expectContains(test::whyRefused(clips, "motion=Idle Loop"),
                   "an option string needs quotes: motion=\"Idle Loop\"");
    EXPECT_EQ(test::whyRefused(clips, "motion=\"Idle Loop\""), "read");
    expectContains(
        test::whyRefused(
            test::saveSkin(folder + "/tube.skin",
                           R"(, "motions": [{"file": ")" + clips + R"(", "clip": "Wlak"}])"),
            ""),
        "no clip \"Wlak\", expected one of 0 \"Idle Loop\", 1 \"Walk\"; did you mean \"Walk\"?");
    expectContains(
        test::whyRefused(test::saveSkin(folder + "/tube.skin",
                                        R"(, "motions": [{"file": ")" + kTubeFolder +
                                            R"(move.bvh"}], "props": [{"mesh": "m", "file": "f", )"
                                            R"("motion": "moves"}])"),
                         ""),
        "did you mean \"move\"?");
    expectContains(test::runBake("'" + clips + "' --motion walk2", folder).err,
                   "did you mean \"Walk\"?");
}

TEST(Messages, ExplainQuotesInOptionStrings) {
    const auto& all = osgSkin::characterOptions();
    const auto motion = std::find_if(all.begin(), all.end(),
                                     [](const auto& option) { return option.word == "motion"; });
    ASSERT_NE(motion, all.end());
    expectContains(motion->meaning, "motion=\"Idle Loop\"");
}

TEST(Messages, NameTheSkinFileOfAMissingFile) {
    const std::string folder = test::makeTestFolder(), skin = folder + "/tube.skin: ";
    const std::string body = kTubeFolder + "body.obj", rig = kTubeFolder + "rig.bvh";
    const auto refusal = [&](const std::string& mesh, const std::string& skeleton,
                             const std::string& more) {
        return test::whyRefused(test::saveSkin(folder + "/tube.skin", more, mesh, skeleton));
    };
    for (const std::string& why :
         {refusal("none.obj", rig, ""), refusal(body, "none.bvh", ""),
          refusal(body, rig, R"(, "motions": [{"file": "none.bvh"}])"),
          refusal(body, rig, R"(, "bind": "weights", "weights": "none.json")"),
          refusal(body, rig,
                  R"(, "motions": [{"file": ")" + kTubeFolder +
                      R"(move.bvh"}], "props": [{"mesh": "none.obj", "file": ")" + kTubeFolder +
                      R"(move.bvh", "motion": "move"}])")}) {
        EXPECT_EQ(why.rfind(skin, 0), 0u) << why;
        expectContains(why, "none.");
        expectContains(why, "cannot open");
    }
}

TEST(Messages, ExplainHowToUseAMotionFile) {
    const std::string bvh = OSGSKIN_TEST_DATA "/bvh/two_joints.bvh";
    test::GltfColumn column;
    column.bend();
    column.json["nodes"][column.meshNode].erase("skin");
    const std::string gltf = column.save("messages_motion.gltf");
    for (const std::string& file : {bvh, gltf}) {
        const std::string why = test::whyRefused(file + ".skin");
        expectContains(why, "no mesh with bones");
        expectContains(why, "name it in the \"motions\" of a .skin file");
        expectContains(why, "-O 'motion=\"" + file + "\"'");
    }
    const std::string still = test::whyRefused(OSGSKIN_TEST_DATA "/rig/unskinned.gltf");
    expectContains(still, "no mesh with bones");
    expectContains(test::whyRefused(kTubeFolder + "body.obj.skin"), "can name a skeleton for it");
}
