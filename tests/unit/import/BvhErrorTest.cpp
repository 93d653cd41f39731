// SPDX-License-Identifier: MIT
#include "ExpectError.h"
#include "NamedCase.h"
#include "Paths.h"

#include <osgSkinImport/ImportMotion>
#include <osgSkinImport/ImportSkeleton>
#include <osgSkinRig/Motion>

#include <fstream>

namespace {

class BadBvh : public testing::TestWithParam<BadFile> {};

TEST_P(BadBvh, IsRefusedWithFileAndPlace) {
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
        BadFile{"duplicate_joint.bvh", "line 6: second joint called \"Hips\""},
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

TEST(MotionErrors, DirectoryIsNoFile) {
    expectError([] { osgSkin::importMotion(testData("bvh")); }, "cannot open: it is a directory");
}

TEST(MotionErrors, SkippingEverySampleIsRefused) {
    const std::string path = testData("bvh/two_joints.bvh");
    EXPECT_EQ(osgSkin::importMotion(path, 1).frames, 1u);
    expectError([&] { osgSkin::importMotion(path, 2); }, path + ": 2 frame(s), expected more than");
}

TEST(MotionErrors, DeepNestingIsRefusedAndDoesNotCrash) {
    const std::string path = testing::TempDir() + "osgskin_deep.bvh";
    std::ofstream file(path);
    file << "HIERARCHY\nROOT j\n{\nOFFSET 0 0 0\nCHANNELS 1 Xrotation\n";
    for (int i = 0; i < 100000; ++i) file << "JOINT j" << i << "\n{\nOFFSET 0 1 0\n";
    file.close();
    expectError([&] { osgSkin::importSkeleton(path); }, "is nested more than 1000 deep");
    std::filesystem::remove(path);
}

TEST(MotionErrors, OtherFormatsFailWithTheFile) {
    const std::string path = testData("mesh/square.ply");
    expectError([&] { osgSkin::importSkeleton(path); }, path + ": no skeleton");
    expectError([&] { osgSkin::importMotion(path); }, path + ": no animation");
}

} // namespace
