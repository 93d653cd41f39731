// SPDX-License-Identifier: MIT
// Skins written by osgDB's plug-ins of other formats, whose visitors know osg::Geometry alone.
#include "TubeSkin.h"

#include <osgSkin/RigidPart>

#include <osg/ComputeBoundsVisitor>
#include <osg/Group>
#include <osgDB/ReadFile>
#include <osgDB/WriteFile>

#include <gtest/gtest.h>

#include <string>

namespace {

class OtherFormat : public testing::TestWithParam<const char*> {};

osg::BoundingBox boundsOf(osg::Node& scene) {
    osg::ComputeBoundsVisitor visitor;
    scene.accept(visitor);
    return visitor.getBoundingBox();
}

} // namespace

TEST_P(OtherFormat, HasPosedSkinAndRigidPart) {
    const osg::ref_ptr<osg::Group> scene = new osg::Group;
    const osg::ref_ptr<osgSkin::DeformableSkin> skin = test::makeSkin();
    skin->setName("tube");
    test::bend(*skin, 1.0);
    scene->addChild(skin);
    // A head beside it.
    const osg::ref_ptr<osg::Geometry> head =
        osg::createTexturedQuadGeometry(osg::Vec3(3, 0, 0), osg::Vec3(1, 0, 0), osg::Vec3(0, 1, 0));
    const osg::ref_ptr<osgSkin::RigidPart> part = new osgSkin::RigidPart;
    part->setMatrix(osg::Matrix::translate(0, 0, 5));
    part->addChild(head);
    scene->addChild(part);
    const std::string file = testing::TempDir() + "osgskin_posed." + GetParam();
    ASSERT_TRUE(osgDB::writeNodeFile(*scene, file));
    const osg::ref_ptr<osgDB::Options> asTheyAre = new osgDB::Options("noRotation");
    const osg::ref_ptr<osg::Node> read = osgDB::readRefNodeFile(file, asTheyAre);
    ASSERT_NE(read, nullptr);
    osg::BoundingBox expected;
    const osg::Geometry& posed = *skin->getDeformedGeometry();
    for (const osg::Vec3& v : static_cast<const osg::Vec3Array&>(*posed.getVertexArray()))
        expected.expandBy(v);
    expected.expandBy(osg::Vec3(4, 1, 5));
    const osg::BoundingBox box = boundsOf(*read);
    EXPECT_LT((box._min - expected._min).length(), 1e-3);
    EXPECT_LT((box._max - expected._max).length(), 1e-3);
}

INSTANTIATE_TEST_SUITE_P(Formats, OtherFormat, testing::Values("obj", "stl", "dxf", "3ds"),
                         [](const auto& tested) { return std::string("as_") + tested.param; });
