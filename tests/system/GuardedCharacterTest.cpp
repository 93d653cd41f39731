// SPDX-License-Identifier: MIT
// Characters whose files name each other, need too many resources, or cannot be written completely.
#include "Command.h"
#include "ExpectContains.h"
#include "GltfBuilder.h"
#include "Notices.h"
#include "SkinFiles.h"
#include "WhyRefused.h"

#include <osgSkin/Error>
#include <osgSkinCharacter/LoadCharacter>
#include <osgSkinImport/ReadScene>

#include <osgDB/WriteFile>

#include <gtest/gtest.h>

#include <cmath>
#include <ctime>
#include <filesystem>
#include <fstream>

#include <sys/stat.h>

namespace {

namespace fs = std::filesystem;

#if defined(__SANITIZE_ADDRESS__) || !defined(NDEBUG) // also slow at counting lines
constexpr double kSlower = 5.0;
#else
constexpr double kSlower = 1.0;
#endif

using test::expectContains;
using test::kTubeFolder;
using test::whyRefused;

/// Writes a `.skin` file into `folder`; `members` follow the version.
std::string skin(const std::string& folder, const std::string& name, const std::string& members) {
    std::string path = folder + "/" + name + ".skin";
    std::ofstream(path) << "{\"osgskin\": 1, " << members << "}";
    return path;
}

std::string parts(const std::string& mesh, const std::string& skeleton) {
    return "\"mesh\": \"" + mesh + "\", \"skeleton\": \"" + skeleton + "\"";
}

/// A valid rigged triangle, to be broken.
test::GltfBuilder triangle() {
    test::GltfBuilder file;
    const std::size_t joint = file.node({{"name", "joint"}});
    const nlohmann::json attributes = {
        {"POSITION", file.accessor("VEC3", {0, 0, 0, 1, 0, 0, 0, 1, 0})},
        {"JOINTS_0", file.accessor("VEC4", std::vector<double>(12, 0), 5121)},
        {"WEIGHTS_0", file.accessor("VEC4", {1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0})}};
    const std::size_t indices = file.accessor("SCALAR", {0, 1, 2}, 5123);
    file.json["meshes"] = {{{"primitives", {{{"attributes", attributes}, {"indices", indices}}}}}};
    file.json["skins"] = {{{"joints", {joint}}}};
    const std::size_t shown = file.node({{"mesh", 0}, {"skin", 0}});
    file.json["scenes"][0]["nodes"] = {joint, shown};
    return file;
}

} // namespace

TEST(GuardedCharacter, RejectsFilesThatIncludeThemselves) {
    const std::string folder = test::makeTestFolder();
    const std::string rig = kTubeFolder + "rig.bvh", body = kTubeFolder + "body.obj";
    const std::string itself = "includes itself", noMesh = "a character, expected a mesh";
    expectContains(whyRefused(skin(folder, "mesh", parts("mesh.skin", rig))), noMesh);
    expectContains(whyRefused(skin(folder, "bones", parts(body, "bones.skin"))), itself);
    expectContains(whyRefused(skin(folder, "twice", parts("twice.skin.skin", rig))), noMesh);
    // The other plug-in does not report the reason.
    EXPECT_NE(whyRefused(skin(folder, "scaled", parts("scaled.skin.2.scale", rig))), "read");
    skin(folder, "b", parts(body, "a.skin"));
    expectContains(whyRefused(skin(folder, "a", parts(body, "b.skin"))), itself);
    expectContains(
        whyRefused(skin(folder, "prop",
                        parts(body, rig) + ", \"motions\": [{\"file\": \"" + kTubeFolder +
                            "move.bvh\", \"name\": \"m\"}], \"props\": [{\"mesh\": "
                            "\"prop.skin\", \"motion\": \"m\", \"file\": \"" +
                            kTubeFolder + "move.bvh\"}]")),
        noMesh);
    for (int k = 0; k < 20; ++k)
        skin(folder, "c" + std::to_string(k), parts(body, "c" + std::to_string(k + 1) + ".skin"));
    expectContains(whyRefused(folder + "/c0.skin"), "nested more than 8 deep");
    skin(folder, "c8", parts(body, rig));
    expectContains(whyRefused(folder + "/c0.skin"), "nested more than 8 deep");
    EXPECT_EQ(whyRefused(folder + "/c1.skin"), "read");
    // A refused file is closed again.
    EXPECT_EQ(whyRefused(kTubeFolder + "good.skin"), "read");
    EXPECT_EQ(whyRefused(kTubeFolder + "good.skin"), "read");
}

TEST(GuardedCharacter, RejectsMalformedSkinFilesWithLineAndColumn) {
    const std::string folder = test::makeTestFolder();
    const std::string whole = parts(kTubeFolder + "body.obj", kTubeFolder + "rig.bvh");
    const auto written = [&](const std::string& text) {
        std::ofstream(folder + "/x.skin") << text;
        return whyRefused(folder + "/x.skin");
    };
    expectContains(written("{\"osgskin\": 1,\n \"up\": 1e999}"), "x.skin: line 2, column 8: 1e999");
    expectContains(written("{\"mesh\": " + std::string(100'000, '[')), "x.skin: ");
    expectContains(written("{\"mesh\": " + std::string(100, '[') + std::string(100, ']') + "}"),
                   "more than 64 deep");
    EXPECT_EQ(
        written("{\"osgskin\": 1, " + whole + ", \"joints\": {\"\\u001b[31m\": 3}}").find('\x1b'),
        std::string::npos);
    ASSERT_EQ(mkfifo((folder + "/pipe").c_str(), 0600), 0);
    fs::create_symlink(folder + "/pipe", folder + "/linked.skin");
    expectContains(whyRefused(folder + "/linked.skin"), "linked.skin: cannot open: not a regular");
    expectContains(
        whyRefused(skin(folder, "w", whole + ", \"bind\": \"weights\", \"weights\": \"pipe\"")),
        "pipe: cannot open: not a regular");
    expectContains(whyRefused(kTubeFolder + "good.skin", "formats=skin,glb"),
                   "\"obj\" is not allowed");
    expectContains(whyRefused(kTubeFolder + "good.skin", "formats=glb"), "\"skin\" is not allowed");
    EXPECT_EQ(whyRefused(kTubeFolder + "good.skin", "formats=skin,obj,bvh"), "read");
    EXPECT_EQ(whyRefused(kTubeFolder + "good.skin", "formats=all"), "read");
}

/// OpenSceneGraph trusts these files.
TEST(GuardedCharacter, ReadsSavedScenesOnlyWithOptionFormats) {
    const std::string folder = test::makeTestFolder(), rig = kTubeFolder + "rig.bvh";
    for (const char* format :
         {"osgb", "osgt", "osgx", "osg", "ive", "OSGB", "osgb.2,0.5,1.scale"}) {
        const std::string file = skin(folder, "saved", parts(std::string("body.") + format, rig));
        expectContains(whyRefused(file),
                       "is for trusted files; to trust it, name its format in the "
                       "option formats (-O \"formats=skin,");
        expectContains(whyRefused(file, "formats=skin,bvh"), "is for trusted files");
        expectContains(whyRefused(file, "formats=all"), "body.");
        EXPECT_EQ(whyRefused(file, "formats=all").find("trusted"), std::string::npos);
    }
    const osg::ref_ptr<osg::Node> body =
        osgSkin::readScene(kTubeFolder + "body.obj", new osgDB::Options("noRotation"));
    ASSERT_TRUE(osgDB::writeNodeFile(*body, folder + "/body.osgt"));
    const std::string file = skin(folder, "saved", parts("body.osgt", rig));
    EXPECT_EQ(whyRefused(file, "formats=skin,osgt,bvh"), "read");
    expectContains(whyRefused(skin(folder, "bones", parts(kTubeFolder + "body.obj", "rig.osgt"))),
                   "rig.osgt: OpenSceneGraph's own reader");
}

TEST(GuardedCharacter, AcceptsLongSkinFilesAndBracketsInNames) {
    const std::string folder = test::makeTestFolder();
    std::string joints;
    for (int i = 0; i < 100'000; ++i)
        joints += (i == 0 ? "\"" : ", \"") + std::to_string(i) + "\": {\"skip\": true}";
    const std::string both = parts(kTubeFolder + "body.obj", kTubeFolder + "rig.bvh");
    expectContains(whyRefused(skin(folder, "long", both + ", \"joints\": {" + joints + "}")),
                   "\"0\" is not in the skeleton");
    const std::string brackets = "\\\"" + std::string(100, '[') + "\\\\";
    EXPECT_EQ(whyRefused(skin(folder, "brackets",
                              both + ", \"motions\": [{\"file\": \"" + kTubeFolder +
                                  "move.bvh\", \"name\": \"" + brackets + "\"}]")),
              "read");
}

TEST(GuardedCharacter, LimitsLengthOfNames) {
    const std::string folder = test::makeTestFolder();
    const std::string many(500'000, 'n');
    const std::string mesh = "\"mesh\": \"" + kTubeFolder + "body.obj\", ";
    for (const std::string& members :
         {parts(many, "rig.bvh"), mesh + "\"motions\": [{\"file\": \"" + many + "\"}]"}) {
        const std::string refused = whyRefused(skin(folder, "long", members));
        expectContains(refused, "a name of 500000 bytes, expected at most 4096");
        EXPECT_LT(refused.size(), 1000u);
    }
    expectContains(whyRefused(skin(folder, "zero", parts("tube.gltf\\u0000", "rig.bvh"))),
                   "zero.skin: mesh: the file's name contains a zero byte");
    for (const std::string& members :
         {mesh + "\"bind\": \"" + many + '"', mesh + "\"joints\": {\"" + many + "\": 1}"})
        EXPECT_LT(whyRefused(skin(folder, "quoted", members)).size(), 1500u);
}

TEST(GuardedCharacter, RejectsLandmarksOutsideTheBody) {
    const std::string folder = test::makeTestFolder();
    for (const char* place : {"1e30", "-1e6", "-1e9"})
        expectContains(whyRefused(skin(folder, "fit",
                                       "\"mesh\": \"" OSGSKIN_DATA "/thrower.obj\", \"skeleton\": "
                                       "{\"fit\": true, \"landmarks\": {\"LeftHand\": [" +
                                           std::string(place) + ", 0, 0]}}")),
                       "landmark LeftHand: expected a point in the body");
}

TEST(GuardedCharacter, LimitsSamplesByFileSize) {
    const std::string folder = test::makeTestFolder();
    std::ofstream rig(folder + "/rig.bvh"), motion(folder + "/motion.bvh");
    const std::string root = "HIERARCHY\nROOT r\n{\nOFFSET 0 0 0\nCHANNELS 1 Xrotation\n";
    rig << root;
    for (int j = 0; j < 300; ++j) rig << "JOINT j" << j << "\n{\nOFFSET 0 1 0\n}\n";
    rig << "}\nMOTION\nFrames: 1\nFrame Time: 1\n0\n";
    motion << root << "}\nMOTION\nFrames: 3000\nFrame Time: 1\n";
    for (int f = 0; f < 3000; ++f) motion << "0\n";
    rig.close();
    motion.close();
    const std::string wide = skin(folder, "wide",
                                  parts(kTubeFolder + "body.obj", "rig.bvh") +
                                      ", \"motions\": [{\"file\": \"motion.bvh\"}]");
    expectContains(whyRefused(wide), "3000 frames for 301 joints");
    const std::size_t just =
        std::size_t(301 * 3000) - std::filesystem::file_size(folder + "/motion.bvh") / 2;
    EXPECT_EQ(whyRefused(wide, "maxSamples=" + std::to_string(just)), "read");
    expectContains(
        whyRefused(wide, "maxSamples=" + std::to_string(just - 1)),
        "3000 frames for 301 joints, expected at most 902999 rotations (option maxSamples)");
}

TEST(GuardedCharacter, LimitsUsesOfOneFile) {
    const std::string folder = test::makeTestFolder();
    std::string motions, props;
    for (int i = 0; i <= 100; ++i) {
        const std::string comma = i == 0 ? "" : ", ", number = std::to_string(i);
        const std::string path = kTubeFolder + std::string(i % 3 == 0 ? "" : "./") + "move.bvh";
        motions += comma + "{\"file\": \"" + path + "\", \"name\": \"m" + number + "\"}";
        props += comma + "{\"mesh\": \"" + kTubeFolder + "body.obj\", \"motion\": \"m0\", " +
                 "\"file\": \"" + folder + "/" + number + ".bvh\"}";
    }
    const std::string both = parts(kTubeFolder + "body.obj", kTubeFolder + "rig.bvh");
    const std::string often = skin(folder, "often", both + ", \"motions\": [" + motions + "]");
    expectContains(whyRefused(often), "motions[100]");
    expectContains(whyRefused(often), "is used more than 100 times (option maxUses)");
    EXPECT_EQ(whyRefused(often, "maxUses=101"), "read");
    const std::string one = motions.substr(0, motions.find('}') + 1);
    expectContains(
        whyRefused(skin(folder, "props",
                        both + ", \"motions\": [" + one + "], \"props\": [" + props + "]")),
        "props[100]");
}

/// A short file took gigabytes if it was named often.
TEST(GuardedCharacter, LimitsSamplesOfAllMotionsTogether) {
    const std::string folder = test::makeTestFolder();
    std::ofstream file(folder + "/long.bvh");
    file << "HIERARCHY\nROOT root\n{\nOFFSET 0 0 0\nCHANNELS 1 Xrotation\n";
    for (int j = 1; j < 100; ++j) file << "JOINT j" << j << "\n{\nOFFSET 0 1 0\n}\n";
    file << "}\nMOTION\nFrames: 3000\nFrame Time: 1\n";
    for (int f = 0; f < 3000; ++f) file << "0\n";
    file.close();
    const auto named = [&](int motions, int props) {
        std::string text =
            parts(kTubeFolder + "body.obj", kTubeFolder + "rig.bvh") + ", \"joints\": {}";
        for (int i = 0; i < motions; ++i)
            text += (i == 0 ? ", \"motions\": [" : ", ") +
                    std::string("{\"file\": \"long.bvh\", \"skipFrames\": 2990, ") +
                    "\"joints\": {\"arm\": \"root\"}, \"name\": \"m" + std::to_string(i) + "\"}";
        text += "]";
        for (int i = 0; i < props; ++i)
            text += (i == 0 ? ", \"props\": [" : ", ") + std::string("{\"mesh\": \"") +
                    kTubeFolder + "body.obj\", \"motion\": \"m0\", \"file\": \"./long.bvh\"}";
        return whyRefused(skin(folder, "often", text + (props > 0 ? "]" : "")));
    };
    EXPECT_EQ(named(1, 0), "read");
    const std::string beside =
        "3000 frames for 100 joints beside 300000 rotations of other motions";
    expectContains(named(2, 0), "long.bvh: " + beside + ", expected at most 50");
    expectContains(named(2, 0), " rotations (option maxSamples)");
    expectContains(named(1, 1), "long.bvh: " + beside);
}

TEST(GuardedCharacter, ZeroByteDoesNotEndSkinFiles) {
    const std::string folder = test::makeTestFolder(), file = folder + "/zero.skin";
    std::ofstream(file, std::ios::binary) << "{ \"osgskin\": 1 }\n" << '\0' << "\"a\": 1 } }\n";
    expectContains(whyRefused(file), "zero.skin: line 2, column 1: malformed JSON");
}

TEST(GuardedCharacter, RejectsDuplicateMembers) {
    const std::string folder = test::makeTestFolder();
    const std::string both = parts(kTubeFolder + "body.obj", kTubeFolder + "rig.bvh");
    expectContains(
        whyRefused(skin(folder, "again", both + ",\n \"up\": \"y\", \"up\": \"z\"")),
        "again.skin: line 2, column 13: \"up\" is there twice, expected each member once");
    expectContains(
        whyRefused(skin(folder, "spelt", both + ", \"up\": \"y\", \"\\u0075p\" : \"z\"")),
        "is there twice");
    expectContains(
        whyRefused(skin(folder, "deep",
                        both + ", \"joints\": {\"arm\": {\"skip\": true, \"skip\": false}}")),
        "\"skip\" is there twice");
    EXPECT_EQ(whyRefused(skin(folder, "apart",
                              both + ", \"motions\": [{\"file\": \"" + kTubeFolder +
                                  "move.bvh\", \"name\": \"file\"}, {\"file\": \"" + kTubeFolder +
                                  "move.bvh\", \"name\": \"{\\\"file\"}]")),
              "read");
    std::ofstream(folder + "/w.json") << "{\"weights\": {\"arm\": [[0, 1]], \"arm\": [[1, 1]]}}";
    expectContains(
        whyRefused(skin(folder, "w", both + ", \"bind\": \"weights\", \"weights\": \"w.json\"")),
        "w.json: line 1, column 31: \"arm\" is there twice");
}

TEST(GuardedCharacter, WarnsAboutVerticesWithoutWeights) {
    const std::string folder = test::makeTestFolder();
    std::ofstream(folder + "/w.json") << "{\"weights\": {\"arm\": [[0, 1]]}}";
    const test::Notices notices;
    const osgSkin::Character character =
        osgSkin::loadCharacter(skin(folder, "w",
                                    parts(kTubeFolder + "body.obj", kTubeFolder + "rig.bvh") +
                                        ", \"bind\": \"weights\", \"weights\": \"w.json\""));
    ASSERT_FALSE(character.notes.empty());
    expectContains(character.notes.front(), folder + "/w.json: 55 of 56 vertices have no weights");
    EXPECT_TRUE(notices.say("55 of 56 vertices"));
}

TEST(GuardedCharacter, LimitsJointsTimesVertices) {
    const std::string folder = test::makeTestFolder();
    const std::string file =
        skin(folder, "many", parts(kTubeFolder + "body.obj", kTubeFolder + "rig.bvh"));
    EXPECT_EQ(whyRefused(file), "read");
    expectContains(whyRefused(file, "maxRatios=10"),
                   "expected at most 10 if multiplied (option maxRatios)");
    expectContains(whyRefused(file, "maxRatios=10"), file);
}

/// A vertex follows every joint above it, hundreds in a deep chain: a small file took gigabytes.
TEST(GuardedCharacter, LimitsInfluences) {
    constexpr int kJoints = 900, kRings = 100, kSides = 40;
    const std::string folder = test::makeTestFolder();
    std::ofstream rig(folder + "/deep.bvh");
    rig << "HIERARCHY\nROOT j0\n{\nOFFSET 0 0 0\nCHANNELS 1 Zrotation\n";
    for (int j = 1; j < kJoints; ++j) rig << "JOINT j" << j << "\n{\nOFFSET 0 0.1 0\nCHANNELS 0\n";
    rig << "End Site\n{\nOFFSET 0 0.1 0\n}\n";
    for (int j = 0; j < kJoints; ++j) rig << "}\n";
    rig << "MOTION\nFrames: 1\nFrame Time: 0.1\n0\n";
    rig.close();
    std::ofstream body(folder + "/deep.obj");
    for (int ring = 0; ring < kRings; ++ring)
        for (int side = 0; side < kSides; ++side) {
            const double angle = 2.0 * 3.14159265 * side / kSides;
            body << "v " << 3.0 * std::cos(angle) << ' ' << 90.0 * ring / (kRings - 1) << ' '
                 << 3.0 * std::sin(angle) << '\n';
        }
    for (int ring = 0; ring + 1 < kRings; ++ring)
        for (int side = 0; side < kSides; ++side) {
            const int a = ring * kSides + side + 1, b = ring * kSides + (side + 1) % kSides + 1;
            body << "f " << a << ' ' << a + kSides << ' ' << b + kSides << ' ' << b << '\n';
        }
    body.close();
    const std::string file = skin(folder, "deep", parts("deep.obj", "deep.bvh"));
    const std::string refused = whyRefused(file);
    expectContains(refused, file + ": bind: 4000 vertices that follow chains of up to ");
    expectContains(refused, "expected at most 600000 (option maxInfluences)");
    EXPECT_EQ(whyRefused(file, "maxInfluences=4000000"), "read");
}

/// As many clips as fit in a megabyte; each was compared with all before it.
TEST(GuardedCharacter, LoadsTwentyThousandClipsInSeconds) {
    constexpr std::size_t kClips = 20'000;
    test::GltfBuilder file = triangle();
    const std::size_t times = file.accessor("SCALAR", {0, 1});
    const std::size_t turns = file.accessor("VEC4", {0, 0, 0, 1, 0, 0, 0.6, 0.8});
    const nlohmann::json clip = {
        {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "rotation"}}}}}},
        {"samplers", {{{"input", times}, {"output", turns}}}}};
    file.json["animations"] = nlohmann::json::array_t(kClips, clip);
    const std::clock_t begin = std::clock();
    const osgSkin::Character character = osgSkin::loadCharacter(file.save("clips.gltf"));
    EXPECT_EQ(character.motions.size(), kClips);
    EXPECT_EQ(character.manager->getAnimationList().size(), kClips);
    EXPECT_LT(double(std::clock() - begin) / CLOCKS_PER_SEC, 8.0 * kSlower);
}

/// Linking and looking for scales compared each joint's name with each channel's.
TEST(GuardedCharacter, LoadsNineThousandAnimatedJointsInSeconds) {
    constexpr std::size_t kJoints = 9'000;
    test::GltfBuilder file = triangle();
    const std::size_t times = file.accessor("SCALAR", {0, 1});
    const std::size_t places = file.accessor("VEC3", {0, 0, 0, 0, 1, 0});
    nlohmann::json& clip = file.json["animations"][0];
    clip["samplers"] = {{{"input", times}, {"output", places}}};
    for (std::size_t j = 0; j < kJoints; ++j) {
        const std::size_t node = file.json["nodes"].size();
        file.json["nodes"].push_back({{"name", "a joint with a long name " + std::to_string(j)}});
        file.json["nodes"][0]["children"].push_back(node);
        file.json["skins"][0]["joints"].push_back(node);
        clip["channels"].push_back(
            {{"sampler", 0}, {"target", {{"node", node}, {"path", "translation"}}}});
    }
    file.json["skins"][0].erase("inverseBindMatrices");
    const std::clock_t begin = std::clock();
    const osgSkin::Character character = osgSkin::loadCharacter(file.save("moved.gltf"));
    EXPECT_EQ(character.motions.size(), 1u);
    EXPECT_LT(double(std::clock() - begin) / CLOCKS_PER_SEC, 4.0 * kSlower);
}

TEST(GuardedCharacter, RejectsBrokenGltf) {
    struct Case {
        const char* place; ///< JSON pointer
        nlohmann::json value;
        const char* message;
    };
    const nlohmann::json huge = std::uint64_t(1) << 40;
    const Case cases[] = {
        {"/nodes/0/children", {0}, "recursive reference"},
        {"/nodes/0/children",
         {9},
         "nodes[0].children (one of nodes): expected a whole number below 2"},
        {"/nodes/1/mesh", 9, "nodes[1].mesh"},
        {"/nodes/1/skin", -1, "nodes[1].skin"},
        {"/nodes/0/translation", {1e39, 0, 0}, "nodes[0].translation: expected 3 numbers"},
        {"/nodes/0/scale", {1}, "nodes[0].scale: expected 3 numbers"},
        {"/skins/0/joints", {7}, "skins[0].joints"},
        {"/skins/0/joints", nlohmann::json::array(), "skins[0].joints: expected a list"},
        {"/meshes/0/primitives/0/attributes/POSITION", 9, "POSITION"},
        {"/meshes/0/primitives/0/attributes/POSITION", "0", "POSITION"},
        {"/meshes/0/primitives/0/indices", 0, "indices: expected an accessor of SCALAR"},
        {"/meshes/0/primitives/0/mode", 77, "mode: expected a whole number below 7"},
        {"/accessors/0/count", huge, "expected elements within the buffer view"},
        {"/accessors/0/byteOffset", huge, "expected elements within the buffer view"},
        {"/accessors/0/bufferView", 99, "expected an existing buffer view"},
        {"/accessors/0/type", "MAT4", "expected"},
        {"/accessors/0/componentType", 1, "expected a component type"},
        {"/accessors/2/count", 1, "expected 3 elements, as many as of POSITION"},
        {"/accessors/1/componentType", 5126, "expected"},
        {"/bufferViews/0/byteOffset", huge, "expected a buffer view within its buffer"},
        {"/bufferViews/0/byteLength", huge, "expected a buffer view within its buffer"},
        {"/bufferViews/0/byteStride", 1, "expected a stride of at least one element"},
        {"/buffers/0/uri", "data:application/octet-stream;base64,AAAA", "within its buffer"},
        {"/scenes/0/nodes", {0, 0}, "scenes[0].nodes"},
        {"/scene", 5, "scene (one of scenes)"},
        {"/animations",
         {{{"channels", {{{"sampler", 7}, {"target", {{"path", "scale"}}}}}},
           {"samplers", nlohmann::json::array()}}},
         "animations[0].channels.sampler"},
        {"/asset/version", "1.0", "not a glTF 2 file"},
    };
    EXPECT_EQ(whyRefused(triangle().save("triangle.gltf")), "read")
        << "without inverseBindMatrices";
    for (const Case& c : cases) {
        test::GltfBuilder file = triangle();
        file.save("broken.gltf"); // writes its buffer
        file.json[nlohmann::json::json_pointer(c.place)] = c.value;
        SCOPED_TRACE(c.place);
        expectContains(whyRefused(file.save("broken.gltf")), c.message);
    }
    // Zero vertices and joints.
    for (const char* named : {"indices", "attributes/JOINTS_0"}) {
        test::GltfBuilder file = triangle();
        file.save("nowhere.gltf");
        const std::string place = std::string("/meshes/0/primitives/0/") + named;
        const auto accessor = file.json.at(nlohmann::json::json_pointer(place)).get<std::size_t>();
        file.json["accessors"][accessor].erase("bufferView");
        expectContains(whyRefused(file.save("nowhere.gltf")), "expected a buffer view");
    }
    test::GltfBuilder deep = triangle();
    for (std::size_t n = 0; n < 1200; ++n)
        deep.node(n < 1199 ? nlohmann::json{{"children", {n + 3}}} : nlohmann::json::object());
    deep.json["nodes"][0]["children"] = {2};
    expectContains(whyRefused(deep.save("deep.gltf")),
                   "nested at most 1000 deep (option maxDepth)");
}

TEST(GuardedCharacter, BakeLeavesNoPartialFiles) {
    const std::string folder = test::makeTestFolder();
    const std::string good = "'" + kTubeFolder + "good.skin' --quiet ";
    const auto isEmpty = [&] {
        for (const auto& entry : fs::directory_iterator(folder))
            if (entry.path().extension() != ".txt") return false; // the command's output
        return true;
    };
    // The shell's limit on file size simulates a full disk.
    for (const char* out :
         {"--rest r.obj", "--out o.glb", "--out o.pc2", "--out f%d.ply", "--pose p.json"}) {
        const auto result =
            test::runCommand("trap '' XFSZ; ulimit -f 1; '" OSGSKIN_BAKE "' " + good + out, folder);
        EXPECT_EQ(result.status, 1) << out;
        test::expectContains(result.err, "cannot be written");
        EXPECT_TRUE(isEmpty()) << out;
    }
    EXPECT_EQ(test::runBake(good + "--rest /dev/full", folder).status, 1);
    EXPECT_EQ(test::runBake(good + "--rate nan", folder).status, 2);
    const auto frames =
        test::runBake(good + "--frames 1:2:18446744073709551615 --out f%d.ply", folder);
    EXPECT_EQ(frames.status, 0) << frames.err;
    EXPECT_TRUE(fs::exists(folder + "/f1.ply"));
    EXPECT_FALSE(fs::exists(folder + "/f2.ply"));
    EXPECT_FALSE(fs::exists(folder + "/f0.ply"));
}
