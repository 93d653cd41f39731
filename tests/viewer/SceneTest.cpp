// SPDX-License-Identifier: MIT
// Changes that applications make to a scene with a skin: several skins and parents, parts that are
// removed while it runs, time that stops and goes back, masks and levels of detail, picking.
#include "FindNodes.h"
#include "TubeSkin.h"
#include "UpdateAt.h"

#include <osgSkin/UpdateDeformableSkin>

#include <osg/LOD>
#include <osg/Switch>
#include <osgAnimation/BasicAnimationManager>
#include <osgDB/ReadFile>
#include <osgUtil/LineSegmentIntersector>
#include <osgUtil/PolytopeIntersector>

#include <gtest/gtest.h>

namespace {

using osgSkin::DeformableSkin;
using Vertices = std::vector<osg::Vec3>;

/// The thrower; `skin` is its skin.
struct Thrower {
    osg::ref_ptr<osg::Node> scene = osgDB::readRefNodeFile(OSGSKIN_DATA "/thrower.skin");
    DeformableSkin* skin = nullptr;

    Thrower() {
        if (scene) skin = test::findNodes<DeformableSkin>(*scene).at(0).node;
    }
    Vertices at(double time) {
        test::updateAt(*scene, time);
        return test::verticesOf(*skin);
    }
};

osg::ref_ptr<DeformableSkin> makeFollower() {
    osg::ref_ptr<DeformableSkin> skin = test::makeSkin();
    skin->setUpdateCallback(new osgSkin::UpdateDeformableSkin);
    return skin;
}

} // namespace

TEST(Scene, SeveralSkinsUnderOneSkeleton) {
    const osg::ref_ptr<osgAnimation::Skeleton> skeleton = test::makeBones();
    std::vector<osg::ref_ptr<DeformableSkin>> skins;
    for (int i = 0; i < 3; ++i) {
        skins.push_back(makeFollower());
        skeleton->addChild(skins.back());
    }
    test::rotateMiddle(*skeleton, 0.7);
    test::updateAt(*skeleton, 0.0);
    test::cull(*skeleton, true);
    for (const auto& skin : skins) {
        EXPECT_NEAR(test::bendOf(*skin), 0.7, 1e-9);
        EXPECT_EQ(skin->getDeformCount(), 1u);
    }
}

TEST(Scene, OneSkinUnderSeveralParents) {
    const osg::ref_ptr<osgAnimation::Skeleton> skeleton = test::makeBones();
    const auto skin = makeFollower();
    for (int i = 0; i < 3; ++i) {
        const osg::ref_ptr<osg::MatrixTransform> place =
            new osg::MatrixTransform(osg::Matrix::translate(2.0 * i - 2.0, 0, 0));
        place->addChild(skin);
        skeleton->addChild(place);
    }
    test::rotateMiddle(*skeleton, 0.7);
    test::updateAt(*skeleton, 0.0);
    test::cull(*skeleton, true);
    EXPECT_NEAR(test::bendOf(*skin), 0.7, 1e-9);
    EXPECT_EQ(skin->getDeformCount(), 1u);
}

TEST(Scene, SkeletonReplacedWhileRunning) {
    const osg::ref_ptr<osg::Group> root = new osg::Group;
    osg::ref_ptr<osgAnimation::Skeleton> skeleton = test::makeBones();
    root->addChild(skeleton);
    const auto skin = makeFollower();
    skeleton->addChild(skin);
    test::rotateMiddle(*skeleton, 0.7);
    test::updateAt(*root, 0.0);
    skeleton->removeChild(skin);
    root->removeChild(skeleton);
    skeleton = nullptr;
    root->addChild(skin);
    test::updateAt(*root, 0.1); // no skeleton: the pose stays
    test::cull(*root, true);
    EXPECT_NEAR(test::bendOf(*skin), 0.7, 1e-9);
    root->removeChild(skin);
    skeleton = test::makeBones();
    skeleton->addChild(skin);
    root->addChild(skeleton);
    test::rotateMiddle(*skeleton, 0.2);
    test::updateAt(*root, 0.2);
    EXPECT_NEAR(test::bendOf(*skin), 0.2, 1e-9);
}

TEST(Scene, BonesRemovedWhileRunning) {
    const osg::ref_ptr<osgAnimation::Skeleton> skeleton = test::makeBones();
    const auto skin = makeFollower();
    skeleton->addChild(skin);
    test::updateAt(*skeleton, 0.0);
    skeleton->removeChild(skeleton->getChild(0)); // the bones; the callback keeps them alive
    test::updateAt(*skeleton, 0.1);
    test::cull(*skeleton, true);
    EXPECT_NEAR(test::bendOf(*skin), 0.0, 1e-9);
}

TEST(Scene, CallbackRemovedAndSetAgain) {
    const osg::ref_ptr<osgAnimation::Skeleton> skeleton = test::makeBones();
    const auto skin = makeFollower();
    skeleton->addChild(skin);
    test::rotateMiddle(*skeleton, 0.7);
    test::updateAt(*skeleton, 0.0);
    skin->setUpdateCallback(nullptr);
    test::rotateMiddle(*skeleton, 0.3);
    test::updateAt(*skeleton, 0.1);
    EXPECT_NEAR(test::bendOf(*skin), 0.7, 1e-9);
    skin->setUpdateCallback(new osgSkin::UpdateDeformableSkin);
    test::updateAt(*skeleton, 0.2);
    EXPECT_NEAR(test::bendOf(*skin), 0.3, 1e-9);
}

TEST(Scene, TimeMayStopAndGoBack) {
    Thrower forwards, about;
    ASSERT_NE(forwards.skin, nullptr);
    forwards.at(0.0);
    about.at(0.0);
    const std::vector<double> times = {0.3, 0.8, 1.3, 1.8};
    std::vector<Vertices> poses;
    poses.reserve(times.size());
    for (const double time : times) poses.push_back(forwards.at(time));
    EXPECT_NE(poses[0], poses[1]);
    for (const std::size_t i : {3u, 1u, 1u, 0u, 2u, 3u, 2u, 1u, 0u})
        EXPECT_EQ(about.at(times[i]), poses[i]) << times[i];
}

TEST(Scene, PausedCharactersAreNotDeformed) {
    Thrower thrower;
    ASSERT_NE(thrower.skin, nullptr);
    thrower.at(0.5);
    const unsigned int count = thrower.skin->getDeformCount();
    for (int i = 0; i < 5; ++i) thrower.at(0.5);
    EXPECT_EQ(thrower.skin->getDeformCount(), count);
}

TEST(Scene, MaskedSkinsAreNotDeformed) {
    const osg::ref_ptr<osg::Switch> scene = new osg::Switch;
    const auto skin = test::makeSkin();
    const auto other = test::makeSkin();
    scene->addChild(skin, true);
    scene->addChild(other, false);
    skin->setNodeMask(0);
    test::bend(*skin, 0.3);
    test::cull(*scene, true);
    EXPECT_EQ(skin->getDeformCount(), 0u);
    EXPECT_EQ(other->getDeformCount(), 0u);
    skin->setNodeMask(~0u);
    test::cull(*scene, true);
    EXPECT_EQ(skin->getDeformCount(), 1u);
}

TEST(Scene, OnlyTheVisibleLevelOfDetailIsDeformed) {
    const osg::ref_ptr<osg::LOD> lod = new osg::LOD;
    const auto close = test::makeSkin();
    const auto distant = test::makeSkin();
    lod->addChild(close, 0.0f, 10.0f);
    lod->addChild(distant, 10.0f, 1000.0f);
    for (const auto& skin : {close, distant}) test::bend(*skin, 0.3);
    test::cull(*lod, true); // from a distance of 30
    EXPECT_EQ(close->getDeformCount(), 0u);
    EXPECT_EQ(distant->getDeformCount(), 1u);
}

TEST(Scene, CharactersOutOfViewAreNotDeformed) {
    Thrower thrower;
    ASSERT_NE(thrower.skin, nullptr);
    test::updateAt(*thrower.scene, 1.0);
    test::cull(*thrower.scene, false);
    EXPECT_EQ(thrower.skin->getDeformCount(), 0u);
}

TEST(Scene, PickingHitsThePosedArm) {
    const auto skin = test::makeSkin();
    const auto line = [&](const osg::Vec3d& from, const osg::Vec3d& to) {
        const osg::ref_ptr<osgUtil::LineSegmentIntersector> pick =
            new osgUtil::LineSegmentIntersector(from, to);
        osgUtil::IntersectionVisitor visitor(pick);
        skin->accept(visitor);
        return pick->containsIntersections();
    };
    const auto box = [&](const osg::Vec3d& centre) {
        osg::Polytope polytope;
        for (int axis = 0; axis < 3; ++axis)
            for (const double side : {-1.0, 1.0}) {
                osg::Vec3d normal;
                normal[axis] = side;
                polytope.add(osg::Plane(normal, centre - normal * 1.2));
            }
        const osg::ref_ptr<osgUtil::PolytopeIntersector> pick =
            new osgUtil::PolytopeIntersector(polytope);
        osgUtil::IntersectionVisitor visitor(pick);
        skin->accept(visitor);
        return pick->containsIntersections();
    };
    const osg::Vec3d restEnd(0, 5, 0), posedEnd(0, 2, 3), aside(5, 0, 0);
    EXPECT_TRUE(line(restEnd - aside, restEnd + aside));
    EXPECT_TRUE(box(restEnd));
    EXPECT_FALSE(line(posedEnd - aside, posedEnd + aside));
    EXPECT_FALSE(box(posedEnd));
    test::bend(*skin, osg::PI_2);
    EXPECT_FALSE(line(restEnd - aside, restEnd + aside));
    EXPECT_FALSE(box(restEnd));
    EXPECT_TRUE(line(posedEnd - aside, posedEnd + aside));
    EXPECT_TRUE(box(posedEnd));
}
