// SPDX-License-Identifier: MIT
// A character that is bound by the weights that somebody painted.
#include "Character.h"

#include <gtest/gtest.h>

#include <algorithm>

using osgSkin::Character;
using osgSkin::Influence;

TEST(PaintedCharacter, TakesItsRatiosFromTheFile) {
    const Character character = Character::load(OSGSKIN_TEST_DATA "/character/painted.skin");
    const osgSkin::Binding& binding = character.binding;
    ASSERT_EQ(binding.vertexCount(), character.body.mesh.positions.size());
    for (std::size_t v = 0; v < binding.vertexCount(); ++v) {
        const double height = character.body.mesh.positions[v].y;
        const auto painted = static_cast<float>(std::clamp(height - 1.5, 0.0, 1.0));
        float arm = 0.0f;
        for (std::uint32_t i = binding.firstInfluence[v]; i < binding.firstInfluence[v + 1]; ++i)
            if (binding.influences[i].joint == 1) arm = binding.influences[i].bend;
        EXPECT_NEAR(arm, painted, 1e-4f) << "vertex " << v << " at " << height;
    }
}

TEST(PaintedCharacter, IsReported) {
    const Character character = Character::load(OSGSKIN_TEST_DATA "/character/painted.skin");
    EXPECT_EQ(character.report.vertices, 56u);
    EXPECT_EQ(character.report.regions.size(), 2u);
    EXPECT_TRUE(character.report.notes.empty()) << character.report.text();
}
