// SPDX-License-Identifier: MIT
//
// Files truncated or altered within our own classes: no crash, and no incomplete character.
#include "SavedScene.h"

#include <osgSkin/AutoPlayManager>

#include <gtest/gtest.h>
#include <osg/Notify>
#include <osgAnimation/Channel>

#include <algorithm>
#include <cmath>

namespace {

class HostileFile : public test::Quietly<const char*> {};

/// The offset of the model's block; everything from there on is in our classes.
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

TEST_P(HostileFile, TruncationInTheModelIsRefused) {
    const std::string good = test::save(*test::makeScene(), GetParam());
    const std::size_t start = ourPart(good);
    ASSERT_NE(start, std::string::npos);
    // After that, OSG's XML parser accepts anything.
    const std::size_t end = good.find("</osgSkin--SkinModel", start);
    for (std::size_t size = start; size + 1000 < std::min(end, good.size()); size += 211)
        EXPECT_EQ(test::load(good.substr(0, size), GetParam()), nullptr) << size;
    for (std::size_t size = end; size < good.size(); size += 97)
        expectWholeOrNone(test::load(good.substr(0, size), GetParam()));
}

TEST_P(HostileFile, AlteredModelIsReadWholeOrRefused) {
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
    // The first row of the block: its length, the number of joints, the root's parent.
    const std::string row = "16 3 4294967295 ";
    const std::size_t start = bad.find(row, ourPart(bad));
    ASSERT_NE(start, std::string::npos);
    bad.replace(start, row.size(), "16 3 1 ");
    std::string reason;
    EXPECT_EQ(test::load(bad, GetParam(), &reason), nullptr);
    EXPECT_NE(reason.find("after its parent"), std::string::npos) << reason;
}

TEST(HostileFiles, OfAnotherVersionIsRefused) {
    std::string older = test::save(*test::makeScene(), "osgt");
    const std::string name = "FileVersion ";
    ASSERT_NE(older.find(name), std::string::npos);
    older.replace(older.find(name) + name.size(), 1, "4");
    std::string reason;
    EXPECT_EQ(test::load(older, "osgt", &reason), nullptr);
    EXPECT_NE(reason.find("another version"), std::string::npos) << reason;
    EXPECT_NE(reason.find("osgconv character.skin character.osgb"), std::string::npos) << reason;
}

/// What is written can be read.
TEST_P(HostileFile, IsNotWritten) {
    const osg::ref_ptr<osg::Group> scene = test::makeScene();
    const osg::ref_ptr<osgAnimation::FloatLinearChannel> channel =
        new osgAnimation::FloatLinearChannel;
    channel->getOrCreateSampler()->getOrCreateKeyframeContainer()->push_back({0.0, NAN});
    auto& manager = dynamic_cast<osgSkin::AutoPlayManager&>(*scene->getUpdateCallback());
    manager.getAnimationList().front()->addChannel(channel);
    EXPECT_EQ(test::save(*scene, GetParam()), "");
}

INSTANTIATE_TEST_SUITE_P(Formats, HostileFile, testing::Values("osgt", "osgb", "osgx"),
                         [](const auto& format) { return std::string(format.param); });
