// SPDX-License-Identifier: MIT
// Settings of a .skin file other than the default method for ratios.
#include "Command.h"
#include "ExpectContains.h"
#include "GltfBuilder.h"
#include "Notices.h"
#include "SkinFiles.h"
#include "WhyRefused.h"

#include <osgSkinCharacter/LoadCharacter>

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>

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

/// A column whose upper joints hang side by side on the lowest.
test::GltfColumn forked() {
    test::GltfColumn column;
    column.json["nodes"][0]["children"] = {1, 2};
    column.json["nodes"][1].erase("children");
    column.json["nodes"][2]["translation"] = {0, 2, 0};
    return column;
}

/// \param joints, weights four for each vertex
void paint(test::GltfColumn& column, const std::vector<double>& joints,
           const std::vector<double>& weights) {
    column.attributes()["JOINTS_0"] = column.accessor("VEC4", joints, 5121);
    column.attributes()["WEIGHTS_0"] = column.accessor("VEC4", weights);
}

} // namespace

TEST(BindMethod, WeightsGiveTheRatiosOfTheFile) {
    expectBend(osgSkin::loadCharacter(OSGSKIN_TEST_DATA "/character/painted.skin"),
               [](double height) { return std::clamp(height - 1.5, 0.0, 1.0); });
}

TEST(BindMethod, WeightsAreReported) {
    const Character character = osgSkin::loadCharacter(OSGSKIN_TEST_DATA "/character/painted.skin");
    EXPECT_EQ(character.bindReport.vertices, 56u);
    EXPECT_EQ(character.bindReport.regions.size(), 2u);
    EXPECT_TRUE(character.bindReport.notes.empty()) << character.bindReport.text();
}

TEST(BindMethod, ReadsWeightsOfTheMesh) {
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
TEST(BindMethod, UsesWeightsByDefaultWhereTheMeshIsPaintedThroughout) {
    const std::string folder = test::makeTestFolder();
    const std::string painted = test::GltfColumn().save("default_painted.gltf");
    const auto load = [&](const std::string& members, const std::string& options = {}) {
        return osgSkin::loadCharacter(test::saveSkin(folder + "/column.skin", members, painted, ""),
                                      test::loadOptions(options));
    };
    EXPECT_TRUE(load("").bindReport.boundaries.empty());
    test::expectContains(load("").bindReport.text(), "bound by painted weights\n");
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
        test::expectContains(said, summary);
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
TEST(BindMethod, ShellsWithoutWeightsDoNotPreventWeights) {
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

/// As the middle of a skirt, half of both legs'.
TEST(BindMethod, SkinFarBelowTwoBranchesIsTold) {
    for (const double share : {0.5, 0.1}) {
        test::GltfColumn column = forked();
        std::vector<double> joints, weights;
        for (int v = 0; v < 24; ++v) {
            joints.insert(joints.end(), {v < 8 ? 1.0 : v / 8, v < 8 ? 2.0 : 0.0, 0, 0});
            weights.insert(weights.end(), {v < 8 ? share : 1.0, v < 8 ? 1.0 - share : 0.0, 0, 0});
        }
        paint(column, joints, weights);
        const std::string file = column.save("branches" + std::to_string(share) + ".gltf");
        const test::Notices notices;
        osgSkin::loadCharacter(file);
        EXPECT_EQ(notices.say("4 vertices follow both \"middle\" and \"top\""), share == 0.5)
            << notices.text();
    }
}

/// Exporters of games put all bones on the root, and write their moves in its space.
TEST(BindMethod, SkinBetweenBonesSideBySideIsTold) {
    for (const bool moves : {false, true}) {
        test::GltfColumn column = forked();
        std::vector<double> joints, weights;
        for (int v = 0; v < 24; ++v) {
            joints.insert(joints.end(), {v < 8 ? 0.0 : 1.0, v < 8 ? 0.0 : 2.0, 0, 0});
            weights.insert(weights.end(), {v < 8 ? 1.0 : 0.5, v < 8 ? 0.0 : 0.5, 0, 0});
        }
        paint(column, joints, weights);
        column.animate("bend", 2, "rotation", {0.0, 1.0}, test::GltfColumn::turns({0, 90}));
        if (moves) column.animate("bend", 2, "translation", {0.0, 1.0}, {0, 2, 0, 0, 1, 1});
        const std::string file = column.save(moves ? "flat_moves.gltf" : "flat.gltf");
        const test::Notices notices;
        osgSkin::loadCharacter(file);
        EXPECT_EQ(notices.say("skin between the joints \"middle\" and \"top\" may tear"), moves)
            << notices.text();
    }
}

TEST(BindMethod, SharesThatAreLeftOutAreTold) {
    for (const int deep : {4, 5}) {
        test::GltfColumn column;
        std::vector<double> matrices, joints, weights;
        column.json["nodes"][0]["children"] = nlohmann::json::array();
        for (const std::string branch : {"a", "b"})
            for (int k = 0; k < deep; ++k) {
                const std::size_t above = k == 0 ? 0 : column.json["nodes"].size() - 1;
                const std::size_t own = column.node({{"name", branch + std::to_string(k)},
                                                     {"translation", {0, k == 0 ? 0 : 0.5, 0}}});
                column.json["nodes"][above]["children"].push_back(own);
                column.joints.push_back(own);
            }
        column.joints.erase(column.joints.begin() + 1, column.joints.begin() + 3);
        for (std::size_t j = 0; j < column.joints.size(); ++j)
            for (int k = 0; k < 16; ++k)
                matrices.push_back(k == 13      ? -0.5 * double(j == 0 ? 0 : (int(j) - 1) % deep)
                                   : k % 5 == 0 ? 1.0
                                                : 0.0);
        column.json["skins"][0] = {{"joints", column.joints},
                                   {"inverseBindMatrices", column.accessor("MAT4", matrices)}};
        for (int v = 0; v < 24; ++v) {
            joints.insert(joints.end(), {double(deep), 2.0 * deep, 0, 0});
            weights.insert(weights.end(), {0.6, 0.4, 0, 0});
        }
        paint(column, joints, weights);
        const std::string file = column.save("branches_" + std::to_string(deep) + ".gltf");
        const test::Notices notices;
        osgSkin::loadCharacter(file);
        EXPECT_EQ(notices.say("24 vertices follow more than 8 joints in part"), deep == 5)
            << notices.text();
    }
}

TEST(BindMethod, WeightsFileImpliesWeights) {
    const std::string weights = R"(, "weights": ")" + test::kTubeFolder + "weights.json\"";
    expectBend(
        osgSkin::loadCharacter(test::saveSkin(test::makeTestFolder() + "/painted.skin", weights)),
        [](double height) { return std::clamp(height - 1.5, 0.0, 1.0); });
}

TEST(BindMethod, PaperGivesEquation5BetweenBoundariesOfTheFile) {
    expectBend(osgSkin::loadCharacter(OSGSKIN_TEST_DATA "/character/printed.skin"),
               [](double height) {
                   const double t = std::clamp((height - 1.0) / 2.0, 0.0, 1.0);
                   return t * t * (3.0 - 2.0 * t);
               });
}
