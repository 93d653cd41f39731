// SPDX-License-Identifier: MIT
//
// A twist that passes through 180 degrees: UpdateDeformableSkin unwraps it by default.
//
// Functions with OSG's types equal those with GLM's.
#include "Notices.h"
#include "PlayedFigure.h"
#include "TubeSkin.h"

#include <osgSkin/BendTwist>
#include <osgSkin/Error>
#include <osgSkin/GlmOsg>
#include <osgSkin/ParallelDeformCallback>
#include <osgSkin/PoseBounds>
#include <osgSkin/SkinModel>
#include <osgSkin/UpdateDeformableSkin>
#include <osgSkinRig/ClipCharacter>

#include <gtest/gtest.h>
#include <osg/Group>
#include <osgUtil/UpdateVisitor>

#include <cmath>
#include <limits>

namespace {

const double kDegree = osg::PI / 180.0;

class TwistUnwrap : public testing::Test {
protected:
    TwistUnwrap() {
        skin->setUpdateCallback(callback);
        skeleton->addChild(skin);
    }

    /// The middle joint's twist, in degrees, after an update at `time` with its bone rotated.
    double twistAt(double time, double degrees) {
        auto& root = static_cast<osgAnimation::Bone&>(*skeleton->getChild(0));
        auto& middle = static_cast<osgAnimation::Bone&>(*root.getChild(0));
        auto& end = static_cast<osgAnimation::Bone&>(*middle.getChild(0));
        middle.setMatrixInSkeletonSpace(
            osg::Matrix::rotate(degrees * kDegree, osg::Vec3d(0, 1, 0)) *
            osg::Matrix::translate(0, 2, 0));
        end.setMatrixInSkeletonSpace(osg::Matrix::translate(0, 2, 0) *
                                     middle.getMatrixInSkeletonSpace());
        const osg::ref_ptr<osg::FrameStamp> stamp = new osg::FrameStamp;
        stamp->setSimulationTime(time);
        osgUtil::UpdateVisitor update;
        update.setFrameStamp(stamp);
        skeleton->accept(update);
        return skin->getPose().transform(1).split.twistAngle / kDegree;
    }

    osg::ref_ptr<osgAnimation::Skeleton> skeleton = test::makeBones();
    osg::ref_ptr<osgSkin::DeformableSkin> skin = test::makeSkin();
    osg::ref_ptr<osgSkin::UpdateDeformableSkin> callback = new osgSkin::UpdateDeformableSkin;
};

} // namespace

TEST_F(TwistUnwrap, OnByDefault) {
    EXPECT_TRUE(callback->getUnwrapTwist());
    twistAt(0.0, 170.0);
    EXPECT_NEAR(twistAt(0.1, 190.0), 190.0, 1e-9);
    callback->setUnwrapTwist(false);
    twistAt(0.15, 170.0);
    EXPECT_NEAR(twistAt(0.2, 190.0), -170.0, 1e-9);
}

TEST_F(TwistUnwrap, RunsOnThroughHalfATurnAndBack) {
    double time = 0.0;
    for (double degrees = 0.0; degrees < 270.0; degrees += 10.0)
        ASSERT_NEAR(twistAt(time += 0.05, degrees), degrees, 1e-9);
    for (double degrees = 260.0; degrees > -270.0; degrees -= 10.0)
        ASSERT_NEAR(twistAt(time += 0.05, degrees), degrees, 1e-9);
}

TEST_F(TwistUnwrap, DoesNotWindUp) {
    double time = 0.0;
    for (double degrees = 0.0; degrees < 2000.0; degrees += 10.0) {
        const double twist = twistAt(time += 0.05, degrees);
        ASSERT_LT(std::abs(twist), 270.0) << degrees;
        if (std::abs(std::remainder(degrees, 360.0)) < 90.0) {
            ASSERT_NEAR(twist, std::remainder(degrees, 360.0), 1e-9) << degrees;
        }
    }
}

/// A looping clip whose end is far from its beginning.
TEST_F(TwistUnwrap, EachRoundOfALoopIsLikeTheFirst) {
    const double clip[] = {-30.0, 30.0, 100.0, 170.0, 220.0, 250.0};
    double time = 0.0;
    for (int round = 0; round < 4; ++round)
        for (const double degrees : clip)
            ASSERT_NEAR(twistAt(time += 0.05, degrees), degrees, 1e-9) << round;
}

/// Posing a motion's frames in any order, as baking does, gives the same results.
TEST_F(TwistUnwrap, PoseWithoutAnUpdateDependsOnTheBonesAlone) {
    twistAt(0.0, 170.0);
    EXPECT_NEAR(twistAt(0.1, 190.0), 190.0, 1e-9);
    for (int i = 0; i < 2; ++i) {
        EXPECT_TRUE(callback->pose(*skin, *skeleton));
        EXPECT_NEAR(skin->getPose().transform(1).split.twistAngle / kDegree, -170.0, 1e-9);
    }
}

TEST_F(TwistUnwrap, SkinRunsOnToo) {
    double time = 0.0;
    for (double degrees = 0.0; degrees < 270.0; degrees += 10.0) {
        twistAt(time += 0.05, degrees);
        // Halfway up the middle joint's region, half of the twist is applied, including any excess
        // over 2 pi. The ring of vertices at the joint has ratio one half.
        const auto& vertices =
            static_cast<const osg::Vec3Array&>(*skin->getDeformedGeometry()->getVertexArray());
        const osg::Vec3 at = vertices[std::size_t(8) * 12]; // height 2, at angle 0
        const double half = 0.5 * degrees * kDegree;
        ASSERT_NEAR(at.x(), std::cos(half), 1e-5) << degrees;
        ASSERT_NEAR(at.z(), -std::sin(half), 1e-5) << degrees;
    }
}

TEST_F(TwistUnwrap, ABoneThatReturnsMovesTheSkinAgain) {
    osg::Group* const root = skeleton->getChild(0)->asGroup();
    const osg::ref_ptr<osg::Group> middle = root->getChild(0)->asGroup();
    twistAt(0.0, 10.0);
    const auto update = [&] {
        osgUtil::UpdateVisitor visitor;
        visitor.setFrameStamp(new osg::FrameStamp);
        skeleton->accept(visitor);
    };
    for (int round = 0; round < 2; ++round) {
        root->removeChild(middle);
        const test::Notices notices;
        update();
        EXPECT_EQ(skin->getPose().transform(1).split.twistAngle, 0.0);
        root->addChild(middle);
        EXPECT_NEAR(twistAt(0.1, 30.0), 30.0, 1e-9);
    }
}

TEST_F(TwistUnwrap, ABoneScaledToNothingLeavesTheOthersTheirs) {
    twistAt(0.0, 0.0);
    auto& root = static_cast<osgAnimation::Bone&>(*skeleton->getChild(0));
    auto& middle = static_cast<osgAnimation::Bone&>(*root.getChild(0));
    auto& end = static_cast<osgAnimation::Bone&>(*middle.getChild(0));
    const osg::Matrixd moved = osg::Matrix::translate(7, 0, 0);
    root.setMatrixInSkeletonSpace(moved);
    const osg::Matrixd nothing =
        osg::Matrix::scale(0, 0, 0) * osg::Matrix::translate(0, 2, 0) * moved;
    middle.setMatrixInSkeletonSpace(nothing);
    end.setMatrixInSkeletonSpace(osg::Matrix::translate(0, 2, 0) * nothing);
    const test::Notices notices;
    osgUtil::UpdateVisitor update;
    update.setFrameStamp(new osg::FrameStamp);
    skeleton->accept(update);
    EXPECT_EQ(notices.text(), "");
    const auto& rest =
        static_cast<const osg::Vec3Array&>(*skin->getRestGeometry()->getVertexArray());
    const auto& now =
        static_cast<const osg::Vec3Array&>(*skin->getDeformedGeometry()->getVertexArray());
    for (unsigned int v = 0; v < now.size(); ++v) {
        if (rest[v].y() < 0.5f) {
            EXPECT_LT((now[v] - rest[v] * moved).length(), 1e-4f) << v;
        }
        if (rest[v].y() > 3.5f) {
            EXPECT_LT((now[v] - osg::Vec3(7, 2, 0)).length(), 0.01f) << v;
        }
    }
}

TEST_F(TwistUnwrap, ASkinWithoutASkeletonIsReportedOnce) {
    const osg::ref_ptr<osg::Group> beside = new osg::Group;
    beside->addChild(skeleton);
    skeleton->removeChild(skin);
    beside->addChild(skin);
    const test::Notices notices;
    for (int i = 0; i < 3; ++i) {
        osgUtil::UpdateVisitor update;
        beside->accept(update);
    }
    EXPECT_EQ(notices.lines(), 1u);
    EXPECT_TRUE(notices.say("is below no osgAnimation::Skeleton")) << notices.text();
}

TEST(UpdateDeformableSkin, ASkinBelowItsOwnBoneIsFreed) {
    osg::observer_ptr<osg::Node> figure;
    {
        const osg::ref_ptr<osgAnimation::Skeleton> skeleton = test::makeBones();
        const osg::ref_ptr<osgSkin::DeformableSkin> skin = test::makeSkin();
        skin->setUpdateCallback(new osgSkin::UpdateDeformableSkin);
        skeleton->addChild(skin);
        osgUtil::UpdateVisitor update;
        skeleton->accept(update);
        skeleton->removeChild(skin);
        figure = skeleton->getChild(0);
        figure->asGroup()->addChild(skin);
    }
    EXPECT_FALSE(figure.valid());
}

TEST_F(TwistUnwrap, StartsAfreshOnASeek) {
    double time = 1.0;
    const auto wind = [&] {
        for (double degrees = 100.0; degrees <= 200.0; degrees += 20.0)
            twistAt(time += 0.05, degrees);
        EXPECT_NEAR(skin->getPose().transform(1).split.twistAngle / kDegree, 200.0, 1e-9);
    };
    wind();
    EXPECT_NEAR(twistAt(time += 1.0, 200.1), -159.9, 1e-9);
    wind();
    EXPECT_NEAR(twistAt(time -= 1.0, 200.1), -159.9, 1e-9);
    wind();
    callback->startTwistAfresh();
    EXPECT_NEAR(twistAt(time += 0.01, 200.0), -160.0, 1e-9);
    wind();
    EXPECT_NEAR(twistAt(time += 0.05, 20.0), 20.0, 1e-9); // too far for a continuous motion
    wind();
    callback->setUnwrapTwist(false);
    twistAt(time += 0.05, 200.0);
    EXPECT_NEAR(twistAt(time += 0.05, 200.1), -159.9, 1e-9);
}

namespace {

/// The middle joint twists by these degrees about the tube, one per sample.
osgSkin::Clip twistingClip(const std::vector<double>& degrees) {
    osgSkin::Clip clip = played::someClip(degrees.size(), 0.0);
    for (std::size_t f = 0; f < degrees.size(); ++f)
        clip.rotations[3 * f + 1] = glm::angleAxis(degrees[f] * kDegree, glm::dvec3(0, 1, 0));
    return clip;
}

double twistOf(const osgSkin::DeformableSkin& skin) {
    return skin.getPose().transform(1).split.twistAngle / kDegree;
}

const std::vector<double> kThereAndBack{0.0,   40.0,  80.0,  120.0, 160.0, 200.0,
                                        240.0, 200.0, 160.0, 120.0, 80.0,  40.0};

double expectedAt(double samples) {
    const double at = samples - 12.0 * std::floor(samples / 12.0);
    return at <= 6.0 ? 40.0 * at : 40.0 * (12.0 - at);
}

} // namespace

TEST(ClipTwist, RunsOnThroughHalfATurnLoopAfterLoop) {
    const osgSkin::Clip clip = twistingClip(kThereAndBack);
    const played::Character character(clip);
    const auto copies = osgSkin::ClipCharacter::create(*character.scene);
    const auto sampled = osgSkin::SampledClip::create(clip, character.rig);
    for (const bool baked : {false, true}) {
        if (baked) copies->bake(sampled);
        const auto copy = copies->makeInstance();
        const osgSkin::DeformableSkin& skin = played::skinOf(*copy.node);
        copy.player->setLayer(0, {sampled});
        for (double samples = 0.0; samples < 40.0; samples += 0.25) {
            ASSERT_TRUE(copy.player->pose());
            ASSERT_NEAR(twistOf(skin), expectedAt(samples), 1e-6) << samples << ", " << baked;
            copy.player->advance(0.25 * played::kFrame);
        }
    }
}

TEST(ClipTwist, StartsAfreshWhereTheTimeJumps) {
    std::vector<double> degrees = kThereAndBack;
    degrees.resize(40, 40.0);
    const osgSkin::Clip clip = twistingClip(degrees);
    const played::Character character(clip);
    const auto copies = osgSkin::ClipCharacter::create(*character.scene);
    const auto sampled = osgSkin::SampledClip::create(clip, character.rig);
    const auto poseAt = [&](const osgSkin::ClipCharacter::Instance& copy, double samples) {
        copy.player->setLayer(0, {sampled, samples * played::kFrame});
        EXPECT_TRUE(copy.player->pose());
        return twistOf(played::skinOf(*copy.node));
    };
    const auto copy = copies->makeInstance();
    poseAt(copy, 4.0);
    EXPECT_NEAR(poseAt(copy, 5.0), 200.0, 1e-6);
    poseAt(copy, 30.0);
    EXPECT_NEAR(poseAt(copy, 5.0), -160.0, 1e-6); // by more than kSeekSeconds
    // Baked data depend on the clip's time alone.
    copies->bake(sampled);
    const auto baked = copies->makeInstance();
    for (const double samples : {5.0, 30.0, 5.0, 5.25}) {
        EXPECT_NEAR(poseAt(baked, samples), samples > 20.0 ? 40.0 : expectedAt(samples), 1e-6);
        EXPECT_NEAR(poseAt(baked, 5.5), 220.0, 1e-6) << samples;
    }
}

using osgSkin::DeformableSkin;
using osgSkin::ParallelDeformCallback;

namespace {

/// Some skins below a group; bones are not needed, because the test sets the poses.
struct SkinsBelow {
    explicit SkinsBelow(unsigned int count) {
        for (unsigned int i = 0; i < count; ++i) {
            skins.push_back(test::makeSkin());
            const osg::ref_ptr<osg::Group> between = new osg::Group;
            between->addChild(skins.back());
            group->addChild(between);
        }
        together->getPool()->setMinimumVertices(0);
        group->setUpdateCallback(together);
    }
    void update() {
        osgUtil::UpdateVisitor visitor;
        visitor.setTraversalNumber(++frame);
        group->accept(visitor);
    }
    void bendAll(double angle) {
        for (const auto& skin : skins) test::bend(*skin, angle);
    }

    osg::ref_ptr<osg::Group> group = new osg::Group;
    osg::ref_ptr<ParallelDeformCallback> together =
        new ParallelDeformCallback(osg::ref_ptr<osgSkin::DeformPool>(new osgSkin::DeformPool(2)));
    std::vector<osg::ref_ptr<DeformableSkin>> skins;
    unsigned int frame = 0;
};

} // namespace

TEST(ParallelDeformCallback, DeformsInTheUpdateWhatWasSeen) {
    SkinsBelow crowd(5);
    crowd.bendAll(0.1);
    crowd.update();
    for (const auto& skin : crowd.skins) EXPECT_EQ(skin->getDeformCount(), 0u); // not in view yet
    test::cull(*crowd.skins[1], true);
    test::cull(*crowd.skins[3], true);
    EXPECT_EQ(crowd.skins[1]->getDeformCount(), 1u);

    crowd.bendAll(0.2);
    crowd.update();
    for (unsigned int i = 0; i < crowd.skins.size(); ++i) {
        EXPECT_EQ(crowd.skins[i]->needsDeform(), i != 1 && i != 3) << i;
        EXPECT_EQ(crowd.skins[i]->getDeformCount(), i == 1 || i == 3 ? 2u : 0u) << i;
    }
    // Out of view now: the deformed vertices are not used, so the next pose is not deformed.
    crowd.bendAll(0.3);
    crowd.update();
    EXPECT_EQ(crowd.skins[1]->getDeformCount(), 2u);
    test::cull(*crowd.skins[1], true);
    EXPECT_EQ(crowd.skins[1]->getDeformCount(), 3u);
}

/// Scenes may have thousands of nodes: the search for skins runs only when the scene changes.
TEST(ParallelDeformCallback, LooksForSkinsOnce) {
    struct Counted : osg::Group {
        void traverse(osg::NodeVisitor& nv) override {
            if (nv.getVisitorType() != osg::NodeVisitor::UPDATE_VISITOR) ++looks;
            osg::Group::traverse(nv);
        }
        int looks = 0;
    };
    SkinsBelow crowd(3);
    const osg::ref_ptr<Counted> counted = new Counted;
    crowd.group->addChild(counted);
    for (int frame = 0; frame < 10; ++frame) crowd.update();
    EXPECT_EQ(counted->looks, 1);
    crowd.group->removeChild(0, 1);
    crowd.update();
    crowd.update();
    EXPECT_EQ(counted->looks, 2);
}

TEST(ParallelDeformCallback, DeformsAllWhereToldTo) {
    SkinsBelow crowd(5);
    crowd.together->setOnlySeen(false);
    crowd.bendAll(0.1);
    crowd.update();
    const osg::ref_ptr<DeformableSkin> alone = test::makeSkin();
    test::bend(*alone, 0.1);
    const auto vertices = [](const DeformableSkin& skin) {
        return static_cast<const osg::Vec3Array&>(*skin.getDeformedGeometry()->getVertexArray())
            .asVector();
    };
    for (const auto& skin : crowd.skins) {
        EXPECT_EQ(skin->getDeformCount(), 1u);
        EXPECT_EQ(vertices(*skin), vertices(*alone));
    }
}

TEST(ParallelDeformCallback, FindsWhatComesAndLetsGoWhatLeaves) {
    SkinsBelow crowd(2);
    crowd.together->setOnlySeen(false);
    crowd.update();
    const osg::ref_ptr<DeformableSkin> late = test::makeSkin(), deep = test::makeSkin();
    crowd.group->addChild(late);
    crowd.update();
    EXPECT_EQ(late->getDeformCount(), 1u);

    crowd.group->getChild(0)->asGroup()->addChild(deep);
    crowd.together->dirty();
    crowd.update();
    EXPECT_EQ(deep->getDeformCount(), 1u);

    crowd.group->getChild(0)->asGroup()->removeChild(deep);
    crowd.update();
    crowd.update();
    EXPECT_EQ(deep->referenceCount(), 1);
}

TEST(ParallelDeformCallback, TakesASkinThatStandsTwice) {
    SkinsBelow crowd(1);
    crowd.together->setOnlySeen(false);
    crowd.group->addChild(crowd.skins[0]);
    crowd.update();
    EXPECT_EQ(crowd.skins[0]->getDeformCount(), 1u);
}

TEST(DeformableSkin, LetsAPoolDeformIt) {
    const osg::ref_ptr<DeformableSkin> skin = test::makeSkin(), alone = test::makeSkin();
    const osg::ref_ptr<osgSkin::DeformPool> pool = new osgSkin::DeformPool(2);
    pool->setMinimumVertices(0);
    skin->setPool(pool);
    test::bend(*skin, 0.7);
    test::bend(*alone, 0.7);
    EXPECT_EQ(static_cast<const osg::Vec3Array&>(*skin->getDeformedGeometry()->getVertexArray())
                  .asVector(),
              static_cast<const osg::Vec3Array&>(*alone->getDeformedGeometry()->getVertexArray())
                  .asVector());
}

using osgSkin::toGlm;
using osgSkin::toOsg;

namespace {

std::vector<glm::dmat4> somePose(const test::Tube& tube) {
    std::mt19937_64 random(3);
    std::vector<glm::dquat> rotations;
    rotations.reserve(3);
    for (int j = 0; j < 3; ++j) rotations.push_back(test::randomRotation(random));
    return test::skinningFrom(tube.binding.joints, rotations, {0.5, 1.0, -2.0});
}

std::vector<osg::Matrixd> inOsg(const std::vector<glm::dmat4>& matrices) {
    std::vector<osg::Matrixd> result;
    result.reserve(matrices.size());
    for (const glm::dmat4& matrix : matrices) result.push_back(toOsg(matrix));
    return result;
}

std::vector<osg::Vec3> posed(const osgSkin::DeformableSkin& skin) {
    return static_cast<const osg::Vec3Array&>(*skin.getDeformedGeometry()->getVertexArray())
        .asVector();
}

} // namespace

TEST(OsgTypes, PoseFromMatrices) {
    const test::Tube tube;
    const std::vector<glm::dmat4> skinning = somePose(tube);
    osgSkin::Pose a(tube.binding.joints), b(tube.binding.joints);
    bool changed = false;
    ASSERT_TRUE(a.set(skinning.data(), 3));
    ASSERT_TRUE(b.set(inOsg(skinning).data(), 3, osgSkin::Pose::Twist::Shortest, &changed));
    EXPECT_TRUE(changed);
    for (std::size_t j = 0; j < 3; ++j) {
        EXPECT_EQ(b.transform(j).rotation, a.transform(j).rotation);
        EXPECT_EQ(b.transform(j).offset, a.transform(j).offset);
    }
    EXPECT_FALSE(b.set(inOsg(skinning).data(), 2));
}

TEST(OsgTypes, SkinIsPosedByMatrices) {
    const test::Tube tube;
    const std::vector<glm::dmat4> skinning = somePose(tube);
    const osg::ref_ptr<osgSkin::DeformableSkin> a = test::makeSkin(), b = test::makeSkin();
    ASSERT_TRUE(a->setPose(skinning.data(), 3));
    ASSERT_TRUE(b->setPose(inOsg(skinning)));
    EXPECT_EQ(posed(*b), posed(*a));
    std::vector<osg::Matrixd> tooFew = inOsg(skinning);
    tooFew.pop_back();
    EXPECT_FALSE(b->setPose(tooFew));
}

// A bone's matrix and inverse bind matrix in OSG's multiplication order: a rotation about the
// joint.
TEST(OsgTypes, MatricesAreOsgs) {
    const osg::ref_ptr<osgSkin::DeformableSkin> a = test::makeSkin(), b = test::makeSkin();
    test::bend(*a, 0.7);
    const osg::Matrixd bend = osg::Matrixd::translate(0, -2, 0) *
                              osg::Matrixd::rotate(0.7, osg::Vec3d(1, 0, 0)) *
                              osg::Matrixd::translate(0, 2, 0);
    ASSERT_TRUE(b->setPose({osg::Matrixd(), bend, bend}));
    const std::vector<osg::Vec3> is = posed(*b), was = posed(*a);
    for (std::size_t v = 0; v < was.size(); ++v) ASSERT_LE((is[v] - was[v]).length(), 1e-6f);
}

TEST(OsgTypes, ModelFromArrays) {
    const test::Tube tube;
    const osg::ref_ptr<osg::Geometry> geometry = test::makeGeometry(tube);
    const auto* vertices = static_cast<const osg::Vec3Array*>(geometry->getVertexArray());
    const auto* normals = static_cast<const osg::Vec3Array*>(geometry->getNormalArray());
    const auto model = osgSkin::SkinModel::create(tube.binding, vertices, normals, tube.source);
    EXPECT_EQ(model->positions(), tube.positions);
    EXPECT_EQ(model->normals(), tube.normals);
    EXPECT_THROW(osgSkin::SkinModel::create(tube.binding, vertices, nullptr, tube.source),
                 osgSkin::Error);
    EXPECT_THROW(osgSkin::SkinModel::create(tube.binding, nullptr, normals, tube.source),
                 osgSkin::Error);
}

TEST(OsgTypes, Bounds) {
    const test::Tube tube;
    const auto model = tube.model();
    const osgSkin::Pose pose(model->joints());
    const osgSkin::PoseBounds bounds = osgSkin::computePoseBounds(*model, pose);
    const osg::BoundingBox box = toOsg(bounds);
    EXPECT_EQ(box.yMin(), bounds.low.y);
    EXPECT_EQ(box.zMax(), bounds.high.z);
    EXPECT_TRUE(box.contains(osg::Vec3(0, 3, 0)));
    const osg::ref_ptr<osgSkin::SkinModel> empty = new osgSkin::SkinModel;
    EXPECT_FALSE(toOsg(osgSkin::computePoseBounds(*empty, osgSkin::Pose())).valid());
}

TEST(OsgTypes, BendTwist) {
    const osg::Quat q(0.3, osg::Vec3d(0, 1, 0), 0.5, osg::Vec3d(1, 0, 0), 0.0, osg::Vec3d(0, 0, 1));
    const osg::Vec3d pole(0, 1, 0);
    const osgSkin::BendTwist a = osgSkin::splitBendTwist(toGlm(q), toGlm(pole));
    const osgSkin::BendTwist b = osgSkin::splitBendTwist(q, pole);
    EXPECT_EQ(b.bendAxis, a.bendAxis);
    EXPECT_NEAR(b.bendAngle, 0.5, 1e-12);
    EXPECT_NEAR(b.twistAngle, 0.3, 1e-12);
    const osg::Quat half = osgSkin::partialRotation(b, pole, 0.5, 0.25);
    EXPECT_EQ(toGlm(half), osgSkin::partialRotation(a, toGlm(pole), 0.5, 0.25));

    osgSkin::BendTwist out;
    EXPECT_TRUE(osgSkin::trySplitBendTwist(q, pole, out));
    EXPECT_EQ(out.twistAngle, b.twistAngle);
    EXPECT_FALSE(osgSkin::trySplitBendTwist(q, osg::Vec3d(0, 2, 0), out));
    EXPECT_EQ(out.twistAngle, b.twistAngle);
    EXPECT_THROW(osgSkin::splitBendTwist(osg::Quat(0, 0, 0, 0), pole), osgSkin::Error);
}

TEST(OsgTypes, ModelsCloneAndStayTheirOwn) {
    const test::Tube tube;
    const auto model = tube.model();
    const osg::ref_ptr<osgSkin::SkinModel> copy = osg::clone(model.get());
    copy->setName("copy");
    EXPECT_EQ(model->getName(), "");
    EXPECT_EQ(copy->positions(), model->positions());
    const osg::ref_ptr<osgSkin::DeformableSkin> a = test::makeSkin(), b = test::makeSkin();
    b->setSkin(test::makeGeometry(tube), copy);
    const std::vector<glm::dmat4> skinning = somePose(tube);
    ASSERT_TRUE(a->setPose(skinning.data(), 3));
    ASSERT_TRUE(b->setPose(skinning.data(), 3));
    EXPECT_EQ(posed(*b), posed(*a));
}
