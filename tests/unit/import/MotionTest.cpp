// SPDX-License-Identifier: MIT
#include "Notices.h"
#include "Paths.h"

#include <osgSkin/Error>
#include <osgSkinImport/ImportMotion>
#include <osgSkinImport/ImportSkeleton>
#include <osgSkinRig/Motion>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/trigonometric.hpp>

namespace {

const glm::dvec3 kX(1, 0, 0);
const glm::dvec3 kY(0, 1, 0);
const glm::dvec3 kZ(0, 0, 1);

glm::dquat turn(double degrees, const glm::dvec3& axis) {
    return glm::angleAxis(glm::radians(degrees), axis);
}

double difference(const glm::dquat& a, const glm::dquat& b) {
    return glm::length(a * glm::conjugate(b) * glm::dvec3(1, 2, 3) - glm::dvec3(1, 2, 3)) +
           glm::length(a * glm::conjugate(b) * kX - kX);
}

TEST(ImportMotion, ReadsTheDeclaredChannelOrderOfEachJoint) {
    const osgSkin::Motion motion = osgSkin::importMotion(testData("bvh/two_joints.bvh"));
    ASSERT_EQ(motion.frames, 2u);
    ASSERT_EQ(motion.skeleton.joints.size(), 2u);
    EXPECT_EQ(motion.name, "two_joints");
    EXPECT_EQ(motion.frameTime, 0.025);
    EXPECT_LT(difference(motion.rotation(0, 0), {1, 0, 0, 0}), 1e-12);
    EXPECT_LT(difference(motion.rotation(1, 0), turn(10, kZ) * turn(20, kY) * turn(30, kX)), 1e-12);
    EXPECT_LT(difference(motion.rotation(1, 1), turn(40, kX) * turn(50, kY) * turn(60, kZ)), 1e-12);
    EXPECT_GT(difference(motion.rotation(1, 1), turn(60, kZ) * turn(50, kY) * turn(40, kX)), 0.1);
}

TEST(ImportMotion, PositionChannelsReplaceTheRootsOffset) {
    const osgSkin::Motion motion = osgSkin::importMotion(testData("bvh/two_joints.bvh"));
    EXPECT_EQ(motion.skeleton.joints[0].centre, glm::dvec3(0, 10, 0));
    EXPECT_EQ(motion.rootPositions[0], glm::dvec3(0, 10, 0));
    EXPECT_EQ(motion.rootPositions[1], glm::dvec3(1, 11, 2));
}

TEST(ImportMotion, RootWithoutPositionChannelsStaysAtItsOffset) {
    const osgSkin::Motion motion = osgSkin::importMotion(testData("bvh/root_only.bvh"));
    ASSERT_EQ(motion.frames, 1u);
    EXPECT_EQ(motion.frameTime, 0.5);
    EXPECT_EQ(motion.rootPositions[0], glm::dvec3(1, 2, 3));
    EXPECT_LT(difference(motion.rotation(0, 0), turn(10, kY) * turn(20, kX) * turn(30, kZ)), 1e-12);
}

/// Of hips that move over a root on the ground, the path is the hips': rotated by the root, from
/// where it stands.
TEST(ImportMotion, BeginsWithTheJointThatMoves) {
    const test::Notices notices;
    const osgSkin::Motion motion = osgSkin::importMotion(testData("root_on_ground.bvh"));
    EXPECT_EQ(notices.text(), ""); // the root's own moves are used as well
    ASSERT_EQ(motion.skeleton.joints.size(), 3u);
    EXPECT_EQ(motion.skeleton.joints[0].name, "pelvis");
    EXPECT_EQ(motion.skeleton.joints[0].parent, -1);
    EXPECT_EQ(motion.skeleton.joints[2].parent, 0);
    EXPECT_NO_THROW(motion.skeleton.validate());
    ASSERT_EQ(motion.rotations.size(), 6u);
    EXPECT_LT(glm::distance(motion.rootPositions[0], glm::dvec3(0, 10, 0)), 1e-12);
    EXPECT_LT(glm::distance(motion.rootPositions[1], glm::dvec3(5 + 3, 11, 0)), 1e-12);
    EXPECT_LT(difference(motion.rotation(1, 0), turn(90, kY)), 1e-12);
    EXPECT_LT(difference(motion.rotation(1, 1), {1, 0, 0, 0}), 1e-12);
}

TEST(ImportMotion, LineEndsAndWrappedFramesDoNotMatter) {
    const osgSkin::Motion plain = osgSkin::importMotion(testData("bvh/two_joints.bvh"));
    for (const char* name : {"bvh/two_joints_crlf.bvh", "bvh/wrapped_rows.bvh"}) {
        const osgSkin::Motion other = osgSkin::importMotion(testData(name));
        EXPECT_EQ(other.rotations, plain.rotations) << name;
        EXPECT_EQ(other.rootPositions, plain.rootPositions) << name;
    }
}

TEST(ImportMotion, SkipsSamples) {
    const osgSkin::Motion all = osgSkin::importMotion(testData("bvh/two_joints.bvh"));
    const osgSkin::Motion last = osgSkin::importMotion(testData("bvh/two_joints.bvh"), 1);
    ASSERT_EQ(last.frames, 1u);
    EXPECT_EQ(last.rotation(0, 1), all.rotation(1, 1));
    EXPECT_EQ(last.rootPositions[0], all.rootPositions[1]);
}

TEST(ImportSkeleton, HasCentresParentsAndTips) {
    const osgSkin::RestSkeleton skeleton = osgSkin::importSkeleton(testData("bvh/two_joints.bvh"));
    ASSERT_EQ(skeleton.joints.size(), 2u);
    EXPECT_EQ(skeleton.joints[0].name, "Hips");
    EXPECT_EQ(skeleton.joints[0].parent, -1);
    EXPECT_FALSE(skeleton.joints[0].tip);
    EXPECT_EQ(skeleton.joints[1].name, "Spine");
    EXPECT_EQ(skeleton.joints[1].parent, 0);
    EXPECT_EQ(skeleton.joints[1].centre, glm::dvec3(0, 15, 1));
    ASSERT_TRUE(skeleton.joints[1].tip);
    EXPECT_EQ(*skeleton.joints[1].tip, glm::dvec3(0, 19, 1));
}

TEST(ImportSkeleton, NeedsNoFrame) {
    EXPECT_EQ(osgSkin::importSkeleton(testData("bvh/no_frames.bvh")).joints.size(), 2u);
}

TEST(ImportSkeleton, ReadsAMakeHumanRig) {
    const std::string path = sharedData("makehuman/rig/cmu_mb_neutral.bvh");
    OSGSKIN_NEEDS(path);
    const osgSkin::RestSkeleton rig = osgSkin::importSkeleton(path);
    EXPECT_EQ(rig.joints.size(), 31u);
    EXPECT_LT(glm::distance(rig.joints[0].centre, glm::dvec3(0, 0.72685, 0.1445)), 1e-12);
    const int head = rig.find("Head");
    ASSERT_GE(head, 0);
    ASSERT_TRUE(rig.joints[static_cast<std::size_t>(head)].tip);
    EXPECT_NEAR(rig.joints[static_cast<std::size_t>(head)].tip->y, 8.4044, 1e-4);
}

TEST(ImportMotion, PassesOverFramesBeyondTheDeclared) {
    const osgSkin::Motion motion = osgSkin::importMotion(testData("bvh/more_rows.bvh"));
    EXPECT_EQ(motion.frames, 2u);
}

/// A motion made in code, by GLM's types and by OSG's.
TEST(Motion, IsMadeOfSamples) {
    osgSkin::RestSkeleton skeleton;
    EXPECT_EQ(skeleton.add("Hips", -1, glm::dvec3(0, 1, 0)), 0);
    EXPECT_EQ(skeleton.add("Spine", 0, osg::Vec3d(0, 2, 0.5)), 1);
    skeleton.validate();
    EXPECT_EQ(skeleton.joints[1].centre, glm::dvec3(0, 2, 0.5));
    EXPECT_EQ(skeleton.joints[1].parent, 0);

    osgSkin::Motion motion;
    motion.name = "bow";
    motion.skeleton = skeleton;
    const osg::Quat bow(osg::PI_2, osg::X_AXIS);
    motion.addFrame(osg::Vec3d(1, 2, 3), {osg::Quat(), bow});
    motion.addFrame(glm::dvec3(4, 5, 6), {turn(90, kX), glm::dquat(1, 0, 0, 0)});
    ASSERT_EQ(motion.frames, 2u);
    EXPECT_LT(difference(motion.rotation(0, 1), turn(90, kX)), 1e-12);
    EXPECT_LT(difference(motion.rotation(1, 0), turn(90, kX)), 1e-12);
    EXPECT_EQ(motion.rootPositions[0], glm::dvec3(1, 2, 3));
    EXPECT_EQ(motion.rootPositions[1], glm::dvec3(4, 5, 6));

    EXPECT_THROW(motion.addFrame(osg::Vec3d(), {bow}), osgSkin::Error);
    EXPECT_EQ(motion.frames, 2u);
    EXPECT_EQ(motion.rotations.size(), 4u);
}

} // namespace
