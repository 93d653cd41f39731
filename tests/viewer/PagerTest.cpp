// SPDX-License-Identifier: MIT
// Characters that a DatabasePager loads when the camera approaches and unloads when it leaves.
#include "FindNodes.h"
#include "Window.h"

#include <osgSkin/DeformableSkin>

#include <osg/PagedLOD>
#include <osgDB/DatabasePager>
#include <osgDB/ReadFile>
#include <osgDB/WriteFile>

#include <OpenThreads/Thread>
#include <gtest/gtest.h>

#include <algorithm>

namespace {

class Pager : public testing::Test {
protected:
    void SetUp() override {
        const std::string file = OSGSKIN_TEST_OUTPUT "/paged.osgb";
        const osg::ref_ptr<osg::Node> thrower =
            osgDB::readRefNodeFile(OSGSKIN_DATA "/thrower.skin");
        ASSERT_NE(thrower, nullptr);
        ASSERT_TRUE(osgDB::writeNodeFile(*thrower, file));
        for (int i = 0; i < 3; ++i) {
            const osg::ref_ptr<osg::PagedLOD> paged = new osg::PagedLOD;
            paged->setFileName(0, file);
            paged->setRange(0, 0.0f, 20.0f);
            paged->setCenter(osg::Vec3(2.0f * static_cast<float>(i) - 2.0f, 0, 1));
            paged->setRadius(3.0f);
            lods.push_back(paged);
            scene->addChild(paged);
        }
    }

    /// Draws until `done`, but gives up after a large number of frames.
    template <typename Done>
    bool drawUntil(test::Windows& windows, double y, const Done& done) {
        for (int i = 0; i < 400; ++i) {
            windows.viewer.getView(0)->getCamera()->setViewMatrixAsLookAt(
                osg::Vec3d(0, y, 1), osg::Vec3d(0, y + 1.0, 1), osg::Vec3d(0, 0, 1));
            windows.frame(time += 0.02);
            if (done()) return true;
            OpenThreads::Thread::microSleep(5000);
        }
        return false;
    }

    osg::ref_ptr<osg::Group> scene = new osg::Group;
    std::vector<osg::ref_ptr<osg::PagedLOD>> lods;
    double time = 0.0;
};

} // namespace

TEST_F(Pager, LoadsAndUnloadsCharacters) {
    test::Windows windows(scene, osg::Vec3d(0, -100, 1), osg::Vec3d(), 1,
                          osgViewer::ViewerBase::DrawThreadPerContext);
    windows.viewer.getView(0)->getDatabasePager()->setTargetMaximumNumberOfPageLOD(0);
    for (int round = 0; round < 3; ++round) {
        const auto all = [&](auto&& has) { return std::all_of(lods.begin(), lods.end(), has); };
        ASSERT_TRUE(drawUntil(windows, -10.0, [&] {
            return all([](const auto& lod) { return lod->getNumChildren() == 1; });
        })) << "not loaded";
        const auto skins = test::findNodes<osgSkin::DeformableSkin>(*lods[1]);
        ASSERT_FALSE(skins.empty());
        const osgSkin::DeformableSkin* skin = skins.front().node;
        const unsigned int before = skin->getDeformCount();
        for (int i = 0; i < 10; ++i) windows.frame(time += 0.02);
        EXPECT_EQ(skin->getDeformCount(), before + 10);
        EXPECT_GT(skin->getModel()->vertexCount(), 1000u);
        ASSERT_TRUE(drawUntil(windows, -500.0, [&] {
            return all([](const auto& lod) { return lod->getNumChildren() == 0; });
        })) << "not dropped";
    }
}
