// SPDX-License-Identifier: MIT
// Files cut short or altered where our own classes stand in them: no crash, and no half character.
#include "SavedScene.h"

#include <osg/Notify>

#include <gtest/gtest.h>

#include <algorithm>

namespace {

class HostileFile : public testing::TestWithParam<const char*> {
protected:
    // Other than our reasons, OSG says of a bad text file what it makes of each word in it.
    void SetUp() override { osg::setNotifyLevel(osg::ALWAYS); }
    void TearDown() override { osg::setNotifyLevel(osg::NOTICE); }
};

/// Where the model's block starts: far enough back to be in our classes from there on.
std::size_t ourPart(const std::string& file) {
    for (const char* name : {"osgSkin::SkinModel", "osgSkin--SkinModel"})
        if (file.find(name) != std::string::npos) return file.find(name);
    return std::string::npos;
}

void expectWholeOrNone(osg::Node* node) {
    if (!node) return;
    for (const osgSkin::DeformableSkin* skin : test::skinsOf(*node)) {
        if (!skin->getModel()) continue;
        EXPECT_EQ(skin->getModel()->vertexCount(),
                  skin->getRestGeometry()->getVertexArray()->getNumElements());
        EXPECT_NE(skin->getDeformedGeometry(), nullptr);
    }
}

} // namespace

TEST_P(HostileFile, CutShortInTheModelIsRefused) {
    const std::string good = test::save(*test::makeScene(), GetParam());
    const std::size_t start = ourPart(good);
    ASSERT_NE(start, std::string::npos);
    // Further on, OSG's XML parser makes do with what is there.
    const std::size_t end = good.find("</osgSkin--SkinModel", start);
    for (std::size_t size = start; size + 1000 < std::min(end, good.size()); size += 211)
        EXPECT_EQ(test::load(good.substr(0, size), GetParam()), nullptr) << size;
    for (std::size_t size = end; size < good.size(); size += 97)
        expectWholeOrNone(test::load(good.substr(0, size), GetParam()));
}

TEST_P(HostileFile, AlteredInTheModelIsWholeOrRefused) {
    const std::string good = test::save(*test::makeScene(), GetParam());
    const std::size_t start = ourPart(good) + 24;
    for (std::size_t place = start; place < good.size(); place += 97) {
        std::string bad = good;
        bad[place] = std::string(GetParam()) == "osgb" ? static_cast<char>(bad[place] ^ 0xff) : '9';
        expectWholeOrNone(test::load(bad, GetParam()));
    }
}

TEST_P(HostileFile, ReasonIsNamed) {
    if (std::string(GetParam()) == "osgb") GTEST_SKIP() << "text formats only";
    std::string bad = test::save(*test::makeScene(), GetParam());
    // The first row of the block: its length, then the version.
    const std::size_t row = bad.find("16 1 3 ", ourPart(bad));
    ASSERT_NE(row, std::string::npos);
    bad[row + 3] = '7';
    std::string reason;
    EXPECT_EQ(test::load(bad, GetParam(), &reason), nullptr);
    EXPECT_NE(reason.find("version 7"), std::string::npos) << reason;
}

INSTANTIATE_TEST_SUITE_P(Formats, HostileFile, testing::Values("osgt", "osgb", "osgx"),
                         [](const auto& format) { return std::string(format.param); });
