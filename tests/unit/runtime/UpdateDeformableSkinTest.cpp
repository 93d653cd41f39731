// SPDX-License-Identifier: MIT
#include "Notices.h"
#include "PlayedFigure.h"

#include <osgSkin/UpdateDeformableSkin>

#include <gtest/gtest.h>
#include <osg/observer_ptr>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

using namespace played;
using test::makeBones;
using test::makeSkin;

TEST(UpdateDeformableSkin, FollowsTheBonesOfTheSkeletonAbove) {
    const osg::ref_ptr<osgAnimation::Skeleton> skeleton = makeBones();
    const auto skin = makeSkin();
    skin->setUpdateCallback(new osgSkin::UpdateDeformableSkin);
    skeleton->addChild(skin);
    test::rotateMiddle(*skeleton, osg::PI_2);
    test::updateAt(*skeleton, 0.0);
    const osg::Vec3 last = verticesOf(*skin).back();
    EXPECT_LE((last - osg::Vec3(std::cos(float(osg::PI) / 6), 2.5f, 4)).length(), 1e-5);
    EXPECT_NEAR(test::bendOf(*skin), osg::PI_2, 1e-12);
    EXPECT_NEAR(skin->getPose().transform(2).split.bendAngle, 0.0, 1e-12);
}

TEST(UpdateDeformableSkin, JointWithoutABoneFollowsItsParent) {
    const osg::ref_ptr<osgAnimation::Skeleton> skeleton = makeBones();
    test::rotateMiddle(*skeleton, 1.0);
    test::middleOf(*skeleton).removeChild(0, 1);
    const auto skin = makeSkin();
    const osg::ref_ptr<osgSkin::UpdateDeformableSkin> update = new osgSkin::UpdateDeformableSkin;
    const test::Notices notices;
    ASSERT_TRUE(update->pose(*skin, *skeleton));
    EXPECT_NEAR(std::abs(skin->getPose().transform(2).rotation.w), 1.0, 1e-12);
    EXPECT_TRUE(notices.say("has no bone \"end\"; the joint moves with its parent"));
    ASSERT_TRUE(update->pose(*skin, *skeleton));
    EXPECT_EQ(notices.lines(), 1u) << notices.text();
}

/// Such as bones that carry nothing, which osgUtil::Optimizer removes.
TEST(UpdateDeformableSkin, DoesNotWarnAboutABoneThatNoVertexFollows) {
    test::Tube tube;
    const glm::dvec3 y(0, 1, 0);
    tube.binding.joints.push_back({"tip", 2, {0, 6, 0}, y, y});
    const osg::ref_ptr<osgSkin::DeformableSkin> skin = new osgSkin::DeformableSkin;
    skin->setSkin(test::makeGeometry(tube), tube.model());
    const test::Notices notices;
    const osg::ref_ptr<osgSkin::UpdateDeformableSkin> update = new osgSkin::UpdateDeformableSkin;
    ASSERT_TRUE(update->pose(*skin, *makeBones()));
    EXPECT_EQ(notices.text(), "");
}

TEST(UpdateDeformableSkin, WarnsOnceAboutSeveralMissingBones) {
    const osg::ref_ptr<osgAnimation::Skeleton> skeleton = makeBones();
    skeleton->getChild(0)->asGroup()->removeChild(0, 1);
    const test::Notices notices;
    const osg::ref_ptr<osgSkin::UpdateDeformableSkin> update = new osgSkin::UpdateDeformableSkin;
    ASSERT_TRUE(update->pose(*makeSkin(), *skeleton));
    EXPECT_TRUE(notices.say("has no bone \"middle\" and 1 more; these joints move"));
    EXPECT_EQ(notices.lines(), 1u) << notices.text();
}

/// Such as the one that readSkeleton() adds above several roots.
TEST(UpdateDeformableSkin, DoesNotWarnAboutARootWithoutABone) {
    const osg::ref_ptr<osgAnimation::Skeleton> skeleton = makeBones();
    skeleton->getChild(0)->setName("another");
    const test::Notices notices;
    const osg::ref_ptr<osgSkin::UpdateDeformableSkin> update = new osgSkin::UpdateDeformableSkin;
    ASSERT_TRUE(update->pose(*makeSkin(), *skeleton));
    EXPECT_EQ(notices.text(), "");
}

/// Such as a rider's, whose bones have the same names as the horse's.
TEST(UpdateDeformableSkin, IgnoresBonesOfANestedSkeleton) {
    const osg::ref_ptr<osgAnimation::Skeleton> skeleton = makeBones(), rider = makeBones();
    test::middleOf(*skeleton).addChild(rider);
    test::rotateMiddle(*skeleton, 0.5);
    test::rotateMiddle(*rider, 1.0);
    const auto skin = makeSkin(), riders = makeSkin();
    const osg::ref_ptr<osgSkin::UpdateDeformableSkin> update = new osgSkin::UpdateDeformableSkin;
    ASSERT_TRUE(update->pose(*skin, *skeleton));
    EXPECT_NEAR(test::bendOf(*skin), 0.5, 1e-9);
    ASSERT_TRUE(update->pose(*riders, *rider));
    EXPECT_NEAR(test::bendOf(*riders), 1.0, 1e-9);
}

TEST(UpdateDeformableSkin, FollowsAReplacedBone) {
    const osg::ref_ptr<osgAnimation::Skeleton> skeleton = makeBones();
    const auto skin = makeSkin();
    const osg::ref_ptr<osgSkin::UpdateDeformableSkin> update = new osgSkin::UpdateDeformableSkin;
    ASSERT_TRUE(update->pose(*skin, *skeleton));
    osg::Group& root = *skeleton->getChild(0)->asGroup();
    root.setChild(0, osg::clone(root.getChild(0), osg::CopyOp::SHALLOW_COPY));
    test::rotateMiddle(*skeleton, 0.5);
    ASSERT_TRUE(update->pose(*skin, *skeleton));
    EXPECT_NEAR(test::bendOf(*skin), 0.5, 1e-9);
}

/// A skin has a single pose; under several skeletons it would need several.
TEST(UpdateDeformableSkin, WarnsAboutSeveralSkeletonsOfOneSkin) {
    const osg::ref_ptr<osgAnimation::Skeleton> first = makeBones(), second = makeBones();
    const auto skin = makeSkin();
    skin->setUpdateCallback(new osgSkin::UpdateDeformableSkin);
    const osg::ref_ptr<osg::Group> scene = new osg::Group;
    scene->addChild(first);
    scene->addChild(second);
    const test::Notices notices;
    first->addChild(skin);
    test::updateAt(*scene, 0.0);
    first->removeChild(skin); // moved: no warning
    second->addChild(skin);
    test::updateAt(*scene, 0.0);
    EXPECT_EQ(notices.text(), "");
    first->addChild(skin);
    test::updateAt(*scene, 0.0);
    test::updateAt(*scene, 0.0);
    EXPECT_TRUE(notices.say("is below several skeletons")) << notices.text();
    EXPECT_EQ(notices.lines(), 1u);
}

TEST(UpdateDeformableSkin, RunsNestedCallbacks) {
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
    test::updateAt(*skeleton, 0.0);
    EXPECT_EQ(added->times, 1);
}

TEST(UpdateDeformableSkin, SkinMovedBelowItsBoneIsFreed) {
    osg::observer_ptr<osg::Node> figure;
    {
        const osg::ref_ptr<osgAnimation::Skeleton> skeleton = makeBones();
        const osg::ref_ptr<osgSkin::DeformableSkin> skin = makeSkin();
        skin->setUpdateCallback(new osgSkin::UpdateDeformableSkin);
        skeleton->addChild(skin);
        test::updateAt(*skeleton, 0.0);
        skeleton->removeChild(skin);
        figure = skeleton->getChild(0);
        figure->asGroup()->addChild(skin);
    }
    EXPECT_FALSE(figure.valid());
}

/// Neither keeps the other alive.
TEST(UpdateDeformableSkin, SkinBelowABoneIsFreed) {
    osg::observer_ptr<osgSkin::DeformableSkin> skin;
    {
        Character character(someClip(12, 0.8));
        character.skeleton->removeChild(character.skin);
        Character::findBone(*character.skeleton, "middle")->addChild(character.skin);
        character.update(0.1);
        skin = character.skin;
    }
    EXPECT_FALSE(skin.valid());
}

TEST(UpdateDeformableSkin, FindsTheBoneThatReplacesAMovedOne) {
    Character character(someClip(12, 0.8));
    const osg::ref_ptr<osgAnimation::Bone> old = Character::findBone(*character.skeleton, "middle");
    const osg::ref_ptr<osg::Group> parent = old->getParent(0), elsewhere = new osg::Group;
    const osg::ref_ptr<osgAnimation::Bone> bone = new osgAnimation::Bone("middle");
    bone->setInvBindMatrixInSkeletonSpace(old->getInvBindMatrixInSkeletonSpace());
    bone->setMatrixInSkeletonSpace(osg::Matrixd::translate(0, 50, 0));
    character.update(0.1);
    parent->addChild(bone);
    parent->removeChild(old);
    elsewhere->addChild(old);
    character.update(0.2);
    double highest = 0.0;
    for (const osg::Vec3& p : verticesOf(*character.skin))
        highest = std::max(highest, double(p.y()));
    EXPECT_GT(highest, 40.0);
}

TEST(UpdateDeformableSkin, WarnsOnceAboutAMissingBone) {
    Character character(someClip(12, 0.8)), other(someClip(12, 0.8));
    for (Character* each : {&character, &other}) {
        const osg::ref_ptr<osgAnimation::Bone> end = Character::findBone(*each->skeleton, "end");
        end->getParent(0)->removeChild(end);
    }
    const osg::ref_ptr<osgSkin::UpdateDeformableSkin> shared = new osgSkin::UpdateDeformableSkin;
    const test::Notices notices;
    for (int frame = 0; frame < 10; ++frame)
        for (Character* each : {&character, &other})
            EXPECT_TRUE(shared->pose(*each->skin, *each->skeleton));
    EXPECT_EQ(notices.lines(), 1u) << notices.text();
}

/// Memory is reused: a new model may have the address of an old one.
TEST(UpdateDeformableSkin, DetectsANewModelAtAnOldAddress) {
    const osg::ref_ptr<osgSkin::UpdateDeformableSkin> update = new osgSkin::UpdateDeformableSkin;
    const auto bones = makeBones();
    dynamic_cast<osgAnimation::Bone&>(*bones->getChild(0))
        .setMatrixInSkeletonSpace(osg::Matrix::rotate(0.5, 0, 0, 1));
    const test::Tube tube(4, 12);
    const osg::ref_ptr<osg::Geometry> geometry = test::makeGeometry(tube);
    osgSkin::Binding renamed = tube.binding; // other bones for the same joints
    std::swap(renamed.joints[0].name, renamed.joints[1].name);
    const auto skin = makeSkin();
    skin->setSkin(geometry, tube.model());
    ASSERT_TRUE(update->pose(*skin, *bones));
    const void* const place = skin->getModel();
    skin->setSkin(geometry, tube.model()); // frees the model
    std::vector<osg::ref_ptr<const osgSkin::SkinModel>> others;
    do
        others.push_back(
            osgSkin::SkinModel::create(renamed, tube.positions, tube.normals, tube.source));
    while (others.back() != place && others.size() < 3000);
    skin->setSkin(geometry, others.back());
    const auto fresh = makeSkin();
    fresh->setSkin(geometry, others.back());
    const osg::ref_ptr<osgSkin::UpdateDeformableSkin> other = new osgSkin::UpdateDeformableSkin;
    ASSERT_TRUE(other->pose(*fresh, *bones));
    ASSERT_TRUE(update->pose(*skin, *bones));
    EXPECT_EQ(verticesOf(*skin), verticesOf(*fresh));
    RecordProperty("modelsUntilThen", static_cast<int>(others.size()));
}
