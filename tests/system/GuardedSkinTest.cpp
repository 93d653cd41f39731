// SPDX-License-Identifier: MIT
// `.skin` files and files of weights with more of something than anybody writes, and names that are
// no file, or a file that would be overwritten.
#include "Command.h"
#include "ExpectContains.h"
#include "GltfBuilder.h"
#include "Notices.h"
#include "SkinFiles.h"
#include "TextFile.h"
#include "WhyRefused.h"

#include <osgSkinCharacter/LoadCharacter>

#include <gtest/gtest.h>
#include <osgDB/ReadFile>

#include <algorithm>
#include <array>
#include <cmath>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <string>

namespace {

namespace fs = std::filesystem;

#if defined(__SANITIZE_ADDRESS__) || !defined(NDEBUG)
constexpr double kMaxSeconds = 40.0; ///< of this program's own time
#else
constexpr double kMaxSeconds = 8.0;
#endif

class GuardedSkin : public testing::Test {
public:
    GuardedSkin() : folder(test::makeTestFolder()) {
        for (const char* part : {"body.obj", "rig.bvh", "move.bvh"})
            fs::copy_file(test::kTubeFolder + part, folder + "/" + part);
    }
    ~GuardedSkin() override {
        EXPECT_LT(double(std::clock() - _begin) / CLOCKS_PER_SEC, kMaxSeconds);
    }

    std::string save(const std::string& name, const std::string& content) const {
        std::string path = folder + "/" + name;
        std::ofstream(path) << content;
        return path;
    }

    /// A `.skin` file; `members` follow the mesh.
    std::string skin(const std::string& members,
                     const std::string& skeleton = "\"rig.bvh\"") const {
        return save("a.skin", "{\"osgskin\": 1, \"mesh\": \"body.obj\", \"skeleton\": " + skeleton +
                                  ", " + members + "}");
    }

    /// A skeleton of `count` joints, "j0", "j1", ..., and a motion of one frame.
    std::string bones(const std::string& name, std::size_t count) const {
        std::string text = "HIERARCHY\nROOT j0\n{\nOFFSET 0 0 0\nCHANNELS 1 Xrotation\n";
        for (std::size_t j = 1; j < count; ++j)
            text += "JOINT j" + std::to_string(j) + "\n{\nOFFSET 0 " +
                    std::to_string(2.0 * double(j) / double(count)) + " 0\n}\n";
        save(name, text + "}\nMOTION\nFrames: 1\nFrame Time: 1\n0\n");
        return '"' + name + '"';
    }

    const std::string folder;

private:
    const std::clock_t _begin = std::clock();
};

void expectOneLine(const std::string& refused, const std::string& part) {
    EXPECT_NE(refused.find(part), std::string::npos) << '"' << part << "\" in: " << refused;
    EXPECT_EQ(refused.find('\n'), std::string::npos) << refused;
}

/// `count` comma-separated items, each made from its number.
template <typename Item>
std::string list(std::size_t count, const Item& item) {
    std::string text;
    for (std::size_t i = 0; i < count; ++i) text += (i > 0 ? "," : "") + item(std::to_string(i));
    return text;
}

} // namespace

TEST_F(GuardedSkin, LimitsRigidNames) {
    const auto last = [](const std::string&) { return std::string("\"j9999\""); };
    const std::string skeleton = bones("many.bvh", 10'000);
    EXPECT_EQ(test::whyRefused(skin("\"rigid\": [" + list(10'000, last) + "]", skeleton)), "read");
    expectOneLine(test::whyRefused(skin("\"rigid\": [" + list(10'001, last) + "]")),
                  "a.skin: rigid: 10001 names, expected at most 10000 (option maxJoints)");
}

TEST_F(GuardedSkin, LimitsFamiliesOfNames) {
    const auto family = [](const std::string& number) {
        return "\"f" + number +
               R"(": {"Hips": "a", "Head": "b", "LeftHand": "c", "LeftFoot": "d"})";
    };
    const std::string skeleton = bones("many.bvh", 5'000);
    EXPECT_EQ(test::whyRefused(skin("\"names\": {" + list(2'500, family) + "}", skeleton)), "read");
    expectOneLine(test::whyRefused(skin("\"names\": {" + list(2'501, family) + "}")),
                  "a.skin: names.f999.Head: one of more than 10000 names (option maxJoints)");
}

TEST_F(GuardedSkin, LimitsMusclesAndLandmarks) {
    const auto muscle = [](const std::string& number) {
        return "{\"name\": \"m" + number + "\", \"joint\": \"arm\"}";
    };
    expectOneLine(test::whyRefused(skin("\"muscles\": [" + list(1'001, muscle) + "]")),
                  "a.skin: muscles: 1001 muscles, expected at most 1000");
    const auto landmark = [](const std::string& number) {
        return "\"Left Hand " + number + "\": [0, 1, 0]";
    };
    expectOneLine(test::whyRefused(skin("\"up\": \"y\"", "{\"fit\": true, \"landmarks\": {" +
                                                             list(101, landmark) + "}}")),
                  "one of more than 100 landmarks");
}

TEST_F(GuardedSkin, LoadsMotionsOfManyJointsInSeconds) {
    const std::string skeleton = bones("many.bvh", 10'000);
    const auto motion = [&](const std::string& number) {
        return "{\"file\": " + skeleton + ", \"name\": \"" + number + "\"}";
    };
    EXPECT_EQ(test::whyRefused(skin("\"motions\": [" + list(14, motion) + "]", skeleton)), "read");
}

TEST_F(GuardedSkin, LimitsWarningsAboutUnknownMembers) {
    const test::Notices notices;
    EXPECT_EQ(test::whyRefused(skin(list(
                  20'000, [](const std::string& number) { return "\"x" + number + "\": 1"; }))),
              "read");
    EXPECT_EQ(notices.lines(), 11u);
    EXPECT_TRUE(notices.say("a.skin: 19990 more unknown members ignored"));
}

TEST_F(GuardedSkin, WarnsAboutUnknownMembers) {
    const test::Notices notices;
    EXPECT_EQ(test::whyRefused(skin(R"("motoins": [], "remark": "none")")), "read");
    EXPECT_TRUE(notices.say("motoins: unknown member ignored; did you mean \"motions\"?"));
    EXPECT_TRUE(notices.say("remark: unknown member ignored, expected one of \"osgskin\""))
        << notices.text();
}

TEST_F(GuardedSkin, RejectsMalformedWeights) {
    const auto refused = [&](const std::string& weights) {
        save("w.json", "{\"weights\": {" + weights + "}}");
        return test::whyRefused(skin(R"("bind": "weights", "weights": "w.json")"));
    };
    const auto zero = [](const std::string&) { return std::string("0"); };
    expectOneLine(refused("\"arm\": [[" + list(1'000'000, zero) + "]]"),
                  "expected a vertex and its weight, found a list of 1000000");
    expectOneLine(
        refused("\"arm\": [[3, 1], [4, 1], [3, 0.5]]"),
        "w.json: weights.arm[2][0]: vertex 3 is there twice, expected one weight for each");
    expectOneLine(refused("\"arm\": [[3, 1e308]], \"base\": [[3, 1e308]]"),
                  "weights of vertex 3: expected weights with a finite sum");
}

/// Vertices without weights are not to take those of others.
TEST_F(GuardedSkin, WarnsAboutVerticesWithoutWeights) {
    const struct {
        std::array<double, 3> weights; ///< of the vertices
        const char* warning;           ///< empty: none
    } cases[] = {
        {{1.0, 1.0, 1.0}, ""},
        {{0.0, 0.0, 0.0}, "no weight is above 0, the body is bound by regions"},
        {{1.0, 1.0, 0.0}, "1 of 3 vertices have no weights, the body is bound by regions"}};
    for (const auto& [w, warning] : cases) {
        test::GltfBuilder gltf;
        const std::size_t joint = gltf.node({{"name", "joint"}});
        const std::size_t other =
            gltf.node({{"name", "other"}, {"translation", {0.5, 0, 0}}, {"children", {joint}}});
        const nlohmann::json attributes = {
            {"POSITION", gltf.accessor("VEC3", {0, 0, 0, 1, 0, 0, 0, 1, 0})},
            {"JOINTS_0", gltf.accessor("VEC4", {0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0}, 5121)},
            {"WEIGHTS_0", gltf.accessor("VEC4", {w[0], 0, 0, 0, w[1], 0, 0, 0, w[2], 0, 0, 0})}};
        gltf.json["meshes"] = {{{"primitives", {{{"attributes", attributes}}}}}};
        gltf.json["skins"] = {{{"joints", {joint, other}}}};
        gltf.json["scenes"][0]["nodes"] = {other, gltf.node({{"mesh", 0}, {"skin", 0}})};
        const std::string file = gltf.save("unweighted.gltf");
        const test::Notices notices;
        EXPECT_EQ(test::whyRefused(file), "read");
        if (*warning == '\0')
            EXPECT_EQ(notices.text().find("weight"), std::string::npos) << notices.text();
        else
            test::expectContains(notices.text(), std::string("unweighted.gltf: ") + warning);
    }
}

/// OSG's own search would accept any file in the working folder with the last part of the name.
TEST_F(GuardedSkin, FindsNoFilesInOtherFolders) {
    skin("\"up\": \"y\"");
    const fs::path before = fs::current_path();
    fs::current_path(folder);
    EXPECT_EQ(test::whyRefused("a.skin"), "read");
    expectOneLine(test::whyRefused("nowhere/a.skin"), "nowhere/a.skin: ");
    EXPECT_EQ(test::whyRefused("a.skin", "motion=move.bvh"), "read");
    expectOneLine(test::whyRefused("a.skin", "motion=nowhere/move.bvh"),
                  "motion \"nowhere/move.bvh\" is neither one of its motions nor a file");
    EXPECT_FALSE(osgDB::readRefNodeFile("nowhere/a.skin").valid());
    fs::current_path(before);
}

TEST_F(GuardedSkin, DoesNotOverwriteFilesOfTheCharacter) {
    save("w.json", test::fileText(test::kTubeFolder + "weights.json"));
    skin(R"("bind": "weights", "weights": "w.json", "motions": [{"file": "move.bvh"}])");
    fs::create_symlink("body.obj", folder + "/link.obj");
    for (const auto& [arguments, file] :
         {std::pair("--frames 0 --out body.obj", "body.obj"),
          std::pair("--rest link.obj", "body.obj"), std::pair("--binding a.skin", "a.skin"),
          std::pair("--pose w.json", "w.json"), std::pair("--binding ./rig.bvh", "rig.bvh"),
          std::pair("--pose move.bvh", "move.bvh")}) {
        const std::string before = test::fileText(folder + "/" + file);
        const test::CommandResult bake =
            test::runBake(std::string("a.skin --quiet ") + arguments, folder);
        EXPECT_EQ(bake.status, 1) << arguments;
        test::expectContains(bake.err, ": a part of the character, expected another file");
        EXPECT_EQ(test::fileText(folder + "/" + file), before) << arguments;
    }
}

TEST_F(GuardedSkin, RejectsOneFileForTwoOutputs) {
    skin("\"motions\": [{\"file\": \"move.bvh\"}]");
    for (const char* arguments :
         {"--frames 0 --out x.obj --rest x.obj", "--binding x.json --pose ./x.json"}) {
        const test::CommandResult bake =
            test::runBake(std::string("a.skin --quiet ") + arguments, folder);
        EXPECT_EQ(bake.status, 2) << arguments;
        test::expectContains(bake.err, "expected a file of its own for each");
    }
}

TEST_F(GuardedSkin, ReplacesInvalidUtf8AndControlCharacters) {
    std::string bones = test::fileText(folder + "/rig.bvh");
    for (std::size_t at = 0; (at = bones.find("arm", at)) != std::string::npos;)
        bones.replace(at, 3, "\xe4rm");
    save("latin.bvh", bones);
    skin(R"("motions": [{"file": "latin.bvh", "name": "m\n\u001b[31m"}])", "\"latin.bvh\"");
    const test::CommandResult bake =
        test::runBake("a.skin --quiet --frames 0 --binding b.json --pose p.json", folder);
    EXPECT_EQ(bake.status, 0) << bake.err;
    for (const char* file : {"b.json", "p.json"})
        test::expectContains(test::fileText(folder + "/" + file), "\"\xef\xbf\xbdrm\"", file);
    const test::CommandResult usage = test::runBake("a.skin --quiet --motion other", folder);
    EXPECT_EQ(usage.status, 2);
    EXPECT_EQ(usage.err.find('\x1b'), std::string::npos) << usage.err;
    EXPECT_EQ(std::count(usage.err.begin(), usage.err.end(), '\n'), 2) << usage.err;
}

/// Others may know the temporary name of a file that is written to a shared folder.
TEST_F(GuardedSkin, TemporaryFilesFollowNoLinks) {
    skin("\"up\": \"y\"");
    save("victim", "kept");
    // The shell process becomes the program and keeps its process id.
    const test::CommandResult done = test::runCommand(
        "ln -s victim x.json.part$$; exec " OSGSKIN_BAKE " a.skin --quiet --binding x.json",
        folder);
    EXPECT_EQ(done.status, 0) << done.err;
    EXPECT_EQ(test::fileText(folder + "/victim"), "kept");
    EXPECT_GT(fs::file_size(folder + "/x.json"), 100u);
}

TEST_F(GuardedSkin, TriangulatesLargeFacesInSeconds) {
    constexpr int corners = 60'000;
    std::string text = "ply\nformat ascii 1.0\nelement vertex " + std::to_string(corners) +
                       "\nproperty float x\nproperty float y\nproperty float z\nproperty float u\n"
                       "property float v\nelement face 1\nproperty list int int vertex_indices\n"
                       "end_header\n";
    std::string face = std::to_string(corners);
    for (int k = 0; k < corners; ++k) {
        const double angle = 2.0 * std::acos(-1.0) * k / corners;
        text +=
            std::to_string(std::cos(angle)) + " 1 " + std::to_string(std::sin(angle)) + " 0 0\n";
        face += " " + std::to_string(k);
    }
    save("wheel.ply", text + face + "\n");
    save("wheel.skin", R"({"osgskin": 1, "mesh": "wheel.ply", "skeleton": "rig.bvh"})");
    const test::CommandResult bake = test::runCommand(
        "ulimit -t 8; exec " OSGSKIN_BAKE " wheel.skin --quiet --rest x.obj", folder);
    EXPECT_EQ(bake.status, 0) << bake.err;
}

TEST_F(GuardedSkin, ProgramsFailWithoutADisplay) {
    skin("\"up\": \"y\"");
    for (const char* program :
         {OSGSKIN_VIEWER " a.skin", OSGSKIN_CROWD " a.skin --count 2", OSGSKIN_THROW}) {
        const test::CommandResult shown =
            test::runCommand(std::string("DISPLAY=:98765 timeout 60 ") + program, folder);
        EXPECT_EQ(shown.status, 1) << program;
        test::expectContains(shown.err, "no window can be opened; is DISPLAY set?");
    }
}
