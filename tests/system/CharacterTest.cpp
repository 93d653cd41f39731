// SPDX-License-Identifier: MIT
//
// The whole scene as the plug-in builds it: parts, seams, and a plausible pose.
//
// The plug-in and osgskinbake refuse each bad file with one line that names the file and the place.
//
// Settings of a .skin file other than the default method for ratios.
//
// Choosing one motion of a file with several, in a .skin file and in options.
//
// Whether an actor lies, where a .skin file says which axis is up.
#include "CharacterFiles.h"
#include "Command.h"
#include "DrawnSkin.h"
#include "GltfBuilder.h"
#include "Notices.h"
#include "TextFile.h"
#include "WhyRefused.h"

#include <osgSkin/Error>
#include <osgSkin/GlmOsg>
#include <osgSkinCharacter/LoadCharacter>
#include <osgSkinCharacter/OptionString>
#include <osgSkinRig/ClipCharacter>
#include <osgSkinRig/ForwardKinematics>

#include <glm/gtc/quaternion.hpp>
#include <gtest/gtest.h>
#include <osg/TriangleIndexFunctor>
#include <osgAnimation/BoneMapVisitor>
#include <osgDB/ReadFile>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <functional>
#include <map>
#include <ostream>
#include <set>
#include <sstream>

namespace {

using osgSkin::Character;
using test::CharacterCase;

struct Triangles {
    std::vector<std::array<unsigned int, 3>> all;
    void operator()(unsigned int a, unsigned int b, unsigned int c) { all.push_back({a, b, c}); }
};

/// A triangle as a cycle of source vertices that starts with the smallest.
std::array<std::uint32_t, 3> cycle(std::array<std::uint32_t, 3> t) {
    std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
    return t;
}

/// The volume of a skin's box over that of the tight box around its posed vertices; 0 if a vertex
/// is outside.
double looseness(const osgSkin::DeformableSkin& skin) {
    osg::BoundingBoxd tight;
    for (const osg::Vec3& v :
         static_cast<const osg::Vec3Array&>(*skin.getDeformedGeometry()->getVertexArray()))
        tight.expandBy(v);
    const osg::BoundingBox& box = skin.getBoundingBox();
    if (!box.contains(tight._min) || !box.contains(tight._max)) return 0.0;
    const osg::Vec3d is = box._max - box._min;
    const osg::Vec3d least = tight._max - tight._min;
    return is.x() * is.y() * is.z() / (least.x() * least.y() * least.z());
}

class LoadedCharacter : public testing::TestWithParam<CharacterCase> {
protected:
    void SetUp() override {
        std::string why;
        if (!test::isAvailable(GetParam(), why)) GTEST_SKIP() << why;
        const std::string shapes = GetParam().shapes;
        osgSkin::LoadOptions options;
        options.shapes = shapes == "fast" ? osgSkin::BindOptions::Shapes::Fast
                                          : osgSkin::BindOptions::Shapes::None;
        character =
            osgSkin::loadCharacter(test::skinFile(GetParam(), test::makeTestFolder()), options);
    }

    void setFrame(std::size_t frame) { character.pose(character.motions.front(), frame); }

    osg::Vec3d joint(const std::string& name) const {
        osgAnimation::BoneMapVisitor visitor;
        character.skeleton->accept(visitor);
        return visitor.getBoneMap().at(name)->getMatrixInSkeletonSpace().getTrans();
    }

    double height() const {
        double low = 1e30, high = -1e30;
        for (const glm::dvec3& p : character.body.mesh.positions) {
            low = std::min(low, p.y);
            high = std::max(high, p.y);
        }
        return high - low;
    }

    Character character;
};

} // namespace

TEST_P(LoadedCharacter, SeamsStayClosedInEveryFrame) {
    double gap = 0.0;
    std::size_t seamVertices = 0;
    for (std::size_t frame = 0; frame < character.motions.front().clip.frames; ++frame) {
        setFrame(frame);
        std::map<std::uint32_t, osg::Vec3d> first;
        seamVertices = 0;
        test::forEachCopy(character, [&](std::uint32_t vertex, const osg::Vec3d& place) {
            const auto inserted = first.emplace(vertex, place);
            if (inserted.second) return;
            ++seamVertices;
            gap = std::max(gap, (place - inserted.first->second).length());
        });
    }
    EXPECT_GT(seamVertices, 20u); // five seams
    EXPECT_LE(gap, 1e-5 * height());
}

TEST_P(LoadedCharacter, PartsHoldEveryFaceOnce) {
    ASSERT_EQ(character.skin.skins.size(), 1u);
    EXPECT_EQ(character.skin.rigids.size(), 1u); // the head: the motions move thumbs and toes
    std::multiset<std::array<std::uint32_t, 3>> drawn;
    std::set<std::uint32_t> vertices;
    const auto collect = [&](const osgSkin::MeshPart& part) {
        osg::TriangleIndexFunctor<Triangles> triangles;
        part.geometry->accept(triangles);
        for (const auto& t : triangles.all)
            drawn.insert(
                cycle({part.sourceVertex[t[0]], part.sourceVertex[t[1]], part.sourceVertex[t[2]]}));
        vertices.insert(part.sourceVertex.begin(), part.sourceVertex.end());
    };
    for (const auto& skin : character.skin.skins) collect(skin.part);
    for (const auto& rigid : character.skin.rigids) collect(rigid.part);

    std::multiset<std::array<std::uint32_t, 3>> input;
    const auto triangles = character.body.mesh.triangles();
    for (std::size_t c = 0; c < triangles.size(); c += 3)
        input.insert(cycle({triangles[c], triangles[c + 1], triangles[c + 2]}));
    EXPECT_EQ(drawn, input);
    EXPECT_EQ(vertices.size(), character.body.mesh.positions.size());
}

TEST_P(LoadedCharacter, RigidPartsAreMostOfHeadHandsAndFeet) {
    for (const auto& rigid : character.skin.rigids)
        EXPECT_GE(rigid.part.sourceFace.size(), 100u) << rigid.node->getName();
}

TEST_P(LoadedCharacter, FeetAreOnTheFloorOfTheRestPose) {
    double floor = 1e30;
    for (const glm::dvec3& p : character.body.mesh.positions) floor = std::min(floor, p.y);
    const std::size_t frames = character.motions.front().clip.frames;
    for (std::size_t frame = 0; frame < frames; frame += std::max<std::size_t>(1, frames / 50)) {
        setFrame(frame);
        double lowest = 1e30;
        test::forEachCopy(character, [&](std::uint32_t, const osg::Vec3d& place) {
            lowest = std::min(lowest, place.y());
        });
        EXPECT_NEAR(lowest, floor, 0.03 * height()) << "frame " << frame;
    }
}

TEST_P(LoadedCharacter, ArmsAreWhereTheMotionHasThem) {
    const std::string name = GetParam().name;
    const bool pitch = name.find("pitch") != std::string::npos;
    const bool walk = name.find("walk") != std::string::npos;
    const std::size_t frames = character.motions.front().clip.frames;
    bool above = false;
    for (std::size_t frame = 0; frame < frames; frame += pitch ? 1 : 10) {
        setFrame(frame);
        for (const char* side : {"Left", "Right"}) {
            const osg::Vec3d hand = joint(side + std::string("Hand"));
            const osg::Vec3d shoulder = joint(side + std::string("Arm"));
            if (hand.y() > shoulder.y()) above = true;
        }
    }
    EXPECT_EQ(above, !walk); // a pitcher's hand rises above the shoulder, a walker's does not
}

TEST_P(LoadedCharacter, BoundsHoldTheSkinTightlyInEveryFrame) {
    const auto& skin = *character.skin.skins.front().drawable;
    const std::size_t frames = character.motions.front().clip.frames;
    double loosest = 0.0, mean = 0.0; // volume over the tight box's
    for (std::size_t frame = 0; frame < frames; ++frame) {
        setFrame(frame);
        const double ratio = looseness(skin);
        ASSERT_GT(ratio, 0.0) << frame;
        loosest = std::max(loosest, ratio);
        mean += ratio / static_cast<double>(frames);
    }
    RecordProperty("loosest", std::to_string(loosest));
    RecordProperty("mean", std::to_string(mean));
    EXPECT_LE(mean, 1.9);
    EXPECT_LE(loosest, 2.6);
}

TEST_P(LoadedCharacter, BakedBoundsHoldTheSkinBetweenSamples) {
    const auto copies = osgSkin::ClipCharacter::create(*character.root);
    const auto clip = copies->sample(*copies->animations().front(), 30.0);
    copies->bake(clip);
    const auto copy = copies->makeInstance();
    auto* const place = copy.node->getChild(0)->asGroup();
    const auto& skin = dynamic_cast<const osgSkin::DeformableSkin&>(*place->getChild(0));
    constexpr int kTimes = 500; // at uneven steps
    double mean = 0.0;
    for (int i = 0; i < kTimes; ++i) {
        copy.player->setLayer(0, {clip, std::fmod(0.618034 * i, 1.0) * clip->duration()});
        ASSERT_TRUE(copy.player->pose());
        const double ratio = looseness(skin);
        ASSERT_GT(ratio, 0.0) << i;
        mean += ratio / kTimes;
    }
    RecordProperty("mean", std::to_string(mean));
    EXPECT_LE(mean, 1.9);
}

INSTANTIATE_TEST_SUITE_P(Characters, LoadedCharacter, testing::ValuesIn(test::characterCases()),
                         [](const auto& c) { return std::string(c.param.name); });

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

TEST_P(BadInput, BakeExitsWithOneAndOneLine) {
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

using osgSkin::Character;

namespace {

/// Compares the bend ratios of the joint "arm" with the file's function of a vertex's height.
void expectBend(const Character& character, const std::function<double(double)>& expected) {
    const osgSkin::Binding& binding = character.binding;
    ASSERT_EQ(binding.vertexCount(), character.body.mesh.positions.size());
    for (std::size_t v = 0; v < binding.vertexCount(); ++v) {
        const double height = character.body.mesh.positions[v].y;
        float arm = 0.0f;
        for (std::uint32_t i = binding.firstInfluence[v]; i < binding.firstInfluence[v + 1]; ++i)
            if (binding.influences[i].joint == 1) arm = binding.influences[i].bend;
        EXPECT_NEAR(arm, static_cast<float>(expected(height)), 1e-4f)
            << "vertex " << v << " at " << height;
    }
}

} // namespace

TEST(BindMethod, WeightsGivesTheRatiosOfTheFile) {
    expectBend(osgSkin::loadCharacter(OSGSKIN_TEST_DATA "/character/painted.skin"),
               [](double height) { return std::clamp(height - 1.5, 0.0, 1.0); });
}

TEST(BindMethod, WeightsAreReported) {
    const Character character = osgSkin::loadCharacter(OSGSKIN_TEST_DATA "/character/painted.skin");
    EXPECT_EQ(character.bindReport.vertices, 56u);
    EXPECT_EQ(character.bindReport.regions.size(), 2u);
    EXPECT_TRUE(character.bindReport.notes.empty()) << character.bindReport.text();
}

TEST(BindMethod, WeightsMayBeTheMeshsOwn) {
    const Character character =
        osgSkin::loadCharacter(OSGSKIN_TEST_DATA "/character/mesh_weights.skin");
    const osgSkin::Binding& binding = character.binding;
    ASSERT_EQ(binding.vertexCount(), 36u);
    for (std::size_t v = 0; v < binding.vertexCount(); ++v) {
        const double height =
            2.0 * character.body.mesh.positions[v].z; // the file's armature halves
        const osgSkin::Influence* last = &binding.influences[binding.firstInfluence[v + 1] - 1];
        const float arm = last->joint == 1 ? last->bend : 0.0f;
        EXPECT_NEAR(arm, std::clamp(height - 1.5, 0.0, 1.0), 1e-5) << "vertex " << v;
    }
}

/// An artist's weights are the default; every other method is one word away.
TEST(BindMethod, WeightsAreTheDefaultWhereTheMeshHasGoodOnes) {
    const std::string folder = test::makeTestFolder();
    const std::string painted = test::GltfColumn().save("default_painted.gltf");
    const auto load = [&](const std::string& members, const std::string& options = {}) {
        std::ofstream(folder + "/column.skin")
            << R"({"osgskin": 1, "mesh": ")" << painted << '"' << members << "}";
        return osgSkin::loadCharacter(folder + "/column.skin", test::loadOptions(options));
    };
    EXPECT_TRUE(load("").bindReport.boundaries.empty());
    EXPECT_NE(load("").bindReport.text().find("bound by painted weights\n"), std::string::npos);
    EXPECT_TRUE(load(R"(, "shapes": "fast", "rigid": [])").bindReport.boundaries.empty());
    EXPECT_FALSE(load(R"(, "bind": "smooth")").bindReport.boundaries.empty());
    EXPECT_FALSE(load("", "bind=smooth").bindReport.boundaries.empty());
    EXPECT_TRUE(load(R"(, "bind": "smooth")", "bind=weights").bindReport.boundaries.empty());
    EXPECT_FALSE(load(R"(, "bind": "paper")").bindReport.boundaries.empty());
    // Regions have boundaries, weights have none.
    EXPECT_FALSE(load(R"(, "joints": {"top": {"skip": true}})").bindReport.boundaries.empty());
    for (const auto& [members, summary] :
         {std::pair("", "bound by painted weights\n"),
          {R"(, "bind": "smooth")", "bound by regions of the skin\n"}}) {
        load(members);
        const std::string said = test::runBake("column.skin --rest rest.obj", folder).err;
        EXPECT_NE(said.find(summary), std::string::npos) << said;
    }
    const test::Notices notices;
    const Character other = load(R"(, "skeleton": ")" OSGSKIN_TEST_DATA "/character/rig.bvh\"");
    EXPECT_FALSE(other.bindReport.boundaries.empty());
    EXPECT_TRUE(notices.say("default_painted.gltf: its weights are for bones that the skeleton "
                            "does not have, the body is bound by regions"))
        << notices.text();
}

/// A shell without weights, as a gun beside painted arms, takes those of the nearest vertex that
/// has some. A shell that is painted in part is not well painted.
TEST(BindMethod, ShellsWithoutWeightsLeaveTheOthersTheirs) {
    for (const std::size_t bare : {8u, 4u}) {
        test::GltfColumn column; // three boxes of eight vertices
        std::vector<double> weights;
        for (std::size_t v = 0; v < 24; ++v)
            weights.insert(weights.end(), {v + bare < 24 ? 1.0 : 0.0, 0.0, 0.0, 0.0});
        column.attributes()["WEIGHTS_0"] = column.accessor("VEC4", weights);
        const std::string file = column.save("bare" + std::to_string(bare) + ".gltf");
        const test::Notices notices;
        const Character character = osgSkin::loadCharacter(file);
        EXPECT_EQ(character.bindReport.boundaries.empty(), bare == 8) << bare;
        EXPECT_TRUE(notices.say(std::to_string(bare) + " of 24 vertices have no weights"))
            << notices.text();
    }
}

TEST(BindMethod, WeightsAreThoseOfAFileWithoutAWord) {
    const std::string folder = test::makeTestFolder(), data = OSGSKIN_TEST_DATA "/character/";
    std::ofstream(folder + "/painted.skin")
        << R"({"osgskin": 1, "mesh": ")" << data << R"(body.obj", "skeleton": ")" << data
        << R"(rig.bvh", "weights": ")" << data << R"(weights.json"})";
    expectBend(osgSkin::loadCharacter(folder + "/painted.skin"),
               [](double height) { return std::clamp(height - 1.5, 0.0, 1.0); });
}

TEST(BindMethod, PaperGivesEquation5BetweenTheFilesBoundaries) {
    expectBend(osgSkin::loadCharacter(OSGSKIN_TEST_DATA "/character/printed.skin"),
               [](double height) {
                   const double t = std::clamp((height - 1.0) / 2.0, 0.0, 1.0);
                   return t * t * (3.0 - 2.0 * t);
               });
}

namespace {

using osgSkin::Character;
using test::GltfColumn;

/// A column with clips "Armature|still", "Armature|bow" and "twist", which rotate by 0, 30 and 60
/// degrees.
std::string movesFile() {
    GltfColumn column;
    double angle = 0.0;
    for (const char* name : {"Armature|still", "Armature|bow", "twist"}) {
        column.animate(name, column.joints[1], "rotation", {0.0, 1.0},
                       GltfColumn::turns({angle, angle}));
        angle += 30.0;
    }
    return column.save("moves.gltf");
}

/// A .skin file over the column itself.
std::string skinFile(const std::string& motions) {
    std::string path = testing::TempDir() + "choice.skin";
    std::ofstream(path) << R"({"osgskin": 1, "mesh": "moves.gltf", "rigid": [], "motions": [)"
                        << motions << "]}";
    return path;
}

double angleOf(const osgSkin::CharacterMotion& motion, const Character& character) {
    const int joint = character.rest.find("middle");
    const glm::dquat& q = motion.clip.rotations.at(std::size_t(joint));
    return 2.0 * std::atan2(std::abs(q.x), q.w) * 57.29577951308232;
}

} // namespace

TEST(ClipChoice, InASkinFile) {
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
    EXPECT_NE(why.find(R"(no clip "fly", expected one of 0 "Armature|still", 1 "Armature|bow", 2)"),
              std::string::npos)
        << why;
    EXPECT_NE(test::whyRefused(skinFile(R"({"file": "moves.gltf", "clip": true})"))
                  .find("motions[0].clip"),
              std::string::npos);
}

/// A clip that moves only the face keeps its number, and is not the first one.
TEST(ClipChoice, NumbersAreTheFiles) {
    GltfColumn column;
    for (const char* name : {"blink", "walk", "run"})
        column.animate(name, column.joints[1], "rotation", {0.0, 1.0},
                       GltfColumn::turns({name[0] == 'r' ? 60.0 : 30.0, 60.0}));
    column.json["animations"][0]["channels"][0]["target"]["path"] = "weights";
    column.save("blinks.gltf");
    const auto skin = [](const std::string& clip) {
        std::string path = testing::TempDir() + "blinks.skin";
        std::ofstream(path) << R"({"osgskin": 1, "mesh": "blinks.gltf", "rigid": [], "motions": [)"
                            << R"({"file": "blinks.gltf")" << clip << "}]}";
        return path;
    };
    for (const auto& [clip, angle] :
         {std::pair("", 30), std::pair(R"(, "clip": 1)", 30), std::pair(R"(, "clip": 2)", 60)}) {
        const Character character = osgSkin::loadCharacter(skin(clip));
        ASSERT_EQ(character.motions.size(), 1u);
        EXPECT_NEAR(angleOf(character.motions[0], character), angle, 0.01) << clip;
    }
    EXPECT_NE(test::whyRefused(skin(R"(, "clip": 0)")).find("clip \"blink\" moves no joint"),
              std::string::npos);
}

TEST(ClipChoice, InOptions) {
    const std::string moves = movesFile();
    const std::string skin = skinFile("");
    for (const auto& [wanted, angle] : {std::pair<std::string, double>{"bow", 30},
                                        {"Armature|bow", 30},
                                        {"2", 60},
                                        {"twist", 60}}) {
        osgSkin::LoadOptions options;
        options.motion = moves + "#" + wanted;
        const Character character = osgSkin::loadCharacter(skin, options);
        ASSERT_EQ(character.motions.size(), 1u);
        EXPECT_EQ(character.motions[0].name(), wanted);
        EXPECT_NEAR(angleOf(character.motions[0], character), angle, 0.01) << wanted;
    }
    const std::string why = test::whyRefused(skin, test::loadOptions("motion=" + moves + "#fly"));
    EXPECT_NE(why.find(R"(no clip "fly")"), std::string::npos) << why;
    EXPECT_NE(test::whyRefused(skin, test::loadOptions("motion=nowhere.gltf#bow")).find("neither"),
              std::string::npos);
    // For a rigged model's own clips, the part after the bar is enough.
    osgSkin::LoadOptions own;
    own.motion = "bow";
    EXPECT_EQ(osgSkin::loadCharacter(moves, own).motions.front().name(), "Armature|bow");
}

namespace {

/// The thrower's skeleton laid down, with its trunk along +z, and one frame of it.
std::string laidDown() {
    std::istringstream in(test::fileText(OSGSKIN_DATA "/thrower.bvh"));
    std::ostringstream out;
    std::size_t channels = 0;
    for (std::string line; std::getline(in, line) && line.find("MOTION") == std::string::npos;) {
        std::istringstream words(line);
        std::string word;
        double x = 0.0, y = 0.0, z = 0.0;
        if (words >> word && word == "OFFSET" && words >> x >> y >> z)
            out << "OFFSET " << x << " " << -z << " " << y << "\n";
        else if (word == "CHANNELS" && channels++ == 0)
            out << "CHANNELS 6 Xposition Yposition Zposition Zrotation Yrotation Xrotation\n";
        else
            out << line << "\n";
    }
    out << "MOTION\nFrames: 1\nFrame Time: 0.04\n0 0 0";
    for (std::size_t i = 0; i < 3 * channels; ++i) out << " 0";
    return test::saveText("laid_down.bvh", out.str() + "\n");
}

/// How far the head is above the hips, in the first frame.
double headHeight(const std::string& skinMembers, const std::string& motionMembers) {
    const std::string file = test::saveText(
        "laid_down.skin", R"({"osgskin": 1, "mesh": ")" OSGSKIN_DATA
                          R"(/thrower.obj", "skeleton": ")" OSGSKIN_DATA R"(/thrower.bvh")" +
                              skinMembers + R"(, "shapes": "none", "motions": [{"file": ")" +
                              laidDown() + "\"" + motionMembers + "}]}");
    const osgSkin::Character character = osgSkin::loadCharacter(file);
    const osgSkin::Clip& clip = character.motions.front().clip;
    std::vector<glm::dquat> rotations;
    std::vector<glm::dvec3> centres;
    osgSkin::worldRotations(character.rest, clip.rotations.data(), rotations);
    osgSkin::worldPositions(character.rest, rotations, clip.rootPositions.front(), centres);
    return centres[std::size_t(character.rest.find("Head"))].y -
           centres[std::size_t(character.rest.find("Hips"))].y;
}

} // namespace

TEST(MotionUp, FileAndMotionSayWhetherAnActorLies) {
    EXPECT_GT(headHeight("", ""), 0.5) << "nothing is known of a floor";
    EXPECT_LT(headHeight(R"(, "up": "y")", ""), 0.1);
    EXPECT_LT(headHeight("", R"(, "up": "y")"), 0.1);
    EXPECT_GT(headHeight("", R"(, "up": "z")"), 0.5);
    EXPECT_GT(headHeight(R"(, "up": "y")", R"(, "up": "z")"), 0.5) << "the motion's goes first";
}
