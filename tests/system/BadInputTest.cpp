// SPDX-License-Identifier: MIT
// The plug-in and osgskinbake reject each bad file with one line that names the file and the place.
#include "Command.h"
#include "Notices.h"

#include <gtest/gtest.h>
#include <osgDB/ReadFile>

#include <algorithm>
#include <ostream>

namespace {

struct BadFile {
    const char* name;
    const char* file;     ///< that the message must name
    const char* place;    ///< in it
    const char* expected; ///< part of what the message says was expected
};

std::ostream& operator<<(std::ostream& out, const BadFile& bad) {
    return out << bad.name;
}

const BadFile kBadFiles[] = {
    {"missing_mesh", "nowhere.obj", "", "cannot open"},
    {"mesh_without_faces", "no_faces.obj", "", "expected at least one"},
    {"mesh_with_nan", "nan_vertex.obj", "line 2", "expected"},
    {"missing_skeleton", "nowhere.bvh", "", "cannot open"},
    {"empty_skeleton", "no_root.bvh", "line 2", "expected a ROOT"},
    {"cyclic_skeleton", "cyclic.gltf", "nodes", "recursive"},
    {"no_skeleton_named", "body.obj", "skeleton", "expected"},
    {"fit_false", "fit_false.skin", "skeleton.fit", "expected true"},
    {"fit_missing", "fit_missing.skin", "skeleton", "\"fit\" is missing, expected true"},
    {"fit_no_person", "body.obj", "cannot fit a skeleton", "expected"},
    {"fit_unknown_landmark", "fit_unknown_landmark.skin", "skeleton.landmarks.Nose",
     "not a CMU joint, expected one of"},
    {"fit_landmark_not_a_point", "fit_landmark_not_a_point.skin", "skeleton.landmarks.Head",
     "expected a list of three numbers"},
    {"fit_facing_nowhere", "fit_facing_nowhere.skin", "skeleton.facing", "expected a direction"},
    {"truncated_motion", "truncated_motion.bvh", "line", "expected"},
    {"missing_motion", "nowhere.bvh", "", "cannot open"},
    {"foreign_motion", "root_only.bvh", "", "no joint"},
    {"all_frames_skipped", "move.bvh", "4 frame", "expected"},
    {"motion_name_twice", "motion_name_twice.skin", "motions[1]", "expected"},
    {"motion_without_file", "motion_without_file.skin", "motions[0]", "expected"},
    {"negative_skip", "negative_skip.skin", "motions[0].skipFrames", "expected a whole number"},
    {"unknown_mapped_joint", "move.bvh", "\"nobody\"", "joint"},
    {"unknown_joint", "unknown_joint.skin", "\"nobody\"", "expected"},
    {"muscles_of_no_kind", "muscles_of_no_kind.skin", "muscles", "expected true or false"},
    {"muscle_of_unknown_joint", "muscle_of_unknown_joint.skin", "\"nobody\"", "expected one of"},
    {"muscle_on_no_side", "muscle_on_no_side.skin", "muscles[0].side", "expected \"flexor\""},
    {"unknown_rigid", "unknown_rigid.skin", "\"nobody\"", "expected"},
    {"unknown_method", "unknown_method.skin", "bind", "expected \"smooth\""},
    {"weights_not_named", "body.obj", "carries no weights", "expected bones"},
    {"mesh_weights_of_unknown_joint", "tube.gltf", "\"base\"", "no such joint, expected one of"},
    {"weights_with_smooth", "weights_with_smooth.skin", "weights", "expected \"bind\""},
    {"missing_weights", "nowhere.json", "", "cannot open"},
    {"weights_malformed", "weights_malformed.json", "line 1", "malformed JSON"},
    {"weights_without_member", "weights_without_member.json", "weights", "expected"},
    {"weights_as_list", "weights_as_list.json", "weights", "expected an object"},
    {"weights_of_unknown_joint", "weights_of_unknown_joint.json", "weights.nobody", "expected"},
    {"weights_beyond_mesh", "weights_beyond_mesh.json", "weights.arm[1][0]", "below 56"},
    {"weights_not_a_pair", "weights_not_a_pair.json", "weights.arm[1]", "expected"},
    {"weights_vertex_as_text", "weights_vertex_as_text.json", "weights.arm[0][0]",
     "expected a whole number"},
    {"weights_negative", "weights_negative.json", "weights.arm[0][1]", "0 or more"},
    {"weights_as_text", "weights_as_text.json", "weights.arm[0][1]", "expected a number"},
    {"weights_all_zero", "weights_all_zero.skin", "weights", "above 0"},
    {"names_of_unknown_role", "names_of_unknown_role.skin", "names.robot.Elbow", "expected one of"},
    {"names_as_number", "names_as_number.skin", "names.robot.Hips", "expected a string"},
    {"unknown_pole", "unknown_pole.skin", "joints.arm.twist.along", "expected"},
    {"crossed_boundaries", "crossed_boundaries.skin", "joints.arm.bend", "expected"},
    {"unknown_up", "unknown_up.skin", "up", "expected"},
    {"unknown_motion_up", "unknown_motion_up.skin", "motions[0].up", "expected \"y\" or \"z\""},
    {"prop_without_motion", "prop_without_motion.skin", "props[0].motion", "no motion is called"},
    {"malformed", "malformed.skin", "line 3", "malformed JSON"},
    {"empty_file", "empty_file.skin", "line 1", "malformed JSON"},
    {"not_an_object", "not_an_object.skin", "", "expected an object"},
    {"no_version", "no_version.skin", "osgskin", "expected"},
    {"future_version", "future_version.skin", "osgskin", "version 2 is not supported, expected 1"},
    {"version_as_text", "version_as_text.skin", "osgskin", "expected a whole number"},
    {"mesh_as_number", "mesh_as_number.skin", "mesh", "expected a string"},
    {"empty_mesh_name", "empty_mesh_name.skin", "mesh", "expected a file name"},
    {"motions_as_object", "motions_as_object.skin", "motions", "expected a list"},
    {"joints_as_list", "joints_as_list.skin", "joints", "expected an object"},
    {"rigid_as_text", "rigid_as_text.skin", "rigid", "expected a list"},
    {"skip_as_number", "skip_as_number.skin", "joints.arm.skip", "expected true or false"},
    {"no_such_character", "no_such_character.skin", "", "cannot open"},
};

std::string path(const BadFile& bad) {
    return std::string(OSGSKIN_TEST_DATA "/character/bad/") + bad.name + ".skin";
}

class BadInput : public testing::TestWithParam<BadFile> {
protected:
    static void expectClear(const std::string& complaint) {
        const BadFile& bad = GetParam();
        for (const char* part : {bad.file, bad.place, bad.expected})
            EXPECT_NE(complaint.find(part), std::string::npos)
                << '"' << part << "\" in: " << complaint;
    }
};

} // namespace

TEST_P(BadInput, BakeExitsWithOneAndPrintsOneLine) {
    const auto result =
        test::runBake("'" + path(GetParam()) + "' --rest rest.obj", test::makeTestFolder());
    EXPECT_EQ(result.status, 1);
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
    expectClear(result.err);
}

TEST_P(BadInput, ReadNodeFileReturnsNull) {
    const test::Notices notices;
    const osg::ref_ptr<osg::Node> node = osgDB::readRefNodeFile(path(GetParam()));
    EXPECT_FALSE(node.valid());
    if (std::string(GetParam().name) == "no_such_character") {
        EXPECT_TRUE(notices.say("no_such_character.skin"));
        return; // osgDB's own error, in its own words
    }
    expectClear(notices.text());
}

INSTANTIATE_TEST_SUITE_P(Files, BadInput, testing::ValuesIn(kBadFiles),
                         [](const auto& c) { return std::string(c.param.name); });
