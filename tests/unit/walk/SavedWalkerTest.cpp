// SPDX-License-Identifier: MIT
#include "Notices.h"
#include "WalkedPath.h"

#include <osg/ComputeBoundsVisitor>
#include <osgDB/ReadFile>
#include <osgDB/Registry>
#include <osgDB/WriteFile>

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <sstream>
#include <string>

namespace {

osg::ref_ptr<osgSkin::Walker> saved(const osg::Node& node, const std::string& extension) {
    const std::string file = testing::TempDir() + "/walker." + extension;
    if (!osgDB::writeNodeFile(node, file)) return nullptr;
    return dynamic_cast<osgSkin::Walker*>(osgDB::readRefNodeFile(file).get());
}

class SavedWalker : public testing::TestWithParam<const char*> {};

TEST_P(SavedWalker, WalksAsBefore) {
    const osg::ref_ptr<osgSkin::Walker> made = walking::makeFigureWalker();
    made->setStep(0.02);
    const osg::ref_ptr<osgSkin::Walker> read = saved(*made, GetParam());
    ASSERT_TRUE(read);
    EXPECT_FLOAT_EQ(static_cast<float>(read->getStep()), 0.02f);
    EXPECT_EQ(read->getGaits()->get().walking.stride, made->getGaits()->get().walking.stride);
    ASSERT_EQ(read->getGaits()->get().others.size(), 1u);
    walking::Walk first(made), second(read);
    for (int i = 0; i < 60; ++i) {
        first.show({0.03 * i, 0, 0}, 0.0, 0.02);
        second.show({0.03 * i, 0, 0}, 0.0, 0.02);
        ASSERT_LT(walking::difference(walking::verticesOf(*first.transform),
                                      walking::verticesOf(*second.transform)),
                  5e-4);
    }
}

INSTANTIATE_TEST_SUITE_P(SavedWalker, SavedWalker, testing::Values("osgb", "osgt", "osgx"));

osg::BoundingBox boundsOf(osg::Node& node) {
    osg::ComputeBoundsVisitor bounds;
    node.accept(bounds);
    return bounds.getBoundingBox();
}

TEST(SavedWalker, HasTheBoundsOfTheStandingFigure) {
    walking::Walk walk;
    for (int i = 0; i < 60; ++i) walk.show({0.03 * i, 0, 0}, 0.0, 0.02);
    const osg::ref_ptr<osgSkin::Walker> read = saved(*walk.walker, "osgb"); // in mid-stride
    ASSERT_TRUE(read);
    osg::BoundingBox standing;
    for (const osg::Vec3d& vertex : walking::verticesOf(*walking::makeFigureWalker()))
        standing.expandBy(vertex);
    const osg::BoundingBox box = boundsOf(*read);
    EXPECT_LT((box._min - standing._min).length(), 1e-3);
    EXPECT_LT((box._max - standing._max).length(), 1e-3);
}

TEST(SavedWalker, CopiesInOneFileShareTheirGaits) {
    const osg::ref_ptr<osgSkin::Walker> walker = walking::makeFigureWalker();
    const osg::ref_ptr<osg::Group> group = new osg::Group;
    group->addChild(walker);
    group->addChild(osg::clone(walker.get(), osg::CopyOp(osg::CopyOp::SHALLOW_COPY)));
    const std::string file = testing::TempDir() + "/walkers.osgb";
    ASSERT_TRUE(osgDB::writeNodeFile(*group, file));
    const osg::ref_ptr<osg::Node> read = osgDB::readRefNodeFile(file);
    ASSERT_TRUE(read);
    const auto walkers = test::findNodes<osgSkin::Walker>(*read);
    ASSERT_EQ(walkers.size(), 2u);
    EXPECT_EQ(walkers[0].node->getGaits(), walkers[1].node->getGaits());
    EXPECT_NE(walkers[0].node, walkers[1].node);
}

TEST(SavedWalker, EqualFilesShareTheirClips) {
    const osg::ref_ptr<osgSkin::Walker> made = walking::makeFigureWalker();
    std::vector<osg::ref_ptr<osgSkin::Walker>> read;
    for (const char* name : {"anna", "berta"}) {
        const std::string file = testing::TempDir() + "/" + name + ".osgb";
        ASSERT_TRUE(osgDB::writeNodeFile(*made, file));
        read.push_back(dynamic_cast<osgSkin::Walker*>(osgDB::readRefNodeFile(file).get()));
        ASSERT_TRUE(read.back());
    }
    EXPECT_NE(read[0]->getGaits(), read[1]->getGaits());
    EXPECT_EQ(read[0]->getGaits()->get().walking.clip, read[1]->getGaits()->get().walking.clip);
}

std::string bytesOf(const std::string& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

TEST(SavedWalker, DamagedFileIsRefusedOrRead) {
    const std::string file = testing::TempDir() + "/whole.osgb";
    ASSERT_TRUE(osgDB::writeNodeFile(*walking::makeFigureWalker(), file));
    const std::string whole = bytesOf(file);
    const test::Notices quiet;
    std::size_t refused = 0;
    osgDB::ReaderWriter* const reader =
        osgDB::Registry::instance()->getReaderWriterForExtension("osgb");
    // The gaits are the last part of the file.
    for (std::size_t i = whole.size() / 2; i < whole.size(); i += 1009) {
        std::istringstream cut(whole.substr(0, i));
        if (!reader->readNode(cut).validNode()) ++refused;
    }
    EXPECT_GT(refused, 10u);
}

} // namespace
