// SPDX-License-Identifier: MIT
// Exports of Blender 5.2.2, in world space, beside Blender's own vertices. tests/data/blender has
// the script.
#include "DrawnSkin.h"
#include "SkinFiles.h"

#include <osgSkinCharacter/LoadCharacter>

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <string>
#include <vector>

namespace {

const std::string kFolder = OSGSKIN_TEST_DATA "/blender/";

class BlenderExport : public testing::TestWithParam<std::string> {};

} // namespace

TEST_P(BlenderExport, IsPosedAsInBlender) {
    std::string file = kFolder + "tube." + GetParam();
    if (GetParam() == "bvh")
        file = test::saveSkin(testing::TempDir() + "blender_bvh.skin",
                              ", \"motions\": [ { \"file\": \"" + file + "\" } ]",
                              kFolder + "tube.glb", kFolder + "tube.glb");
    osgSkin::Character character = osgSkin::loadCharacter(file);
    ASSERT_EQ(character.motions.size(), 1u);
    character.poseAt(character.motions[0], 0.25);

    std::ifstream in(kFolder + "tube_at_6.txt");
    std::size_t count = 0;
    for (osg::Vec3d expected; in >> expected.x() >> expected.y() >> expected.z(); ++count) {
        double nearest = 1.0;
        for (const osg::Vec3d& found : test::drawnVertices(character))
            nearest = std::min(nearest, (found * character.toWorld - expected).length());
        // Two rings follow two bones by halves; Blender blends matrices there.
        const bool isBlended = count / 6 == 4 || count / 6 == 8;
        EXPECT_LT(nearest, isBlended ? 0.006 : 2e-5) << "vertex " << count;
    }
    EXPECT_EQ(count, 78u);
}

INSTANTIATE_TEST_SUITE_P(Of, BlenderExport, testing::Values("glb", "fbx", "bvh"),
                         [](const auto& tested) { return tested.param; });
