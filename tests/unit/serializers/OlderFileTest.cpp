// SPDX-License-Identifier: MIT
// tests/data/saved holds makeScene(Tube(9, 6)) as it was written when files called a model
// osgSkin::SharedSkinModel. Such files are read as ever, and written with today's names.
#include "SavedScene.h"
#include "TextFile.h"
#include "serialize/SkinModelBlock.h"

#include <osgSkin/AutoPlayManager>
#include <osgSkin/UpdateDeformableSkin>

#include <gtest/gtest.h>

#include <cmath>

namespace {

const osg::Vec3Array& vertices(const osg::Geometry& geometry) {
    return static_cast<const osg::Vec3Array&>(*geometry.getVertexArray());
}

class OlderFile : public testing::TestWithParam<const char*> {
protected:
    void SetUp() override {
        const std::string file =
            test::fileText(std::string(OSGSKIN_TEST_DATA "/saved/tube.") + GetParam());
        ASSERT_NE(file.find("SharedSkinModel"), std::string::npos);
        std::string reason;
        scene = test::load(file, GetParam(), &reason);
        ASSERT_NE(scene, nullptr) << reason;
        is = test::skinsOf(*scene);
        ASSERT_EQ(is.size(), 2u);
        was = test::skinsOf(*expected);
    }

    osg::ref_ptr<osg::Group> expected = test::makeScene(test::Tube(9, 6));
    osg::ref_ptr<osg::Node> scene;
    std::vector<osgSkin::DeformableSkin*> was, is;
};

} // namespace

TEST_P(OlderFile, HoldsTheModelThatItWasWrittenWith) {
    const std::vector<std::uint32_t> a = osgSkin::packSkinModel(*was[0]->getModel());
    const std::vector<std::uint32_t> b = osgSkin::packSkinModel(*is[0]->getModel());
    EXPECT_EQ(is[0]->getModel()->joints()[1].name, "middle");
    ASSERT_EQ(b.size(), a.size());
    // Normals come from sines and cosines, which are not the same to the bit everywhere.
    const auto& positions = is[0]->getModel()->positions();
    const auto& normals = is[0]->getModel()->normals();
    ASSERT_EQ(positions.size(), 54u);
    for (std::size_t v = 0; v < positions.size(); ++v)
        for (int axis = 0; axis < 3; ++axis) {
            EXPECT_NEAR(positions[v][axis], was[0]->getModel()->positions()[v][axis], 1e-6f);
            EXPECT_NEAR(normals[v][axis], was[0]->getModel()->normals()[v][axis], 1e-6f);
        }
    EXPECT_EQ(is[1]->getModel(), is[0]->getModel());
    EXPECT_EQ(is[1]->getRestGeometry(), is[0]->getRestGeometry());
}

TEST_P(OlderFile, HoldsTheRestOfTheSkins) {
    for (std::size_t i = 0; i < 2; ++i) {
        EXPECT_EQ(is[i]->getName(), was[i]->getName());
        EXPECT_EQ(is[i]->getEager(), was[i]->getEager());
        EXPECT_EQ(is[i]->getTangentAttribute(), was[i]->getTangentAttribute());
        const auto* callback =
            dynamic_cast<osgSkin::UpdateDeformableSkin*>(is[i]->getUpdateCallback());
        ASSERT_NE(callback, nullptr);
        // False was the default, and is left out of text files.
        EXPECT_EQ(callback->getUnwrapTwist(), i == 0);
    }
    EXPECT_NE(dynamic_cast<osgSkin::AutoPlayManager*>(scene->getUpdateCallback()), nullptr);
}

TEST_P(OlderFile, HoldsThePose) {
    for (std::size_t i = 0; i < 2; ++i) {
        const osg::Vec3Array& a = vertices(*was[i]->getDeformedGeometry());
        const osg::Vec3Array& b = vertices(*is[i]->getDeformedGeometry());
        ASSERT_EQ(b.size(), a.size());
        for (std::size_t v = 0; v < a.size(); ++v) ASSERT_LE((a[v] - b[v]).length(), 2e-6f);
    }
    const osg::Vec3Array& posed = vertices(*is[0]->getDeformedGeometry());
    EXPECT_GT((posed.back() - vertices(*is[0]->getRestGeometry()).back()).length(), 0.1f);
}

TEST_P(OlderFile, IsWrittenWithTodaysNames) {
    const std::string again = test::save(*scene, GetParam());
    EXPECT_EQ(again.find("SharedSkinModel"), std::string::npos);
    const osg::ref_ptr<osg::Node> back = test::load(again, GetParam());
    ASSERT_NE(back, nullptr);
    const auto skins = test::skinsOf(*back);
    ASSERT_EQ(skins.size(), 2u);
    EXPECT_EQ(osgSkin::packSkinModel(*skins[0]->getModel()),
              osgSkin::packSkinModel(*is[0]->getModel()));
    EXPECT_EQ(skins[1]->getModel(), skins[0]->getModel());
}

INSTANTIATE_TEST_SUITE_P(Formats, OlderFile, testing::Values("osgt", "osgb", "osgx"),
                         [](const auto& format) { return std::string(format.param); });
