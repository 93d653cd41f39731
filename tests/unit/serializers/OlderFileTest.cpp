// SPDX-License-Identifier: MIT
//
// Files of osgSkin 0.3 are refused with an error, not read in part. tests/data/saved has a skin,
// one with morph targets, and a group that plays a clip, as osgSkin 0.3 wrote them.
#include "SavedScene.h"
#include "TextFile.h"

#include <gtest/gtest.h>

#include <string>
#include <tuple>

namespace {

class OlderFile : public testing::TestWithParam<std::tuple<const char*, const char*>> {};

void expectRefused(const std::string& file, const std::string& extension) {
    std::string reason;
    EXPECT_EQ(test::load(file, extension, &reason), nullptr);
    EXPECT_NE(reason.find("osgSkin 0.3 or older"), std::string::npos) << reason;
    EXPECT_NE(reason.find("osgconv character.skin character.osgb"), std::string::npos) << reason;
}

} // namespace

TEST_P(OlderFile, IsRefusedWithAnError) {
    const auto [name, extension] = GetParam();
    expectRefused(test::fileText(std::string(OSGSKIN_TEST_DATA "/saved/") + name + '.' + extension),
                  extension);
}

INSTANTIATE_TEST_SUITE_P(Saved, OlderFile,
                         testing::Combine(testing::Values("skin", "morphs", "clips"),
                                          testing::Values("osgt", "osgb", "osgx")),
                         [](const auto& file) {
                             return std::string(std::get<0>(file.param)) + '_' +
                                    std::get<1>(file.param);
                         });

/// The first versions called AutoPlayManager in files as today, but saved its clips otherwise.
TEST(OlderFiles, AutoPlayManagerWithoutVersionIsRefused) {
    std::string file = test::fileText(OSGSKIN_TEST_DATA "/saved/clips.osgt");
    const std::string name = "AutoPlayClips";
    file.replace(file.find(name), name.size(), "AutoPlayManager");
    expectRefused(file, "osgt");
}
