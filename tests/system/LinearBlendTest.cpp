// SPDX-License-Identifier: MIT
// Third-party painted characters, all clips, compared with linear blending by glTF's own
// definition.
#include "BlendError.h"
#include "ExpectContains.h"

#include <osgSkin/Error>
#include <osgSkinCharacter/LoadCharacter>

#include <gtest/gtest.h>

#include <filesystem>
#include <string>

namespace {

struct Painted {
    const char* file;
    std::size_t clips;
};

class LinearBlend : public testing::TestWithParam<Painted> {};

} // namespace

TEST_P(LinearBlend, MatchesGltfReferenceInEveryClip) {
    const std::string file = std::string(OSGSKIN_SHARED_DATA "/characters/") + GetParam().file;
    if (!std::filesystem::exists(file)) GTEST_SKIP() << "needs " << file << ", which is missing";
    const test::BlendError error = test::blendError(file);
    EXPECT_EQ(error.clips, GetParam().clips);
    EXPECT_LT(error.whole, 1e-3) << error.clip;
    EXPECT_LT(error.mixed, 0.02);
    RecordProperty("whole", std::to_string(error.whole));
    RecordProperty("mixed", std::to_string(error.mixed));
    std::cout << "weights of 0 and 1: " << error.whole << ", others: " << error.mixed
              << " of the size\n";
}

TEST_P(LinearBlend, ClipsAreFoundByName) {
    const std::string file = std::string(OSGSKIN_SHARED_DATA "/characters/") + GetParam().file;
    if (!std::filesystem::exists(file)) GTEST_SKIP() << "needs " << file << ", which is missing";
    const osgSkin::Character all = osgSkin::loadCharacter(file);
    ASSERT_EQ(all.motions.size(), GetParam().clips);
    // If there are many: every seventh, and the last.
    const std::size_t step = all.motions.size() > 20 ? 7 : 1;
    for (std::size_t m = all.motions.size(); m > 0; m = m > step ? m - step : 0) {
        const osgSkin::CharacterMotion& motion = all.motions[m - 1];
        osgSkin::LoadOptions options;
        options.motion = motion.name();
        const osgSkin::Character one = osgSkin::loadCharacter(file, options);
        EXPECT_EQ(one.motions.front().name(), motion.name());
        EXPECT_TRUE(one.manager->isPlaying(motion.name()));
    }
    osgSkin::LoadOptions options;
    options.motion = "no such clip";
    try {
        osgSkin::loadCharacter(file, options);
        ADD_FAILURE() << "an unknown clip was taken";
    } catch (const osgSkin::Error& error) {
        test::expectContains(error.what(), '"' + all.motions.back().name() + '"');
    }
}

INSTANTIATE_TEST_SUITE_P(Characters, LinearBlend,
                         testing::Values(Painted{"robot.glb", 14}, Painted{"Knight.glb", 76}),
                         [](const auto& tested) {
                             const std::string file = tested.param.file;
                             return file.substr(0, file.find('.'));
                         });
