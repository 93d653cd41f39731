// SPDX-License-Identifier: MIT
// The plug-ins in a third-party host, OSG's own osgconv: they are silent, and reject libraries of
// another build instead of crashing.
#include "Command.h"
#include "ExpectContains.h"
#include "KitCheck.h"
#include "Notices.h"
#include "TextFile.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace {

constexpr char kLibraries[] = "OSG_LIBRARY_PATH='" OSGSKIN_LIBRARIES "' ";

class PlugIn : public testing::Test {
protected:
    void SetUp() override {
        if (OSGSKIN_SANITIZED) GTEST_SKIP() << "osgconv cannot load libraries with sanitizers";
        folder = test::makeTestFolder();
    }
    test::CommandResult convert(const std::string& from, const std::string& to,
                                const std::string& environment = {}) const {
        return test::runCommand(kLibraries + environment + "osgconv '" + from + "' " + to, folder);
    }
    std::string folder;
};

/// Expects that osgconv exited by itself without a result and with a one-line reason.
void expectRefused(const test::CommandResult& result, const std::string& plugIn,
                   const std::string& kit) {
    EXPECT_GE(result.status, 0) << "osgconv was ended by a signal";
    const std::string all = result.out + result.err;
    const std::size_t at = all.find(plugIn + " is left out: ");
    ASSERT_NE(at, std::string::npos) << all;
    EXPECT_EQ(all.find(plugIn + " is left out: ", at + 1), std::string::npos) << all;
    const std::string line = all.substr(at, all.find('\n', at) - at);
    test::expectContains(line, "built with " + kit + " " OSGSKIN_PROJECT_VERSION " (");
    test::expectContains(line, "0.1.7 (00000000)");
}

/// An arm along y, bent by 13 degrees at rest, as a `.skin` file with all files that it names.
void writeArm(const std::string& folder) {
    constexpr int kSides = 16, kRings = 57;
    std::ofstream mesh(folder + "/arm.obj");
    for (int ring = 0; ring < kRings; ++ring)
        for (int side = 0; side < kSides; ++side) {
            const double angle = 2.0 * 3.141592653589793 * side / kSides;
            mesh << "v " << std::cos(angle) << ' ' << 0.25 * ring << ' ' << -std::sin(angle)
                 << '\n';
        }
    for (int ring = 0; ring + 1 < kRings; ++ring)
        for (int side = 0; side < kSides; ++side) {
            const int next = (side + 1) % kSides, low = 1 + ring * kSides, high = low + kSides;
            mesh << "f " << low + side << ' ' << low + next << ' ' << high + next << ' '
                 << high + side << '\n';
        }
    std::ofstream(folder + "/arm.bvh")
        << "HIERARCHY\nROOT upper\n{\n OFFSET 0 0 0\n CHANNELS 3 Zrotation Yrotation Xrotation\n"
           " JOINT lower\n {\n  OFFSET 0 7 0.8\n  CHANNELS 3 Zrotation Yrotation Xrotation\n"
           "  End Site\n  {\n   OFFSET 0 7 -0.8\n  }\n }\n}\nMOTION\nFrames: 1\n"
           "Frame Time: 0.1\n0 0 0 0 0 0\n";
    std::ofstream(folder + "/arm.skin")
        << R"({ "osgskin": 1, "mesh": "arm.obj", "skeleton": "arm.bvh" })";
}

std::vector<std::filesystem::path> filesIn(const std::string& folder) {
    std::vector<std::filesystem::path> files;
    if (!std::filesystem::exists(folder)) return files;
    for (const auto& entry : std::filesystem::directory_iterator(folder))
        files.push_back(entry.path());
    return files;
}

const char* anotherBuild() {
    return "0.1.7 (00000000)";
}
const char* thisBuild() {
    return "0.2.0 (1a2b3c4d)";
}

} // namespace

TEST_F(PlugIn, PrintsNothing) {
    for (const char* file :
         {OSGSKIN_DATA "/thrower.skin", OSGSKIN_TEST_DATA "/rig/tube.gltf.skin"}) {
        const test::CommandResult result = convert(file, "saved.osgb");
        EXPECT_EQ(result.status, 0);
        EXPECT_EQ(result.err, "");
    }
    EXPECT_EQ(convert("saved.osgb", "saved.osgt").err, "") << "the serializers";
}

/// The user's cache folder, too, stays empty.
TEST_F(PlugIn, SavesElasticShapesWithTheCharacterAlone) {
    writeArm(folder);
    const std::string home = "HOME='" + folder + "/home' XDG_CACHE_HOME='" + folder + "/home' ";
    ASSERT_EQ(convert("arm.skin", "plain.osgb", home).status, 0);
    const auto result = convert("arm.skin", "elastic.osgb -O shapes=elastic", home);
    EXPECT_EQ(result.status, 0);
    EXPECT_EQ(result.err, "");
    EXPECT_GT(test::fileText(folder + "/elastic.osgb").size(),
              test::fileText(folder + "/plain.osgb").size());
    EXPECT_TRUE(filesIn(folder + "/home").empty());
}

TEST_F(PlugIn, RejectsLibrariesOfAnotherBuild) {
    expectRefused(
        convert(OSGSKIN_DATA "/thrower.skin", "never.osgb", "LD_PRELOAD='" OSGSKIN_OTHER_BIND "' "),
        "osgdb_skin", "osgSkinBind");
}

TEST_F(PlugIn, SerializersRejectRuntimeOfAnotherBuild) {
    ASSERT_EQ(convert(OSGSKIN_TEST_DATA "/character/good.skin", "saved.osgt").status, 0);
    expectRefused(convert("saved.osgt", "never.osgb", "LD_PRELOAD='" OSGSKIN_OTHER_RUNTIME "' "),
                  "osgdb_serializers_osgskin", "osgSkin");
}

TEST(KitCheck, AcceptsTheSameBuild) {
    EXPECT_TRUE(plugin::mayUse("osgdb_any", {{"osgSkin", "0.2.0 (1a2b3c4d)", thisBuild}}));
}

TEST(KitCheck, RejectsOtherBuildsWithOneLine) {
    struct Case {
        plugin::KitBuild kit;
        const char* found;
    };
    const Case cases[] = {{{"osgSkinRig", "0.2.0 (1a2b3c4d)", anotherBuild}, "0.1.7 (00000000)"},
                          {{"osgSkinRig", "0.2.0 (99999999)", thisBuild}, "0.2.0 (1a2b3c4d)"},
                          {{"osgSkinRig", "0.2.0 (1a2b3c4d)", nullptr}, "an older one"}};
    for (const Case& c : cases) {
        const test::Notices notices;
        const bool used =
            plugin::mayUse("osgdb_any", {{"osgSkin", "0.2.0 (1a2b3c4d)", thisBuild}, c.kit});
        EXPECT_FALSE(used);
        EXPECT_EQ(notices.lines(), 1u);
        for (const char* part : {"osgdb_any", "osgSkinRig", c.kit.compiled, c.found})
            EXPECT_TRUE(notices.say(part)) << notices.text();
    }
}
