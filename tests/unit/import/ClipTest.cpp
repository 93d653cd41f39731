// SPDX-License-Identifier: MIT
// Skeletons and animations made of clips, and poses.
#include "ExpectError.h"
#include "Figure.h"
#include "FindNodes.h"
#include "UpdateAt.h"

#include <osgSkin/GlmOsg>
#include <osgSkinMotion/ApplyFrame>
#include <osgSkinMotion/MakeAnimation>
#include <osgSkinRig/Clip>
#include <osgSkinRig/MakeSkeleton>

#include <glm/gtc/quaternion.hpp>
#include <gtest/gtest.h>
#include <osgAnimation/BasicAnimationManager>
#include <osgAnimation/Bone>

#include <cmath>
#include <map>

namespace {

using osgSkin::Clip;
using osgSkin::RestSkeleton;

struct Bones {
    explicit Bones(osg::Node& root) {
        for (const auto& found : test::findNodes<osgAnimation::Bone>(root))
            byName[found.node->getName()] = found.node;
    }

    std::map<std::string, osg::ref_ptr<osgAnimation::Bone>> byName;
};

/// Rotations that grow past 180 degrees, so that neighbouring quaternions change sign.
Clip makeClip(const RestSkeleton& rig, std::size_t frames) {
    Clip clip;
    clip.name = "turns";
    clip.frameTime = 1.0 / 120.0;
    clip.frames = frames;
    clip.joints = rig.joints.size();
    for (std::size_t f = 0; f < frames; ++f) {
        for (std::size_t j = 0; j < clip.joints; ++j) {
            glm::dquat q =
                turnDegrees(11.0 * static_cast<double>(f + j), {1.0, static_cast<double>(j), 0.3});
            clip.rotations.push_back((f + j) % 2 == 0 ? q : -q);
        }
        clip.rootPositions.emplace_back(0.1 * static_cast<double>(f), 10.0, -1.0);
    }
    return clip;
}

double largestDifference(const osg::Matrixd& a, const osg::Matrixd& b) {
    double result = 0.0;
    for (int i = 0; i < 16; ++i) result = std::max(result, std::abs(a.ptr()[i] - b.ptr()[i]));
    return result;
}

/// A skeleton under an animation manager that plays `clip` from time 0.
osg::ref_ptr<osgAnimation::Skeleton> makePlayer(const Clip& clip, const RestSkeleton& rig) {
    osg::ref_ptr<osgAnimation::Skeleton> skeleton = osgSkin::makeSkeleton(rig);
    osg::ref_ptr<osgAnimation::BasicAnimationManager> manager =
        new osgAnimation::BasicAnimationManager;
    osg::ref_ptr<osgAnimation::Animation> animation = osgSkin::makeAnimation(clip, rig);
    manager->registerAnimation(animation);
    // Before the skeleton's own callback, so that the targets are set before the bones read them.
    manager->setNestedCallback(skeleton->getUpdateCallback());
    skeleton->setUpdateCallback(manager);
    manager->playAnimation(animation);
    return skeleton;
}

TEST(MakeSkeleton, HoldsTheRestPoseBeforeAnyUpdate) {
    const RestSkeleton rig = makeFigure(30.0);
    const osg::ref_ptr<osgAnimation::Skeleton> skeleton = osgSkin::makeSkeleton(rig);
    const Bones bones(*skeleton);
    ASSERT_EQ(bones.byName.size(), rig.joints.size());
    for (const osgSkin::RestJoint& joint : rig.joints) {
        osgAnimation::Bone& bone = *bones.byName.at(joint.name);
        const osg::Matrixd place = bone.getMatrixInSkeletonSpace();
        EXPECT_LT(glm::length(osgSkin::toGlm(place.getTrans()) - joint.centre), 1e-12);
        EXPECT_LT(largestDifference(bone.getInvBindMatrixInSkeletonSpace() * place,
                                    osg::Matrixd::identity()),
                  1e-12);
        if (joint.parent >= 0)
            EXPECT_EQ(bone.getBoneParent(),
                      bones.byName.at(rig.joints[static_cast<std::size_t>(joint.parent)].name));
        else
            EXPECT_EQ(bone.getParent(0), skeleton.get());
    }
}

TEST(MakeSkeleton, StaysAtRestThroughAnUpdate) {
    const RestSkeleton rig = makeFigure(30.0);
    const osg::ref_ptr<osgAnimation::Skeleton> skeleton = osgSkin::makeSkeleton(rig);
    test::updateAt(*skeleton, 1.0);
    const Bones bones(*skeleton);
    for (const osgSkin::RestJoint& joint : rig.joints)
        EXPECT_LT(largestDifference(bones.byName.at(joint.name)->getMatrixInSkeletonSpace(),
                                    osg::Matrixd::translate(osgSkin::toOsg(joint.centre))),
                  1e-5)
            << joint.name;
}

TEST(MakeAnimation, PlaysTheSamplesAtTheirTimes) {
    const RestSkeleton rig = makeFigure(30.0);
    const Clip clip = makeClip(rig, 50);
    const osg::ref_ptr<osgAnimation::Skeleton> played = makePlayer(clip, rig);
    const osg::ref_ptr<osgAnimation::Skeleton> exact = osgSkin::makeSkeleton(rig);
    const Bones playedBones(*played);
    const Bones exactBones(*exact);
    for (std::size_t f = 0; f < clip.frames; ++f) {
        test::updateAt(*played, static_cast<double>(f) * clip.frameTime);
        osgSkin::applyFrame(clip, rig, f, *exact);
        const Placed expected = place(clip, rig, f);
        for (std::size_t j = 0; j < rig.joints.size(); ++j) {
            const std::string& name = rig.joints[j].name;
            const osg::Matrixd matrix = exactBones.byName.at(name)->getMatrixInSkeletonSpace();
            ASSERT_LT(glm::length(osgSkin::toGlm(matrix.getTrans()) - expected.places[j]), 1e-12);
            ASSERT_LT(glm::length(osgSkin::toGlm(matrix.getRotate() * osg::Vec3d(1, 2, 3)) -
                                  expected.turns[j] * glm::dvec3(1, 2, 3)),
                      1e-9);
            ASSERT_LT(
                largestDifference(playedBones.byName.at(name)->getMatrixInSkeletonSpace(), matrix),
                1e-5)
                << name << ", frame " << f;
        }
    }
}

TEST(MakeAnimation, InterpolatesAlongTheShorterArc) {
    const RestSkeleton rig = makeFigure(30.0);
    const Clip clip = makeClip(rig, 50);
    const osg::ref_ptr<osgAnimation::Skeleton> played = makePlayer(clip, rig);
    const Bones bones(*played);
    for (std::size_t f = 0; f + 1 < clip.frames; ++f) {
        test::updateAt(*played, (static_cast<double>(f) + 0.5) * clip.frameTime);
        for (std::size_t j = 0; j < rig.joints.size(); ++j) {
            const glm::dquat half =
                osgSkin::toGlm(bones.byName.at(rig.joints[j].name)->getMatrix().getRotate());
            ASSERT_NEAR(angleBetween(half, clip.rotations[f * clip.joints + j]), 5.5, 1e-3);
        }
    }
}

TEST(MakeAnimation, Loops) {
    const RestSkeleton rig = makeFigure(30.0);
    const Clip clip = makeClip(rig, 11);
    const osg::ref_ptr<osgAnimation::Animation> animation = osgSkin::makeAnimation(clip, rig);
    EXPECT_EQ(animation->getPlayMode(), osgAnimation::Animation::LOOP);
    EXPECT_NEAR(animation->getDuration(), 11.0 * clip.frameTime, 1e-6);
    const osg::ref_ptr<osgAnimation::Skeleton> played = makePlayer(clip, rig);
    const Bones bones(*played);
    test::updateAt(*played, 0.0);
    test::updateAt(*played, 14.0 * clip.frameTime);
    EXPECT_LT(angleBetween(osgSkin::toGlm(bones.byName.at("Spine")->getMatrix().getRotate()),
                           clip.rotations[3 * clip.joints + 1]),
              0.01);
}

TEST(MakeAnimation, SingleSampleIsConstant) {
    const RestSkeleton rig = makeFigure(30.0);
    const Clip clip = makeClip(rig, 1);
    const osg::ref_ptr<osgAnimation::Skeleton> played = makePlayer(clip, rig);
    const Bones bones(*played);
    for (const double time : {0.0, 0.001, 3.0}) {
        test::updateAt(*played, time);
        EXPECT_LT(angleBetween(osgSkin::toGlm(bones.byName.at("Head")->getMatrix().getRotate()),
                               clip.rotations[2]),
                  1e-4)
            << time;
    }
}

TEST(ApplyFrame, OutlivesAnUpdateTraversal) {
    const RestSkeleton rig = makeFigure(30.0);
    const Clip clip = makeClip(rig, 5);
    const osg::ref_ptr<osgAnimation::Skeleton> skeleton = osgSkin::makeSkeleton(rig);
    osgSkin::applyFrame(clip, rig, 3, *skeleton);
    const Bones bones(*skeleton);
    const osg::Matrixd before = bones.byName.at("LeftHand")->getMatrixInSkeletonSpace();
    test::updateAt(*skeleton, 0.0);
    EXPECT_LT(largestDifference(bones.byName.at("LeftHand")->getMatrixInSkeletonSpace(), before),
              1e-5);
}

/// Such as a rider's, below the first bone, with bones of the same names.
TEST(ApplyFrame, IgnoresNestedSkeletons) {
    const RestSkeleton rig = makeFigure(30.0);
    const Clip clip = makeClip(rig, 5);
    const osg::ref_ptr<osgAnimation::Skeleton> skeleton = osgSkin::makeSkeleton(rig),
                                               rider = osgSkin::makeSkeleton(rig);
    const Bones bones(*skeleton), riders(*rider);
    const osg::Matrixd before = riders.byName.at("LeftHand")->getMatrix();
    bones.byName.at(rig.joints[0].name)->insertChild(0, rider);
    osgSkin::applyFrame(clip, rig, 3, *skeleton);
    EXPECT_EQ(riders.byName.at("LeftHand")->getMatrix(), before);
    const osg::ref_ptr<osgAnimation::Skeleton> alone = osgSkin::makeSkeleton(rig);
    osgSkin::applyFrame(clip, rig, 3, *alone);
    EXPECT_EQ(bones.byName.at("LeftHand")->getMatrix(),
              Bones(*alone).byName.at("LeftHand")->getMatrix());
}

TEST(ApplyFrame, IgnoresMissingJoints) {
    const RestSkeleton rig = makeFigure(30.0);
    const Clip clip = makeClip(rig, 2);
    RestSkeleton shorter = rig;
    shorter.joints[6].name = "Other";
    const osg::ref_ptr<osgAnimation::Skeleton> skeleton = osgSkin::makeSkeleton(shorter);
    osgSkin::applyFrame(clip, rig, 1, *skeleton);
    EXPECT_LT(
        glm::length(
            osgSkin::toGlm(
                Bones(*skeleton).byName.at("LeftForeArm")->getMatrixInSkeletonSpace().getTrans()) -
            place(clip, rig, 1).places[5]),
        1e-12);
}

TEST(ClipErrors, NameTheMismatch) {
    const RestSkeleton rig = makeFigure(30.0);
    const osg::ref_ptr<osgAnimation::Skeleton> skeleton = osgSkin::makeSkeleton(rig);
    const Clip good = makeClip(rig, 2);
    expectError([&] { osgSkin::applyFrame(good, rig, 2, *skeleton); },
                "clip \"turns\": no frame 2, expected less than 2");
    expectError([&] { osgSkin::makeAnimation({}, rig); }, "made for 0 joints, expected 11");
    Clip bad = good;
    bad.frameTime = 0.0;
    expectError([&] { osgSkin::makeAnimation(bad, rig); }, "expected a positive frame time");
    bad = good;
    bad.frames = 0;
    expectError([&] { osgSkin::makeAnimation(bad, rig); }, "no frame, expected at least one");
    bad = good;
    bad.rootPositions.pop_back();
    expectError([&] { osgSkin::makeAnimation(bad, rig); }, "its arrays do not fit 2 frames");
    expectError([&] { osgSkin::makeSkeleton({}); }, "skeleton: no joint");
}

} // namespace
