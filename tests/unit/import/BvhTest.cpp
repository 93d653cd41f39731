// SPDX-License-Identifier: MIT
//
// Exporters' variations of the format must be read like the plain file, or refused with a reason.
#include "ExpectError.h"
#include "Figure.h"
#include "NamedCase.h"
#include "Notices.h"
#include "Paths.h"
#include "TextFile.h"

#include <osgSkin/Error>
#include <osgSkinImport/ImportMotion>
#include <osgSkinImport/ImportSkeleton>
#include <osgSkinRig/Motion>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <cctype>
#include <fstream>
#include <functional>
#include <iterator>
#include <sstream>
#include <string>
#include <vector>

namespace {

std::string plainText() {
    return test::fileText(testData("bvh/two_joints.bvh"));
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
    std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    for (; at != std::string::npos; at = text.find(from, at + to.size()))
        text.replace(at, from.size(), to);
    return text;
}

std::string saveBvh(const std::string& text) {
    return test::saveText("dialect.bvh", text);
}

struct Dialect {
    const char* name;
    std::function<std::string(std::string)> write; ///< from the plain text
};

void PrintTo(const Dialect& dialect, std::ostream* out) {
    *out << dialect.name;
}

const Dialect kSame[] = {
    {"Tabs", [](const std::string& t) { return replaced(replaced(t, "  ", "\t"), " ", "\t"); }},
    {"CarriageReturnLineFeed", [](const std::string& t) { return replaced(t, "\n", "\r\n"); }},
    {"CarriageReturn", [](const std::string& t) { return replaced(t, "\n", "\r"); }},
    {"LowerCase",
     [](std::string t) {
         for (char& c : t) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
         return replaced(replaced(t, "hips", "Hips"), "spine", "Spine");
     }},
    {"UpperCaseChannels",
     [](const std::string& t) {
         return replaced(replaced(t, "rotation", "ROTATION"), "End", "END");
     }},
    {"EndSiteInLowerCase",
     [](const std::string& t) { return replaced(t, "End Site", "End site"); }},
    {"ByteOrderMark", [](const std::string& t) { return "\xef\xbb\xbf" + t; }},
    {"EndOfFileMark", [](const std::string& t) { return t + "\x1a"; }},
    {"Zeros", [](const std::string& t) { return t + std::string(3, '\0'); }},
    {"TrailingBlankLines", [](const std::string& t) { return t + " \n\n\t\n"; }},
    {"NoLastLineEnd",
     [](std::string t) {
         t.pop_back();
         return t;
     }},
    {"LeadingBlankLines", [](const std::string& t) { return "\n\n" + t; }},
    {"BlanksAtLineEnds", [](const std::string& t) { return replaced(t, "\n", "  \n"); }},
    {"BraceBehindTheName", [](const std::string& t) { return replaced(t, "\n{", " {"); }},
    {"BraceAgainstTheName", [](const std::string& t) { return replaced(t, "Hips\n{", "Hips{"); }},
    {"NameOnTheNextLine", [](const std::string& t) { return replaced(t, "ROOT ", "ROOT\n"); }},
    {"ColonsWithoutABlank",
     [](const std::string& t) {
         return replaced(replaced(t, "Frames: ", "Frames:"), "Time: ", "Time:");
     }},
    {"BlanksBeforeColons", [](const std::string& t) { return replaced(t, ":", " :"); }},
    {"NamesOfEndSites",
     [](const std::string& t) { return replaced(t, "End Site", "End Site Spine end"); }},
    {"Exponents", [](const std::string& t) { return replaced(t, " 40 50 ", " 4e1 5.0E+01 "); }},
    {"SignsAndPoints",
     [](const std::string& t) { return replaced(t, " 40 50 60", " +40 50. +60.0"); }},
};

class BvhVariant : public testing::TestWithParam<Dialect> {};

TEST_P(BvhVariant, ReadsTheSameMotion) {
    const osgSkin::Motion plain = osgSkin::importMotion(testData("bvh/two_joints.bvh"));
    const std::string path = saveBvh(GetParam().write(plainText()));
    const osgSkin::Motion motion = osgSkin::importMotion(path);
    ASSERT_EQ(motion.skeleton.joints.size(), plain.skeleton.joints.size());
    for (std::size_t j = 0; j < plain.skeleton.joints.size(); ++j) {
        EXPECT_EQ(motion.skeleton.joints[j].name, plain.skeleton.joints[j].name);
        EXPECT_EQ(motion.skeleton.joints[j].centre, plain.skeleton.joints[j].centre);
        EXPECT_EQ(motion.skeleton.joints[j].tip, plain.skeleton.joints[j].tip);
    }
    EXPECT_EQ(motion.frameTime, plain.frameTime);
    EXPECT_EQ(motion.rotations, plain.rotations);
    EXPECT_EQ(motion.rootPositions, plain.rootPositions);
}

INSTANTIATE_TEST_SUITE_P(Dialects, BvhVariant, testing::ValuesIn(kSame),
                         [](const auto& dialect) { return std::string(dialect.param.name); });

struct Refused {
    const char* name;
    const char* from;
    const char* to; ///< in the plain text
    const char* message;
};

void PrintTo(const Refused& refused, std::ostream* out) {
    *out << refused.name;
}

const Refused kRefused[] = {
    {"NoFrameTimeDigits", "Time: 0.025",
     "Time:", "line 18: the frame time is missing, expected a positive number of seconds"},
    {"NoNumberOfFrames", "Frames: 2", "Frames:", "line 18: the number of frames is \"Frame\""},
    {"NoName", "JOINT Spine", "JOINT", "line 7: found \"{\", expected a joint's name"},
    {"CommaForAPoint", " 40 50 60", " 40,5 50 60",
     "line 20: frame 1, joint \"Spine\" has \"40,5\", expected a finite number"},
    {"TinyFrameTime", "0.025", "1e-9", "line 18: the frame time is 0.000000, expected a positive"},
    {"HugePosition", "1 11 2", "1 1e39 2",
     "line 20: frame 1, joint \"Hips\" has \"1e39\", expected a number from -1e18"},
    {"HugeOffset", "OFFSET 0 5 1", "OFFSET 0 5e38 1",
     "line 8: joint \"Spine\"'s OFFSET y is \"5e38\", expected a number from -1e18"},
    {"Hexadecimal", " 40 50 60", " 0x40 50 60", "line 20: frame 1, joint \"Spine\" has \"0x40\""},
    {"FourRotations", "CHANNELS 6 Xposition Yposition Zposition Zrotation Yrotation Xrotation",
     "CHANNELS 6 Xposition Yposition Zrotation Yrotation Xrotation Zrotation",
     "line 5: joint \"Hips\" has unsupported CHANNELS"},
    {"PositionTwice", "Xposition Yposition Zposition", "Xposition Xposition Zposition",
     "line 5: joint \"Hips\" has unsupported CHANNELS"},
    {"SevenChannels", "CHANNELS 6", "CHANNELS 7", "line 5: joint \"Hips\"'s number of CHANNELS"},
    {"ChannelsTwice", "    CHANNELS 3 Xrotation Yrotation Zrotation\n",
     "    CHANNELS 1 Xrotation\n    CHANNELS 2 Yrotation Zrotation\n",
     "line 10: joint \"Spine\" has CHANNELS twice"},
    {"EndWithoutSite", "End Site", "End", "line 11: found \"{\", expected \"Site\""},
    {"JointsAfterAnEndSite", "End Site", "EndSite", "line 10: found \"EndSite\" in joint"},
};

class BrokenBvh : public testing::TestWithParam<Refused> {};

TEST_P(BrokenBvh, ErrorNamesTheLine) {
    const std::string path = saveBvh(replaced(plainText(), GetParam().from, GetParam().to));
    expectError([&] { osgSkin::importMotion(path); }, path + ": " + GetParam().message);
    expectError([&] { osgSkin::importSkeleton(path); }, path + ": " + GetParam().message);
}

INSTANTIATE_TEST_SUITE_P(Dialects, BrokenBvh, testing::ValuesIn(kRefused),
                         [](const auto& refused) { return std::string(refused.param.name); });

TEST(BvhDialect, AllowsZeroFrameTimeForOneFrame) {
    std::string text = replaced(plainText(), "Time: 0.025", "Time: 0");
    expectError([&] { osgSkin::importMotion(saveBvh(text)); }, "the frame time is 0.000000");
    text = replaced(text, "Frames: 2", "Frames: 1");
    const std::string path = saveBvh(text);
    EXPECT_EQ(osgSkin::importSkeleton(path).joints.size(), 2u);
    EXPECT_GT(osgSkin::importMotion(path).frameTime, 0.0);
}

TEST(BvhDialect, RootMayHavePositionsOnly) {
    std::string text = replaced(plainText(), " Zrotation Yrotation Xrotation", "");
    text = replaced(text, "CHANNELS 6", "CHANNELS 3");
    std::istringstream in(text);
    std::string kept;
    for (std::string line; std::getline(in, line);) {
        std::istringstream words(line);
        std::vector<std::string> row(std::istream_iterator<std::string>(words), {});
        if (row.size() == 9) row.erase(row.begin() + 3, row.begin() + 6);
        if (row.size() == 6 && line.find_first_of("CO") == std::string::npos) {
            line.clear();
            for (const std::string& word : row) line += word + " ";
        }
        kept += line + "\n";
    }
    const osgSkin::Motion plain = osgSkin::importMotion(testData("bvh/two_joints.bvh"));
    const std::string path = saveBvh(kept);
    const osgSkin::Motion motion = osgSkin::importMotion(path);
    EXPECT_EQ(motion.rootPositions, plain.rootPositions);
    for (std::size_t f = 0; f < motion.frames; ++f) {
        EXPECT_EQ(motion.rotation(f, 0), glm::dquat(1, 0, 0, 0));
        EXPECT_EQ(motion.rotation(f, 1), plain.rotation(f, 1));
    }
}

/// Props and cameras rotate about one axis; some figures only rise and sink.
TEST(BvhDialect, RootMayHaveSomeChannels) {
    const auto motionOf = [](const std::string& channels, const std::string& numbers) {
        const std::string path =
            saveBvh("HIERARCHY\nROOT base\n{\nOFFSET 7 8 9\nCHANNELS " + channels +
                    "\nEnd Site\n{\nOFFSET 0 1 0\n}\n}\nMOTION\nFrames: 1\n" + "Frame Time: 0.1\n" +
                    numbers + "\n");
        return osgSkin::importMotion(path);
    };
    const osgSkin::Motion turns = motionOf("4 Xposition Yposition Zposition Yrotation", "1 2 3 90");
    EXPECT_EQ(turns.rootPositions[0], glm::dvec3(1, 2, 3));
    EXPECT_LT(angleBetween(turns.rotation(0, 0), turnDegrees(90, {0, 1, 0})), 1e-9);
    const osgSkin::Motion rises = motionOf("2 Zrotation Yposition", "30 2");
    EXPECT_EQ(rises.rootPositions[0], glm::dvec3(7, 2, 9));
    EXPECT_LT(angleBetween(rises.rotation(0, 0), turnDegrees(30, {0, 0, 1})), 1e-9);
}

TEST(BvhDialect, NamesMayHaveBlanks) {
    const std::string path =
        saveBvh(replaced(replaced(plainText(), "JOINT Spine", "JOINT Bip01  L Thigh "),
                         "ROOT Hips\n{", "ROOT Bip01 Pelvis {"));
    const osgSkin::RestSkeleton skeleton = osgSkin::importSkeleton(path);
    ASSERT_EQ(skeleton.joints.size(), 2u);
    EXPECT_EQ(skeleton.joints[0].name, "Bip01 Pelvis");
    EXPECT_EQ(skeleton.joints[1].name, "Bip01  L Thigh");
}

TEST(BvhDialect, LongNamesAreKept) {
    const std::string name(5000, 'n');
    const std::string path = saveBvh(replaced(plainText(), "Spine", name));
    EXPECT_EQ(osgSkin::importSkeleton(path).find(name), 1);
}

TEST(BvhDialect, SmallNumbersHaveExponents) {
    const std::string path = saveBvh(replaced(plainText(), "1 11 2", "1e-05 -2.5E-3 1e-400"));
    EXPECT_EQ(osgSkin::importMotion(path).rootPositions[1], glm::dvec3(1e-5, -2.5e-3, 0.0));
}

TEST(BvhDialect, WarnsAboutFrameTimesInMilliseconds) {
    for (const auto& [time, isTold] : {std::pair("33.3333", true), std::pair("0.5", false)}) {
        std::string text = plainText();
        const std::size_t at = text.find("Frame Time:") + 11;
        text.replace(at, text.find('\n', at) - at, std::string(" ") + time);
        const std::string path = saveBvh(text);
        const test::Notices notices;
        osgSkin::importMotion(path);
        EXPECT_EQ(notices.say("a frame takes 33.333300 seconds"), isTold) << notices.text();
    }
}

/// QAvimator, an editor for Second Life, appends the numbers of its key frames.
TEST(BvhDialect, WarnsAboutExtraFrames) {
    const std::string path = saveBvh(plainText() + "2 0 1\n8 0 1 29 59 60\n");
    const test::Notices notices;
    const osgSkin::Motion motion = osgSkin::importMotion(path);
    EXPECT_EQ(motion.frames, 2u);
    EXPECT_EQ(motion.rootPositions[1], glm::dvec3(1, 11, 2));
    EXPECT_TRUE(notices.say("line 21: 2 line(s) beyond the declared 2 frames ignored"))
        << notices.text();
}

TEST(BvhDialect, PositionsMayComeInAnyOrder) {
    const std::string path = saveBvh(
        replaced(plainText(), "Xposition Yposition Zposition", "Zposition Xposition Yposition"));
    EXPECT_EQ(osgSkin::importMotion(path).rootPositions[1], glm::dvec3(11, 2, 1));
}

/// Exporters that write positions for every joint mean its offset, or a stretch that no skin
/// follows.
TEST(BvhDialect, UsesPositionsOfTheRootOnly) {
    const osgSkin::Motion plain = osgSkin::importMotion(testData("bvh/two_joints.bvh"));
    const std::string more = "CHANNELS 6 Xposition Yposition Zposition Xrotation";
    std::string text = replaced(plainText(), "CHANNELS 3 Xrotation", more);
    // A second child, so that the motion's root remains the root.
    text =
        replaced(text, "  JOINT Spine", "  JOINT Leg\n  {\n    OFFSET 0 -5 0\n  }\n  JOINT Spine");
    text = replaced(text, "0 10 0 0 0 0 0 0 0", "0 10 0 0 0 0 0 5 1 0 0 0");
    text = replaced(text, "10 20 30 40", "10 20 30 7 7 7 40");
    const std::string path = saveBvh(text);
    const test::Notices notices;
    const osgSkin::Motion motion = osgSkin::importMotion(path);
    EXPECT_TRUE(notices.say("joint \"Spine\" is translated; only translations of \"Hips\""))
        << notices.text();
    EXPECT_EQ(notices.lines(), 1u) << notices.text();
    ASSERT_EQ(motion.skeleton.joints.size(), 3u);
    EXPECT_EQ(motion.rootPositions, plain.rootPositions);
    EXPECT_EQ(motion.rotation(1, 2), plain.rotation(1, 1));
    EXPECT_EQ(motion.rotation(1, 1), glm::dquat(1, 0, 0, 0));
}

/// Each angle to the last digit: the product of the channels' rotations in double precision.
TEST(BvhDialect, RotationsAreExact) {
    const std::string path = sharedData("cmu/mb/01_03.bvh");
    OSGSKIN_NEEDS(path);
    const osgSkin::Motion motion = osgSkin::importMotion(path);
    std::ifstream file(path);
    std::string line;
    while (std::getline(file, line) && line.rfind("Frame Time", 0) != 0) continue;
    // MotionBuilder's files: the root's position, then Z, Y, X for all joints.
    double worst = 0.0;
    for (std::size_t f = 0; f < motion.frames && std::getline(file, line); ++f) {
        std::istringstream values(line);
        glm::dvec3 position;
        values >> position.x >> position.y >> position.z;
        worst = std::max(worst, glm::distance(position, motion.rootPositions[f]));
        for (std::size_t j = 0; j < motion.skeleton.joints.size(); ++j) {
            double degrees[3];
            values >> degrees[0] >> degrees[1] >> degrees[2];
            const glm::dmat3 expected(
                glm::mat4_cast(glm::angleAxis(glm::radians(degrees[0]), glm::dvec3(0, 0, 1))) *
                glm::mat4_cast(glm::angleAxis(glm::radians(degrees[1]), glm::dvec3(0, 1, 0))) *
                glm::mat4_cast(glm::angleAxis(glm::radians(degrees[2]), glm::dvec3(1, 0, 0))));
            const glm::dmat3 found = glm::mat3_cast(motion.rotation(f, j));
            for (int k = 0; k < 3; ++k)
                worst = std::max(worst, glm::distance(expected[k], found[k]));
        }
        ASSERT_TRUE(values) << f;
    }
    EXPECT_LT(worst, 1e-12);
}

class BadBvh : public testing::TestWithParam<BadFile> {};

TEST_P(BadBvh, ErrorNamesFileAndLine) {
    const std::string path = testData(std::string("bvh/") + GetParam().file);
    ASSERT_TRUE(std::filesystem::exists(path));
    expectError([&] { osgSkin::importMotion(path); }, path + ": " + GetParam().message);
}

INSTANTIATE_TEST_SUITE_P(
    Files, BadBvh,
    testing::Values(
        BadFile{"empty.bvh", "line 1: found the end of the file, expected \"HIERARCHY\""},
        BadFile{"no_root.bvh", "line 2: found \"MOTION\", expected a ROOT"},
        BadFile{"second_root.bvh", "line 16: found \"ROOT\", expected \"MOTION\""},
        BadFile{"truncated_hierarchy.bvh", "line 10: found the end of the file in joint \"Spine\""},
        BadFile{"duplicate_joint.bvh", "line 6: a second joint called \"Hips\""},
        BadFile{"missing_offset.bvh", "line 13: joint \"Spine\" has no OFFSET"},
        BadFile{"second_offset.bvh", "line 9: joint \"Spine\" has OFFSET twice"},
        BadFile{"infinite_offset.bvh", "line 8: joint \"Spine\"'s OFFSET y is \"inf\""},
        BadFile{"no_channels.bvh", "line 5: no joint has CHANNELS"},
        BadFile{"unknown_channel.bvh", "line 9: joint \"Spine\" has the channel \"Wrotation\""},
        BadFile{"no_motion.bvh", "line 16: found the end of the file, expected \"MOTION\""},
        BadFile{"no_frames.bvh", "no frame, expected at least one"},
        BadFile{"negative_frames.bvh", "line 17: the number of frames is \"-2\""},
        BadFile{"billion_frames.bvh", "line 17: the number of frames is \"1000000000\""},
        BadFile{"million_frames.bvh", "line 20: the motion ends after 1 frame(s)"},
        BadFile{"missing_frame_time.bvh", "line 18: found \"0\", expected \"Frame\""},
        BadFile{"zero_frame_time.bvh", "line 18: the frame time is 0"},
        BadFile{"nan_frame_time.bvh", "line 18: the frame time is \"nan\""},
        BadFile{"truncated_motion.bvh", "line 20: the motion ends after 1 frame(s)"},
        BadFile{"short_row.bvh", "line 19: a frame of 8 values, expected 9"},
        BadFile{"uneven_rows.bvh", "line 19: a frame of 8 values, expected 9"},
        BadFile{"not_a_number.bvh", "line 20: frame 1, joint \"Spine\" has \"fifty\""},
        BadFile{"nan_value.bvh", "line 20: frame 1, joint \"Spine\" has \"nan\""},
        BadFile{"overflowing_value.bvh", "line 20: frame 1, joint \"Spine\" has \"1e300\""}),
    nameOf);

TEST(MotionErrors, MissingFileNamesTheReason) {
    const std::string path = testData("bvh/no_such_file.bvh");
    expectError([&] { osgSkin::importMotion(path); }, path + ": cannot open: No such file");
    expectError([&] { osgSkin::importSkeleton(path); }, path + ": cannot open: No such file");
}

TEST(MotionErrors, RejectsDirectory) {
    expectError([] { osgSkin::importMotion(testData("bvh")); }, "cannot open: it is a directory");
}

TEST(MotionErrors, RejectsSkippingAllFrames) {
    const std::string path = testData("bvh/two_joints.bvh");
    EXPECT_EQ(osgSkin::importMotion(path, 1).frames, 1u);
    expectError([&] { osgSkin::importMotion(path, 2); }, path + ": 2 frame(s), expected more than");
}

TEST(MotionErrors, RejectsDeepNesting) {
    std::string text = "HIERARCHY\nROOT j\n{\nOFFSET 0 0 0\nCHANNELS 1 Xrotation\n";
    for (int i = 0; i < 100000; ++i) text += "JOINT j" + std::to_string(i) + "\n{\nOFFSET 0 1 0\n";
    const std::string path = saveBvh(text);
    expectError([&] { osgSkin::importSkeleton(path); }, "is nested more than 1000 deep");
}

TEST(MotionErrors, RejectsMeshFormats) {
    const std::string path = testData("mesh/square.ply");
    expectError([&] { osgSkin::importSkeleton(path); },
                path + ": files of this format have no skeleton");
    expectError([&] { osgSkin::importMotion(path); },
                path + ": files of this format have no animation");
}

const glm::dvec3 kX(1, 0, 0), kY(0, 1, 0), kZ(0, 0, 1);

double difference(const glm::dquat& a, const glm::dquat& b) {
    return glm::length(a * glm::conjugate(b) * glm::dvec3(1, 2, 3) - glm::dvec3(1, 2, 3)) +
           glm::length(a * glm::conjugate(b) * kX - kX);
}

TEST(ImportMotion, ReadsTheDeclaredChannelOrderOfEachJoint) {
    const osgSkin::Motion motion = osgSkin::importMotion(testData("bvh/two_joints.bvh"));
    ASSERT_EQ(motion.frames, 2u);
    ASSERT_EQ(motion.skeleton.joints.size(), 2u);
    EXPECT_EQ(motion.name, "two_joints");
    EXPECT_EQ(motion.frameTime, 0.025);
    EXPECT_LT(difference(motion.rotation(0, 0), {1, 0, 0, 0}), 1e-12);
    EXPECT_LT(difference(motion.rotation(1, 0),
                         turnDegrees(10, kZ) * turnDegrees(20, kY) * turnDegrees(30, kX)),
              1e-12);
    EXPECT_LT(difference(motion.rotation(1, 1),
                         turnDegrees(40, kX) * turnDegrees(50, kY) * turnDegrees(60, kZ)),
              1e-12);
    EXPECT_GT(difference(motion.rotation(1, 1),
                         turnDegrees(60, kZ) * turnDegrees(50, kY) * turnDegrees(40, kX)),
              0.1);
}

TEST(ImportMotion, PositionChannelsReplaceTheRootsOffset) {
    const osgSkin::Motion motion = osgSkin::importMotion(testData("bvh/two_joints.bvh"));
    EXPECT_EQ(motion.skeleton.joints[0].centre, glm::dvec3(0, 10, 0));
    EXPECT_EQ(motion.rootPositions[0], glm::dvec3(0, 10, 0));
    EXPECT_EQ(motion.rootPositions[1], glm::dvec3(1, 11, 2));
}

TEST(ImportMotion, RootWithoutPositionChannelsStaysAtItsOffset) {
    const osgSkin::Motion motion = osgSkin::importMotion(testData("bvh/root_only.bvh"));
    ASSERT_EQ(motion.frames, 1u);
    EXPECT_EQ(motion.frameTime, 0.5);
    EXPECT_EQ(motion.rootPositions[0], glm::dvec3(1, 2, 3));
    EXPECT_LT(difference(motion.rotation(0, 0),
                         turnDegrees(10, kY) * turnDegrees(20, kX) * turnDegrees(30, kZ)),
              1e-12);
}

/// If the hips move relative to a root on the ground, the path is that of the hips: rotated by the
/// root, from its position.
TEST(ImportMotion, RootIsTheFirstMovingJoint) {
    const test::Notices notices;
    const osgSkin::Motion motion = osgSkin::importMotion(testData("root_on_ground.bvh"));
    EXPECT_EQ(notices.text(), ""); // the root's own movement is used as well
    ASSERT_EQ(motion.skeleton.joints.size(), 3u);
    EXPECT_EQ(motion.skeleton.joints[0].name, "pelvis");
    EXPECT_EQ(motion.skeleton.joints[0].parent, -1);
    EXPECT_EQ(motion.skeleton.joints[2].parent, 0);
    EXPECT_NO_THROW(motion.skeleton.validate());
    ASSERT_EQ(motion.rotations.size(), 6u);
    EXPECT_LT(glm::distance(motion.rootPositions[0], glm::dvec3(0, 10, 0)), 1e-12);
    EXPECT_LT(glm::distance(motion.rootPositions[1], glm::dvec3(5 + 3, 11, 0)), 1e-12);
    EXPECT_LT(difference(motion.rotation(1, 0), turnDegrees(90, kY)), 1e-12);
    EXPECT_LT(difference(motion.rotation(1, 1), {1, 0, 0, 0}), 1e-12);
}

TEST(ImportMotion, ReadsAllLineEndsAndWrappedFrames) {
    const osgSkin::Motion plain = osgSkin::importMotion(testData("bvh/two_joints.bvh"));
    for (const char* name : {"bvh/two_joints_crlf.bvh", "bvh/wrapped_rows.bvh"}) {
        const osgSkin::Motion other = osgSkin::importMotion(testData(name));
        EXPECT_EQ(other.rotations, plain.rotations) << name;
        EXPECT_EQ(other.rootPositions, plain.rootPositions) << name;
    }
}

TEST(ImportMotion, SkipsFrames) {
    const osgSkin::Motion all = osgSkin::importMotion(testData("bvh/two_joints.bvh"));
    const osgSkin::Motion last = osgSkin::importMotion(testData("bvh/two_joints.bvh"), 1);
    ASSERT_EQ(last.frames, 1u);
    EXPECT_EQ(last.rotation(0, 1), all.rotation(1, 1));
    EXPECT_EQ(last.rootPositions[0], all.rootPositions[1]);
}

TEST(ImportSkeleton, HasCentresParentsAndTips) {
    const osgSkin::RestSkeleton skeleton = osgSkin::importSkeleton(testData("bvh/two_joints.bvh"));
    ASSERT_EQ(skeleton.joints.size(), 2u);
    EXPECT_EQ(skeleton.joints[0].name, "Hips");
    EXPECT_EQ(skeleton.joints[0].parent, -1);
    EXPECT_FALSE(skeleton.joints[0].tip);
    EXPECT_EQ(skeleton.joints[1].name, "Spine");
    EXPECT_EQ(skeleton.joints[1].parent, 0);
    EXPECT_EQ(skeleton.joints[1].centre, glm::dvec3(0, 15, 1));
    ASSERT_TRUE(skeleton.joints[1].tip);
    EXPECT_EQ(*skeleton.joints[1].tip, glm::dvec3(0, 19, 1));
}

TEST(ImportSkeleton, ReadsFileWithoutFrames) {
    EXPECT_EQ(osgSkin::importSkeleton(testData("bvh/no_frames.bvh")).joints.size(), 2u);
}

TEST(ImportSkeleton, ReadsAMakeHumanRig) {
    const std::string path = sharedData("makehuman/rig/cmu_mb_neutral.bvh");
    OSGSKIN_NEEDS(path);
    const osgSkin::RestSkeleton rig = osgSkin::importSkeleton(path);
    EXPECT_EQ(rig.joints.size(), 31u);
    EXPECT_LT(glm::distance(rig.joints[0].centre, glm::dvec3(0, 0.72685, 0.1445)), 1e-12);
    const int head = rig.find("Head");
    ASSERT_GE(head, 0);
    ASSERT_TRUE(rig.joints[static_cast<std::size_t>(head)].tip);
    EXPECT_NEAR(rig.joints[static_cast<std::size_t>(head)].tip->y, 8.4044, 1e-4);
}

TEST(ImportMotion, IgnoresExtraFrames) {
    const osgSkin::Motion motion = osgSkin::importMotion(testData("bvh/more_rows.bvh"));
    EXPECT_EQ(motion.frames, 2u);
}

/// A motion made in code, from GLM's types and from OSG's.
TEST(Motion, AddFrameTakesGlmAndOsgTypes) {
    osgSkin::RestSkeleton skeleton;
    EXPECT_EQ(skeleton.add("Hips", -1, glm::dvec3(0, 1, 0)), 0);
    EXPECT_EQ(skeleton.add("Spine", 0, osg::Vec3d(0, 2, 0.5)), 1);
    skeleton.validate();
    EXPECT_EQ(skeleton.joints[1].centre, glm::dvec3(0, 2, 0.5));
    EXPECT_EQ(skeleton.joints[1].parent, 0);

    osgSkin::Motion motion;
    motion.name = "bow";
    motion.skeleton = skeleton;
    const osg::Quat bow(osg::PI_2, osg::X_AXIS);
    motion.addFrame(osg::Vec3d(1, 2, 3), {osg::Quat(), bow});
    motion.addFrame(glm::dvec3(4, 5, 6), {turnDegrees(90, kX), glm::dquat(1, 0, 0, 0)});
    ASSERT_EQ(motion.frames, 2u);
    EXPECT_LT(difference(motion.rotation(0, 1), turnDegrees(90, kX)), 1e-12);
    EXPECT_LT(difference(motion.rotation(1, 0), turnDegrees(90, kX)), 1e-12);
    EXPECT_EQ(motion.rootPositions[0], glm::dvec3(1, 2, 3));
    EXPECT_EQ(motion.rootPositions[1], glm::dvec3(4, 5, 6));

    EXPECT_THROW(motion.addFrame(osg::Vec3d(), {bow}), osgSkin::Error);
    EXPECT_EQ(motion.frames, 2u);
    EXPECT_EQ(motion.rotations.size(), 4u);
}

} // namespace
