// SPDX-License-Identifier: MIT
// What a .skin file may ask for beside the default way to find ratios.

#include <osgSkinCharacter/LoadCharacter>

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>

using osgSkin::Character;

namespace {

/// Compares the bend ratios of the joint "arm" with what its file makes of a vertex's height.
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

TEST(BindMethod, PaperGivesEquation5BetweenTheFilesBoundaries) {
    expectBend(osgSkin::loadCharacter(OSGSKIN_TEST_DATA "/character/printed.skin"),
               [](double height) {
                   const double t = std::clamp((height - 1.0) / 2.0, 0.0, 1.0);
                   return t * t * (3.0 - 2.0 * t);
               });
}
