// SPDX-License-Identifier: MIT
#include <osgSkin/DeformableSkin>
#include <osgSkin/Error>
#include <osgSkin/GlmOsg>
#include <osgSkin/UpdateDeformableSkin>

#include "Notices.h"
#include "SomeCorrectives.h"
#include "TubeSkin.h"

#include <osg/TriangleFunctor>
#include <osgUtil/LineSegmentIntersector>
#include <osgUtil/Optimizer>
#include <osgUtil/UpdateVisitor>

#include <gtest/gtest.h>

#include <cmath>

using test::bend;
using test::cull;
using test::makeBones;
using test::makeGeometry;
using test::makeSkin;

namespace {

struct Count {
    unsigned int triangles = 0;
    void operator()(const osg::Vec3&, const osg::Vec3&, const osg::Vec3&, bool = false) {
        ++triangles;
    }
};

struct OpenSkin : osgSkin::DeformableSkin {
    bool isBounded() const { return _boundingSphereComputed; }
};

} // namespace

TEST(DeformableSkin, DefaultIsEmptyAndHarmless) {
    const osg::ref_ptr<osgSkin::DeformableSkin> skin = new osgSkin::DeformableSkin;
    EXPECT_EQ(skin->getDeformedGeometry(), nullptr);
    EXPECT_FALSE(skin->setPose(std::vector<osg::Matrixd>()));
    EXPECT_FALSE(skin->getBoundingBox().valid());
    cull(*skin, true);
    osg::TriangleFunctor<Count> count;
    skin->accept(count);
    EXPECT_EQ(count.triangles, 0u);
}

TEST(DeformableSkin, RefusesGeometryThatDoesNotFit) {
    const osg::ref_ptr<osgSkin::DeformableSkin> skin = new osgSkin::DeformableSkin;
    EXPECT_THROW(skin->setSkin(nullptr, test::Tube().model()), osgSkin::Error);
    EXPECT_THROW(skin->setSkin(makeGeometry(test::Tube()), nullptr), osgSkin::Error);
    EXPECT_THROW(skin->setSkin(makeGeometry(test::Tube(9)), test::Tube().model()), osgSkin::Error);
    // Picking would read beyond the vertices, or beyond the indices.
    for (const std::vector<GLuint>& corners : {std::vector<GLuint>{0, 1, 1000000}, {0, 1, 2, 3}}) {
        const osg::ref_ptr<osg::Geometry> broken = makeGeometry(test::Tube());
        broken->addPrimitiveSet(
            new osg::DrawElementsUInt(GL_TRIANGLES, corners.begin(), corners.end()));
        EXPECT_THROW(skin->setSkin(broken, test::Tube().model()), osgSkin::Error);
    }
    // A driver would read beyond an array, and what is saved would be refused.
    for (const auto binding : {osg::Array::BIND_PER_VERTEX, osg::Array::BIND_OVERALL}) {
        const osg::ref_ptr<osg::Geometry> lacking = makeGeometry(test::Tube());
        lacking->setTexCoordArray(0, new osg::Vec2Array(3), binding);
        if (binding == osg::Array::BIND_PER_VERTEX)
            EXPECT_THROW(skin->setSkin(lacking, test::Tube().model()), osgSkin::Error);
        else
            EXPECT_NO_THROW(osg::ref_ptr<osgSkin::DeformableSkin>(new osgSkin::DeformableSkin)
                                ->setSkin(lacking, test::Tube().model()));
    }
    EXPECT_EQ(skin->getModel(), nullptr);
}

TEST(DeformableSkin, DeformsOncePerPoseAndOnlyWhenSeen) {
    const auto skin = makeSkin();
    bend(*skin, 0.3);
    EXPECT_EQ(skin->getDeformCount(), 0u);
    cull(*skin, false);
    EXPECT_EQ(skin->getDeformCount(), 0u);
    cull(*skin, true);
    cull(*skin, true);
    cull(*skin, true);
    EXPECT_EQ(skin->getDeformCount(), 1u);
    bend(*skin, 0.4);
    cull(*skin, true);
    EXPECT_EQ(skin->getDeformCount(), 2u);
}

TEST(DeformableSkin, EagerDeformsAtOnce) {
    const auto skin = makeSkin();
    skin->setEager(true);
    bend(*skin, 0.3);
    EXPECT_EQ(skin->getDeformCount(), 1u);
}

TEST(DeformableSkin, PickingHitsThePosedSkin) {
    const auto skin = makeSkin();
    bend(*skin, osg::PI_2); // the upper part now points along +z
    const auto hits = [&skin](const osg::Vec3d& from, const osg::Vec3d& to) {
        const osg::ref_ptr<osgUtil::LineSegmentIntersector> line =
            new osgUtil::LineSegmentIntersector(from, to);
        osgUtil::IntersectionVisitor visitor(line);
        skin->accept(visitor);
        return line->containsIntersections();
    };
    EXPECT_TRUE(hits({-5, 2, 3}, {5, 2, 3}));
    EXPECT_FALSE(hits({-5, 5, 0}, {5, 5, 0}));
}

TEST(DeformableSkin, BoundsFollowThePose) {
    const auto skin = makeSkin();
    EXPECT_TRUE(skin->getBoundingBox().contains({0, 5.9f, 0}));
    bend(*skin, osg::PI_2);
    EXPECT_FALSE(skin->getBoundingBox().contains({0, 5.9f, 0}));
    EXPECT_TRUE(skin->getBoundingBox().contains({0, 2, 3.9f}));
}

/// Or cull threads that begin at once would work it out at once.
TEST(DeformableSkin, KnowsItsBoundAsSoonAsItIsPosed) {
    const osg::ref_ptr<osgSkin::DeformableSkin> of = makeSkin();
    const osg::ref_ptr<OpenSkin> skin = new OpenSkin;
    skin->setSkin(new osg::Geometry(*of->getRestGeometry()), of->getModel());
    EXPECT_TRUE(skin->isBounded());
    bend(*skin, 0.7);
    EXPECT_TRUE(skin->isBounded());
}

TEST(DeformableSkin, CopiesShareTheModelAndOwnTheirPose) {
    const auto skin = makeSkin();
    bend(*skin, 0.5);
    const osg::ref_ptr<osgSkin::DeformableSkin> copy =
        osg::clone(skin.get(), osg::CopyOp::DEEP_COPY_ALL);
    EXPECT_EQ(copy->getModel(), skin->getModel());
    const osg::Vec3 before =
        static_cast<const osg::Vec3Array*>(copy->getDeformedGeometry()->getVertexArray())->back();
    bend(*skin, 1.0);
    skin->getDeformedGeometry();
    EXPECT_EQ(
        static_cast<const osg::Vec3Array*>(copy->getDeformedGeometry()->getVertexArray())->back(),
        before);
}

TEST(DeformableSkin, OptimizerLeavesItAlone) {
    const osg::ref_ptr<osg::MatrixTransform> scene =
        new osg::MatrixTransform(osg::Matrix::translate(10, 0, 0));
    scene->setDataVariance(osg::Object::STATIC);
    scene->addChild(makeSkin());
    scene->addChild(makeSkin());
    osgUtil::Optimizer().optimize(scene, osgUtil::Optimizer::ALL_OPTIMIZATIONS);
    ASSERT_EQ(scene->getNumChildren(), 2u);
    for (unsigned int i = 0; i < 2; ++i) {
        const auto* skin = dynamic_cast<osgSkin::DeformableSkin*>(scene->getChild(i));
        ASSERT_NE(skin, nullptr);
        const auto& rest =
            static_cast<const osg::Vec3Array&>(*skin->getRestGeometry()->getVertexArray());
        EXPECT_EQ(rest.front(), osg::Vec3(1, 0, 0));
    }
}

TEST(UpdateDeformableSkin, FollowsTheBonesOfTheSkeletonAbove) {
    const osg::ref_ptr<osgAnimation::Skeleton> skeleton = makeBones();
    const auto skin = makeSkin();
    skin->setUpdateCallback(new osgSkin::UpdateDeformableSkin);
    skeleton->addChild(skin);
    auto& root = static_cast<osgAnimation::Bone&>(*skeleton->getChild(0));
    auto& middle = static_cast<osgAnimation::Bone&>(*root.getChild(0));
    auto& end = static_cast<osgAnimation::Bone&>(*middle.getChild(0));
    middle.setMatrixInSkeletonSpace(osg::Matrix::rotate(osg::PI_2, osg::Vec3(1, 0, 0)) *
                                    osg::Matrix::translate(0, 2, 0));
    end.setMatrixInSkeletonSpace(osg::Matrix::translate(0, 2, 0) *
                                 middle.getMatrixInSkeletonSpace());

    osgUtil::UpdateVisitor update;
    update.setTraversalNumber(1);
    skeleton->accept(update);
    const auto& vertices =
        static_cast<const osg::Vec3Array&>(*skin->getDeformedGeometry()->getVertexArray());
    EXPECT_LE((vertices.back() - osg::Vec3(std::cos(float(osg::PI) / 6), 2.5f, 4)).length(), 1e-5);
    EXPECT_NEAR(skin->getPose().transform(1).split.bendAngle, osg::PI_2, 1e-12);
    EXPECT_NEAR(skin->getPose().transform(2).split.bendAngle, 0.0, 1e-12);
}

TEST(UpdateDeformableSkin, AJointWithoutABoneMovesWithItsParent) {
    const osg::ref_ptr<osgAnimation::Skeleton> skeleton = makeBones();
    auto& root = static_cast<osgAnimation::Bone&>(*skeleton->getChild(0));
    auto& middle = static_cast<osgAnimation::Bone&>(*root.getChild(0));
    middle.removeChildren(0, middle.getNumChildren());
    const auto skin = makeSkin();
    const osg::ref_ptr<osgSkin::UpdateDeformableSkin> update = new osgSkin::UpdateDeformableSkin;
    middle.setMatrixInSkeletonSpace(osg::Matrix::rotate(1.0, osg::Vec3(1, 0, 0)) *
                                    osg::Matrix::translate(0, 2, 0));
    const test::Notices notices;
    ASSERT_TRUE(update->pose(*skin, *skeleton));
    EXPECT_NEAR(std::abs(skin->getPose().transform(2).rotation.w), 1.0, 1e-12);
    EXPECT_TRUE(notices.say("has no bone \"end\"; the joint moves with its parent"));
    ASSERT_TRUE(update->pose(*skin, *skeleton));
    EXPECT_EQ(notices.lines(), 1u) << notices.text();
}

/// As one that readSkeleton() adds over several.
TEST(UpdateDeformableSkin, ARootWithoutABoneIsNoNews) {
    const osg::ref_ptr<osgAnimation::Skeleton> skeleton = makeBones();
    skeleton->getChild(0)->setName("another");
    const test::Notices notices;
    const osg::ref_ptr<osgSkin::UpdateDeformableSkin> update = new osgSkin::UpdateDeformableSkin;
    ASSERT_TRUE(update->pose(*makeSkin(), *skeleton));
    EXPECT_EQ(notices.text(), "");
}

namespace {

osgAnimation::Bone& middleOf(osgAnimation::Skeleton& skeleton) {
    return static_cast<osgAnimation::Bone&>(*skeleton.getChild(0)->asGroup()->getChild(0));
}

void turn(osgAnimation::Bone& middle, double angle) {
    middle.setMatrixInSkeletonSpace(osg::Matrix::rotate(angle, osg::Vec3(1, 0, 0)) *
                                    osg::Matrix::translate(0, 2, 0));
}

double bendOf(const osgSkin::DeformableSkin& skin) {
    return skin.getPose().transform(1).split.bendAngle;
}

} // namespace

/// As of a rider, whose bones are called as the horse's.
TEST(UpdateDeformableSkin, LeavesTheBonesOfASkeletonBelowToIt) {
    const osg::ref_ptr<osgAnimation::Skeleton> skeleton = makeBones(), rider = makeBones();
    middleOf(*skeleton).addChild(rider);
    turn(middleOf(*skeleton), 0.5);
    turn(middleOf(*rider), 1.0);
    const auto skin = makeSkin(), riders = makeSkin();
    const osg::ref_ptr<osgSkin::UpdateDeformableSkin> update = new osgSkin::UpdateDeformableSkin;
    ASSERT_TRUE(update->pose(*skin, *skeleton));
    EXPECT_NEAR(bendOf(*skin), 0.5, 1e-9);
    ASSERT_TRUE(update->pose(*riders, *rider));
    EXPECT_NEAR(bendOf(*riders), 1.0, 1e-9);
}

TEST(UpdateDeformableSkin, FollowsABoneThatTakesAnothersPlace) {
    const osg::ref_ptr<osgAnimation::Skeleton> skeleton = makeBones();
    const auto skin = makeSkin();
    const osg::ref_ptr<osgSkin::UpdateDeformableSkin> update = new osgSkin::UpdateDeformableSkin;
    ASSERT_TRUE(update->pose(*skin, *skeleton));
    osg::Group& root = *skeleton->getChild(0)->asGroup();
    root.setChild(0, osg::clone(root.getChild(0), osg::CopyOp::SHALLOW_COPY));
    turn(middleOf(*skeleton), 0.5);
    ASSERT_TRUE(update->pose(*skin, *skeleton));
    EXPECT_NEAR(bendOf(*skin), 0.5, 1e-9);
}

/// It can show one pose; copies would show two.
TEST(UpdateDeformableSkin, SeveralSkeletonsOfOneSkinAreToldOf) {
    const osg::ref_ptr<osgAnimation::Skeleton> first = makeBones(), second = makeBones();
    const auto skin = makeSkin();
    skin->setUpdateCallback(new osgSkin::UpdateDeformableSkin);
    const osg::ref_ptr<osg::Group> scene = new osg::Group;
    scene->addChild(first);
    scene->addChild(second);
    osgUtil::UpdateVisitor update;
    const test::Notices notices;
    first->addChild(skin);
    scene->accept(update);
    first->removeChild(skin); // moved: no news
    second->addChild(skin);
    scene->accept(update);
    EXPECT_EQ(notices.text(), "");
    first->addChild(skin);
    scene->accept(update);
    scene->accept(update);
    EXPECT_TRUE(notices.say("is below several skeletons")) << notices.text();
    EXPECT_EQ(notices.lines(), 1u);
}

TEST(UpdateDeformableSkin, LetsCallbacksThatAreAddedToItRun) {
    struct Count : osg::DrawableUpdateCallback {
        int times = 0;
        void update(osg::NodeVisitor*, osg::Drawable*) override { ++times; }
    };
    const osg::ref_ptr<osgAnimation::Skeleton> skeleton = makeBones();
    const auto skin = makeSkin();
    const osg::ref_ptr<Count> added = new Count;
    skin->setUpdateCallback(new osgSkin::UpdateDeformableSkin);
    skin->addUpdateCallback(added);
    skeleton->addChild(skin);
    osgUtil::UpdateVisitor update;
    skeleton->accept(update);
    EXPECT_EQ(added->times, 1);
}

TEST(DeformableSkin, FollowsAnActivation) {
    test::Tube tube;
    tube.binding.correctives = test::someCorrectives(tube.binding, 0.3, 5);
    const osg::ref_ptr<osgSkin::DeformableSkin> skin = new osgSkin::DeformableSkin;
    EXPECT_FALSE(skin->setActivation("breath", 1.0f)); // no skin yet
    skin->setSkin(makeGeometry(tube), tube.model());
    const auto vertices = [](const osgSkin::DeformableSkin& of) {
        return static_cast<const osg::Vec3Array*>(of.getDeformedGeometry()->getVertexArray())
            ->asVector();
    };
    const auto atRest = vertices(*skin);
    EXPECT_EQ(skin->getActivation("breath"), 0.0f);
    EXPECT_FALSE(skin->setActivation("Breath", 1.0f));
    EXPECT_FALSE(skin->setActivation("breath", std::nanf("")));
    EXPECT_FALSE(skin->needsDeform());
    EXPECT_TRUE(skin->setActivation("breath", 0.5f));
    EXPECT_EQ(skin->getActivation("breath"), 0.5f);
    EXPECT_TRUE(skin->needsDeform());
    EXPECT_NE(vertices(*skin), atRest);
    EXPECT_TRUE(skin->setActivation("breath", 0.5f)); // the same again is no work
    EXPECT_FALSE(skin->needsDeform());
    // The pose comes and goes beside it, and copies take it along.
    bend(*skin, 0.3);
    EXPECT_EQ(skin->getActivation("breath"), 0.5f);
    const osg::ref_ptr<osgSkin::DeformableSkin> copy = new osgSkin::DeformableSkin(*skin);
    EXPECT_EQ(vertices(*copy), vertices(*skin));
    EXPECT_TRUE(copy->setActivation("breath", 0.0f));
    EXPECT_EQ(skin->getActivation("breath"), 0.5f);
    // Another geometry of the same skin is as tense.
    skin->setSkin(makeGeometry(tube), tube.model());
    EXPECT_EQ(skin->getActivation("breath"), 0.5f);
    EXPECT_NE(vertices(*skin), atRest);
}
