// SPDX-License-Identifier: MIT
// Third-party skeletons, whose bones have their own axes and update callbacks, in a clip's frame.
#include "ExpectError.h"
#include "Figure.h"
#include "FindNodes.h"
#include "Notices.h"
#include "UpdateAt.h"

#include <osgSkin/AutoPlayManager>
#include <osgSkin/BoneReader>
#include <osgSkin/GlmOsg>
#include <osgSkinMotion/ApplyFrame>
#include <osgSkinMotion/MakeAnimation>
#include <osgSkinRig/Clip>
#include <osgSkinRig/MakeSkeleton>
#include <osgSkinRig/ReadSkeleton>

#include <gtest/gtest.h>
#include <osgAnimation/Bone>
#include <osgAnimation/StackedMatrixElement>
#include <osgAnimation/StackedQuaternionElement>
#include <osgAnimation/StackedRotateAxisElement>
#include <osgAnimation/StackedScaleElement>
#include <osgAnimation/StackedTranslateElement>
#include <osgAnimation/UpdateBone>

#include <map>
#include <string>

using namespace osgSkin;

namespace {

using osgSkin::Clip;
using osgSkin::RestSkeleton;

enum class Stack { TurnAndMove, WithScale, Matrix, Axes };

Clip turnedClip(const RestSkeleton& rig) {
    Clip clip;
    clip.frameTime = 0.1;
    clip.frames = 2;
    clip.joints = rig.joints.size();
    for (std::size_t i = 0; i < 2 * clip.joints; ++i) {
        const double axis = static_cast<double>(i);
        clip.rotations.push_back(turnDegrees(7.0 * axis, {1.0, axis, 0.3}));
    }
    clip.rootPositions = {{0.0, 10.0, 0.0}, {1.0, 11.0, -2.0}};
    return clip;
}

void fill(osgAnimation::StackedTransform& stack, Stack kind, const osg::Matrixd& local) {
    stack.clear();
    if (kind == Stack::Matrix) {
        stack.push_back(new osgAnimation::StackedMatrixElement("matrix", local));
        return;
    }
    stack.push_back(new osgAnimation::StackedTranslateElement("translate", local.getTrans()));
    if (kind == Stack::Axes)
        stack.push_back(new osgAnimation::StackedRotateAxisElement("rotateX", osg::X_AXIS, 0.0));
    stack.push_back(new osgAnimation::StackedQuaternionElement("quaternion", local.getRotate()));
    if (kind == Stack::WithScale)
        stack.push_back(new osgAnimation::StackedScaleElement("scale", local.getScale()));
}

/// The rig's skeleton with other axes for each bone: along the bone, as in most tools.
osg::ref_ptr<osgAnimation::Skeleton> ownAxes(const RestSkeleton& rig, Stack kind) {
    const osg::ref_ptr<osgAnimation::Skeleton> skeleton = osgSkin::makeSkeleton(rig);
    double turn = 20.0;
    for (const auto& found : test::findNodes<osgAnimation::Bone>(*skeleton)) {
        osgAnimation::Bone& bone = *found.node;
        const osg::Vec3d centre =
            osg::Matrixd::inverse(bone.getInvBindMatrixInSkeletonSpace()).getTrans();
        osg::Matrixd bind =
            osg::Matrixd::rotate(osgSkin::toOsg(turnDegrees(turn, {0.2, turn, 90.0}))) *
            osg::Matrixd::translate(centre);
        if (kind == Stack::WithScale) bind.preMultScale(osg::Vec3d(1, 1, 1) * (1.0 + 0.01 * turn));
        turn += 35.0;
        const osgAnimation::Bone* above = bone.getBoneParent();
        const osg::Matrixd local = above ? bind * above->getInvBindMatrixInSkeletonSpace() : bind;
        bone.setInvBindMatrixInSkeletonSpace(osg::Matrixd::inverse(bind));
        bone.setMatrix(local);
        bone.setMatrixInSkeletonSpace(bind);
        auto& update = dynamic_cast<osgAnimation::UpdateBone&>(*bone.getUpdateCallback());
        fill(update.getStackedTransforms(), kind, local);
    }
    return skeleton;
}

/// Each bone's skinning matrix.
std::map<std::string, osg::Matrixd> skinning(osgAnimation::Skeleton& skeleton) {
    std::map<std::string, osg::Matrixd> result;
    for (const auto& found : test::findNodes<osgAnimation::Bone>(skeleton))
        result[found.node->getName()] =
            found.node->getInvBindMatrixInSkeletonSpace() * found.node->getMatrixInSkeletonSpace();
    return result;
}

double largestDifference(const std::map<std::string, osg::Matrixd>& some,
                         const std::map<std::string, osg::Matrixd>& others) {
    double result = 0.0;
    for (const auto& [name, matrix] : some)
        for (int i = 0; i < 16; ++i)
            result = std::max(result, std::abs(matrix.ptr()[i] - others.at(name).ptr()[i]));
    return result;
}

class OwnAxes : public testing::TestWithParam<Stack> {};

} // namespace

TEST_P(OwnAxes, DeformLikeTheClip) {
    const RestSkeleton rig = makeFigure(30.0);
    const osg::ref_ptr<osgAnimation::Skeleton> plain = osgSkin::makeSkeleton(rig),
                                               own = ownAxes(rig, GetParam());
    const Clip clip = turnedClip(rig);
    osgSkin::applyFrame(clip, rig, 1, *plain);
    const test::Notices notices;
    osgSkin::applyFrame(clip, osgSkin::readSkeleton(*own), 1, *own);
    const auto expected = skinning(*plain);
    EXPECT_LT(largestDifference(skinning(*own), expected), 1e-9);
    test::updateAt(*own, 0.0);
    const bool held = GetParam() != Stack::Axes;
    EXPECT_EQ(notices.warnings().empty(), held) << notices.text();
    EXPECT_EQ(largestDifference(skinning(*own), expected) < 1e-4, held);
}

TEST_P(OwnAxes, PlayTheClip) {
    const RestSkeleton rig = makeFigure(30.0);
    const osg::ref_ptr<osgAnimation::Skeleton> plain = osgSkin::makeSkeleton(rig),
                                               own = ownAxes(rig, GetParam());
    const Clip clip = turnedClip(rig);
    const RestSkeleton read = osgSkin::readSkeleton(*own);
    if (GetParam() == Stack::Matrix || GetParam() == Stack::Axes) {
        expectError([&] { osgSkin::makeAnimation(clip, read, *own); },
                    "\"" + rig.joints[0].name + "\" cannot be moved by channels");
        return;
    }
    const auto animation = osgSkin::makeAnimation(clip, read, *own);
    const osg::ref_ptr<osgSkin::AutoPlayManager> manager = new osgSkin::AutoPlayManager;
    manager->registerAnimation(animation);
    const osg::ref_ptr<osg::Group> scene = new osg::Group;
    scene->setUpdateCallback(manager);
    scene->addChild(own);
    for (std::size_t frame = 0; frame < clip.frames; ++frame) {
        osgSkin::applyFrame(clip, rig, frame, *plain);
        test::updateAt(*scene, 0.1 * static_cast<double>(frame));
        EXPECT_LT(largestDifference(skinning(*own), skinning(*plain)), 2e-4) << frame;
    }
}

/// A skeleton that no skin was bound to: bones keep the axes of the file.
TEST(OwnAxesTrees, SkinMayBeEmpty) {
    const RestSkeleton rig = makeFigure(30.0);
    const osg::ref_ptr<osgAnimation::Skeleton> bound = ownAxes(rig, Stack::TurnAndMove),
                                               own = ownAxes(rig, Stack::TurnAndMove);
    for (const auto& [name, bone] : osgSkin::bonesOf(*own))
        bone->setInvBindMatrixInSkeletonSpace(osg::Matrixd());
    const RestSkeleton read = osgSkin::readSkeleton(*own);
    const Clip clip = turnedClip(rig);
    osgSkin::applyFrame(clip, rig, 1, *bound);
    osgSkin::applyFrame(clip, read, 1, *own);
    for (const auto& [name, bone] : osgSkin::bonesOf(*own))
        for (int i = 0; i < 16; ++i)
            EXPECT_NEAR(bone->getMatrixInSkeletonSpace().ptr()[i],
                        osgSkin::bonesOf(*bound).at(name)->getMatrixInSkeletonSpace().ptr()[i],
                        1e-6)
                << name;
}

/// Bones that the rig does not know are between others, or some are missing.
TEST(OwnAxesTrees, HierarchiesMayDiffer) {
    const RestSkeleton rig = makeFigure(30.0);
    const osg::ref_ptr<osgAnimation::Skeleton> plain = osgSkin::makeSkeleton(rig),
                                               own = ownAxes(rig, Stack::TurnAndMove);
    auto bones = osgSkin::bonesOf(*own);
    const std::string other = rig.joints[5].name;
    bones.at(other)->setName("another's");
    const Clip clip = turnedClip(rig);
    osgSkin::applyFrame(clip, rig, 1, *plain);
    osgSkin::applyFrame(clip, rig, 1, *own);
    test::updateAt(*own, 0.0);
    auto expected = skinning(*plain);
    expected.erase(other);
    EXPECT_LT(largestDifference(expected, skinning(*own)), 1e-4);
}

INSTANTIATE_TEST_SUITE_P(Stacks, OwnAxes,
                         testing::Values(Stack::TurnAndMove, Stack::WithScale, Stack::Matrix,
                                         Stack::Axes));
