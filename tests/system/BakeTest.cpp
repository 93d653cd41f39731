// SPDX-License-Identifier: MIT
// osgskinbake's meshes agree with a reference that reads only the written files.
#include "CharacterFiles.h"
#include "Command.h"
#include "ExpectContains.h"
#include "GlbFile.h"
#include "GltfBuilder.h"
#include "ReferenceSkin.h"

#include <osgSkinCharacter/LoadCharacter>
#include <osgSkinImport/ImportRig>
#include <osgSkinMotion/SampledClip>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

namespace {

using test::CharacterCase;
using test::runBake;

std::string frameFile(const std::string& folder, int frame) {
    char name[32];
    std::snprintf(name, sizeof name, "/frame_%04d.obj", frame);
    return folder + name;
}

class BakedCharacter : public testing::TestWithParam<CharacterCase> {
protected:
    void SetUp() override {
        std::string why;
        if (!test::isAvailable(GetParam(), why)) GTEST_SKIP() << why;
        folder = test::makeTestFolder();
        const std::string skin = test::skinFile(GetParam(), folder);
        const std::string shapes =
            std::string(" --shapes ") + GetParam().shapes + " --muscles " + GetParam().muscles;
        const auto rest =
            runBake("'" + skin + "'" + shapes + " --rest rest.obj --binding binding.json", folder);
        ASSERT_EQ(rest.status, 0) << rest.err;
        const auto frames = runBake("'" + skin + "'" + shapes + " --frames " + GetParam().frames +
                                        " --out frame_%04d.obj --pose pose.json",
                                    folder);
        ASSERT_EQ(frames.status, 0) << frames.err;
    }
    std::string folder;
};

} // namespace

TEST_P(BakedCharacter, AgreesWithTheReference) {
    const nlohmann::json binding = test::readJson(folder + "/binding.json");
    const test::ReferenceSkin reference(binding, test::readObjVertices(folder + "/rest.obj"));
    const nlohmann::json poses = test::readJson(folder + "/pose.json");
    ASSERT_GE(poses.size(), 20u);
    double worst = 0.0;
    for (const nlohmann::json& pose : poses) {
        const auto baked = test::readObjVertices(frameFile(folder, pose["frame"]));
        const auto expected = reference.pose(pose);
        ASSERT_EQ(baked.size(), expected.size());
        for (std::size_t v = 0; v < baked.size(); ++v)
            worst = std::max(worst, glm::distance(baked[v], expected[v]));
    }
    RecordProperty("worst", std::to_string(worst / reference.height()));
    EXPECT_LE(worst, 1e-5 * reference.height());
}

TEST_P(BakedCharacter, RatiosAreFromZeroToOne) {
    const nlohmann::json binding = test::readJson(folder + "/binding.json");
    const auto rest = test::readObjVertices(folder + "/rest.obj");
    ASSERT_EQ(binding["vertices"].size(), rest.size());
    std::vector<std::string> names;
    for (const nlohmann::json& joint : binding["joints"]) names.push_back(joint["name"]);
    std::size_t zeroOrOne = 0, all = 0;
    for (const nlohmann::json& vertex : binding["vertices"]) {
        ASSERT_NE(std::find(names.begin(), names.end(), vertex["region"]), names.end());
        for (const nlohmann::json& ratio : vertex["ratios"])
            for (const double share : {ratio[1].get<double>(), ratio[2].get<double>()}) {
                ASSERT_GE(share, 0.0);
                ASSERT_LE(share, 1.0);
                ++all;
                if (share == 0.0 || share == 1.0) ++zeroOrOne;
            }
    }
    // Outside the regions' boundaries ratios are exactly 0 or 1, which is most of a body.
    EXPECT_GT(double(zeroOrOne), 0.6 * double(all));
}

TEST_P(BakedCharacter, KeepsVerticesAndFacesOfTheInput) {
    const std::string input = GetParam().mesh
                                  ? std::string(OSGSKIN_SHARED_DATA) + "/" + GetParam().mesh
                                  : OSGSKIN_DATA "/thrower.obj";
    const auto vertices = test::readObjVertices(input);
    const auto rest = test::readObjVertices(folder + "/rest.obj");
    ASSERT_EQ(rest.size(), vertices.size());
    for (std::size_t v = 0; v < rest.size(); ++v)
        ASSERT_LE(glm::distance(rest[v], vertices[v]), 1e-5) << v;
    EXPECT_EQ(test::readObjFaces(folder + "/rest.obj"), test::readObjFaces(input));
    EXPECT_EQ(test::readObjFaces(frameFile(folder, 0)), test::readObjFaces(input));
}

TEST_P(BakedCharacter, DoesNotTear) {
    const auto rest = test::readObjVertices(folder + "/rest.obj");
    const auto faces = test::readObjFaces(folder + "/rest.obj");
    const nlohmann::json poses = test::readJson(folder + "/pose.json");
    double longest = 0.0;
    for (const nlohmann::json& pose : poses) {
        const auto posed = test::readObjVertices(frameFile(folder, pose["frame"]));
        for (const auto& face : faces)
            for (std::size_t k = 0; k < face.size(); ++k) {
                const auto a = static_cast<std::size_t>(face[k] - 1);
                const auto b = static_cast<std::size_t>(face[(k + 1) % face.size()] - 1);
                longest = std::max(longest, glm::distance(posed[a], posed[b]) /
                                                glm::distance(rest[a], rest[b]));
            }
    }
    RecordProperty("longest", std::to_string(longest));
    // Painted weights with dual quaternions reach 11.5 on these bodies; a tear is far beyond that.
    EXPECT_LE(longest, 5.5);
}

INSTANTIATE_TEST_SUITE_P(Characters, BakedCharacter, testing::ValuesIn(test::characterCases()),
                         [](const auto& c) { return std::string(c.param.name); });

TEST(Bake, WritesTheSamplesOfTheFile) {
    const std::string folder = test::makeTestFolder();
    const std::string skin = OSGSKIN_TEST_DATA "/character/good.skin";
    ASSERT_EQ(runBake("'" + skin + "' --pose all.json", folder).status, 0);
    ASSERT_EQ(runBake("'" + skin + "' --motion later --pose later.json", folder).status, 0);
    const nlohmann::json all = test::readJson(folder + "/all.json");
    const nlohmann::json later = test::readJson(folder + "/later.json");
    ASSERT_EQ(all.size(), 4u);
    ASSERT_EQ(later.size(), 2u);
    EXPECT_EQ(later[0]["frame"], 0);
    // The arm's rotation is Rz * Ry, about z by 0, 30, 60 and 90 degrees and about y by 0, 0, 40
    // and 80.
    for (std::size_t frame = 0; frame < 4; ++frame) {
        const nlohmann::json& r = all[frame]["joints"]["arm"]["rotation"];
        const double z[] = {0, 30, 60, 90}, y[] = {0, 0, 40, 80};
        const auto half = [](double degrees) { return degrees * M_PI / 360; };
        const glm::dquat expected =
            glm::dquat(std::cos(half(z[frame])), 0, 0, std::sin(half(z[frame]))) *
            glm::dquat(std::cos(half(y[frame])), 0, std::sin(half(y[frame])), 0);
        const glm::dquat found(r[0].get<double>(), r[1].get<double>(), r[2].get<double>(),
                               r[3].get<double>());
        EXPECT_NEAR(std::abs(glm::dot(expected, found)), 1.0, 1e-9) << frame;
    }
}

/// Keys at whole frames, whose times are rounded up or down in floats.
TEST(Bake, WritesTheLastFrame) {
    const std::string folder = test::makeTestFolder();
    for (const int last : {43, 70, 100, 115}) {
        test::GltfColumn column;
        std::vector<double> times, turns;
        for (int frame = 0; frame <= last; ++frame) {
            times.push_back(double(float(frame) / 30.0f));
            const double half = 0.4 * frame / last;
            turns.insert(turns.end(), {0.0, 0.0, std::sin(half), std::cos(half)});
        }
        column.animate("bend", column.joints[1], "rotation", times, turns);
        const std::string path = column.save("frames.gltf"), out = std::to_string(last) + "_%d.ply";
        const auto baked = runBake("'" + path + "' --quiet --out " + out, folder);
        ASSERT_EQ(baked.status, 0) << baked.err;
        const std::string before = folder + "/" + std::to_string(last) + "_";
        EXPECT_TRUE(std::filesystem::exists(before + std::to_string(last) + ".ply")) << last;
        EXPECT_FALSE(std::filesystem::exists(before + std::to_string(last + 1) + ".ply")) << last;
        const osgSkin::ImportedRig rig = osgSkin::importRig(path);
        const auto clip = osgSkin::SampledClip::create(*rig.animations[0], *rig.skeleton, 30.0);
        EXPECT_EQ(clip->sampleCount(), std::size_t(last));
    }
}

TEST(Bake, ExitsWithTwoOnUsageErrors) {
    const std::string folder = test::makeTestFolder();
    const std::string skin = "'" OSGSKIN_TEST_DATA "/character/good.skin' ";
    for (const char* arguments : {"",
                                  "--nonsense",
                                  "--frames 3:1",
                                  "--frames 0:9",
                                  "--frames x",
                                  "--frames 0:1:0",
                                  "--frames -1",
                                  "--motion nobody",
                                  "--out a%db%d.obj",
                                  "--out %s.obj",
                                  "--out one.obj",
                                  "--rest r.obj --motion nobody",
                                  "--binding b.json --motion nobody",
                                  "--binding ''",
                                  "--rest ''",
                                  "--rest r.mtl",
                                  "--pose ''",
                                  "--frames ''",
                                  "--motion ''",
                                  "--out ''",
                                  "--binding=",
                                  "--rest r.obj --frames="}) {
        const bool none = std::string(arguments).empty();
        const auto result = runBake((none ? "" : skin) + arguments, folder);
        EXPECT_EQ(result.status, 2) << arguments;
        EXPECT_FALSE(result.err.empty()) << arguments;
        for (const char* file : {"/r.obj", "/b.json", "/rest.obj"})
            EXPECT_FALSE(std::filesystem::exists(folder + file)) << arguments;
    }
    EXPECT_EQ(runBake("--help", folder).status, 0);
    test::expectContains(runBake("--help", folder).out, "--frames");
}

TEST(Bake, WritesNoFramesWithRestAlone) {
    const std::string folder = test::makeTestFolder();
    const std::string skin = "'" OSGSKIN_TEST_DATA "/character/good.skin'";
    ASSERT_EQ(runBake(skin + " --rest --out alone.obj", folder).status, 0);
    ASSERT_EQ(runBake("--rest " + skin + " --out first.obj", folder).status, 0);
    ASSERT_EQ(runBake(skin + " --rest named.obj", folder).status, 0);
    for (const char* file : {"/alone.obj", "/first.obj", "/named.obj"})
        EXPECT_EQ(test::readObjVertices(folder + file).size(), 56u) << file;
    EXPECT_FALSE(std::filesystem::exists(folder + "/frame_0000.obj"));
}

TEST(Bake, ExitsWithOneOnUnwritableOutput) {
    const std::string folder = test::makeTestFolder();
    const auto result =
        runBake("'" OSGSKIN_TEST_DATA "/character/good.skin' --rest nowhere/at/all.obj", folder);
    EXPECT_EQ(result.status, 1);
    test::expectContains(result.err, "nowhere/at/all.obj");
}

TEST(Bake, ReportsGeometryThatIsLeftOut) {
    const std::string folder = test::makeTestFolder();
    const auto told = runBake("'" OSGSKIN_DATA "/thrower.skin' --rest rest.obj", folder);
    EXPECT_EQ(told.status, 0);
    test::expectContains(told.err, "1 geometry beside the body left out: \"prop:throw");
    const auto quiet = runBake("'" OSGSKIN_DATA "/thrower.skin' --rest rest.obj --quiet", folder);
    EXPECT_EQ(quiet.err, "");
}
