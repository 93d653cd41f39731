// SPDX-License-Identifier: MIT
// Meshes bound to the same joints in different poses, such as clothes and a body.
#include "BlendError.h"
#include "GltfBuilder.h"

#include <osgSkinCharacter/LoadCharacter>

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace {

using test::GltfColumn;

/// A column, and beside it another one on the same joints that was bound with its middle rotated.
std::string saveTwo(const std::string& name, double degrees) {
    GltfColumn column;
    column.bend();
    std::vector<double> places = column.places, matrices;
    for (std::size_t i = 0; i < places.size(); i += 3) places[i] += 2.0;
    glm::dmat4 joint(1.0);
    for (int j = 0; j < 3; ++j) {
        if (j > 0) joint = glm::translate(joint, {0.0, 1.0, 0.0});
        if (j == 1) joint = glm::rotate(joint, glm::radians(degrees), {1.0, 0.0, 0.0});
        const glm::dmat4 inverse = glm::inverse(joint);
        for (int c = 0; c < 4; ++c)
            for (int r = 0; r < 4; ++r) matrices.push_back(inverse[c][r]);
    }
    nlohmann::json mesh = column.json["meshes"][0];
    mesh["primitives"][0]["attributes"]["POSITION"] = column.accessor("VEC3", places);
    column.json["meshes"].push_back(mesh);
    column.json["skins"].push_back(
        {{"joints", column.joints}, {"inverseBindMatrices", column.accessor("MAT4", matrices)}});
    const std::size_t second = column.node({{"name", "second"}, {"mesh", 1}, {"skin", 1}});
    column.json["scenes"][0]["nodes"].push_back(second);
    return column.save(name);
}

} // namespace

TEST(PerVertexBindPose, MeshesUseBindPosesOfTheirOwnSkins) {
    for (const double degrees : {0.0, 50.0, -120.0}) {
        const test::BlendError error = test::blendError(saveTwo("apart.gltf", degrees));
        EXPECT_EQ(error.clips, 1u) << degrees;
        EXPECT_LT(error.whole, 1e-5) << degrees;
    }
}

TEST(PerVertexBindPose, IgnoresZeroInverseBindMatrices) {
    GltfColumn column;
    std::vector<double> matrices(48, 0.0);
    for (std::size_t k = 0; k < 32; ++k) // of the first two
        matrices[k] = k % 16 % 5 == 0 ? 1.0 : k == 29 ? -1.0 : 0.0;
    column.json["skins"][0]["inverseBindMatrices"] = column.accessor("MAT4", matrices);
    const osgSkin::Character character = osgSkin::loadCharacter(column.save("none.gltf"));
    ASSERT_EQ(3 * character.body.mesh.positions.size(), column.places.size());
    for (std::size_t i = 0; i < column.places.size(); ++i)
        EXPECT_NEAR(character.body.mesh.positions[i / 3][int(i % 3)], column.places[i], 1e-6) << i;
}
