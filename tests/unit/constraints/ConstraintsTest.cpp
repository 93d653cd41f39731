// SPDX-License-Identifier: MIT
#include "ConstrainedRig.h"
#include "FindNodes.h"
#include "Notices.h"
#include "UpdateAt.h"

#include <osgSkin/Error>
#include <osgSkinCharacter/LoadCharacter>
#include <osgSkinMotion/ClipCharacter>
#include <osgSkinMotion/Constraints>
#include <osgSkinMotion/SampledClip>
#include <osgSkinMotion/SpringBones>

#include <osgDB/ReadFile>
#include <osgDB/WriteFile>

#include <gtest/gtest.h>

#include <limits>
#include <string>
#include <vector>

namespace {

using osgSkin::attach;
using osgSkin::Constraint;
using osgSkin::Constraints;
using osgSkin::find;
using osgSkin::SpringBones;

const std::vector<test::NodeConstraint> kArm = {{"twist", "hand", "roll", "Y", 0.5},
                                                {"sleeve", "lower", "aim", "PositiveX", 0.7},
                                                {"copy", "upper", "rotation", "", 1.0}};

Constraint makeConstraint(const std::string& joint, const std::string& source) {
    Constraint result;
    result.joint.name = joint;
    result.source.name = source;
    return result;
}

std::string errorOf(const std::vector<Constraint>& constraints) {
    try {
        const osg::ref_ptr<Constraints> made = new Constraints(constraints);
        return "";
    } catch (const osgSkin::Error& error) {
        return error.what();
    }
}

/// The bone's callbacks of these classes, the last to act first.
std::string orderOf(osgAnimation::Bone& bone) {
    std::string result;
    for (osg::Callback* c = bone.getUpdateCallback(); c; c = c->getNestedCallback()) {
        if (dynamic_cast<Constraints*>(c)) result += "constraints ";
        if (dynamic_cast<SpringBones*>(c)) result += "springs ";
    }
    return result;
}

} // namespace

TEST(Constraints, RefuseCirclesAndNumbersThatCannotBe) {
    EXPECT_EQ(errorOf({}), "");
    EXPECT_EQ(errorOf({makeConstraint("a", "b"), makeConstraint("b", "c")}), "");
    EXPECT_EQ(
        errorOf({makeConstraint("a", "b"), makeConstraint("c", "b"), makeConstraint("b", "a")}),
        "\"a\" follows \"b\", which follows it: expected no circle");
    EXPECT_NE(errorOf({makeConstraint("a", "a")}), "");
    const std::string wrong = "constraint of \"a\": expected rotations and an axis with lengths "
                              "above 1e-12 and up to 1e12, and a weight of 0 to 1";
    constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
    const auto with = [](auto change) {
        Constraint odd = makeConstraint("a", "b");
        change(odd);
        return errorOf({odd});
    };
    EXPECT_EQ(with([](Constraint& odd) { odd.axis = glm::dvec3(0.0); }), wrong);
    EXPECT_EQ(with([](Constraint& odd) { odd.axis.x = kNone; }), wrong);
    EXPECT_EQ(with([](Constraint& odd) { odd.axis.y = 1e200; }), wrong);
    EXPECT_EQ(with([](Constraint& odd) { odd.source.rest.x = 1e200; }), wrong);
    EXPECT_EQ(with([](Constraint& odd) { odd.weight = 1.25; }), wrong);
    EXPECT_EQ(with([](Constraint& odd) { odd.weight = kNone; }), wrong);
    EXPECT_EQ(with([](Constraint& odd) { odd.source.axes = glm::dquat(0, 0, 0, 0); }), wrong);
    EXPECT_EQ(with([](Constraint& odd) { odd.joint.rest.w = kNone; }), wrong);
    EXPECT_EQ(with([](Constraint& odd) { odd.axis *= 7.0; }), "");
}

/// In the order of the list, each depends on the next.
TEST(Constraints, MayBeALongChain) {
    const std::size_t count = 100'000;
    const osg::ref_ptr<osgAnimation::Skeleton> skeleton = new osgAnimation::Skeleton;
    const osg::ref_ptr<osgAnimation::Bone> root = new osgAnimation::Bone("root");
    skeleton->addChild(root);
    std::vector<Constraint> chain;
    for (std::size_t i = 0; i < count; ++i) {
        root->addChild(new osgAnimation::Bone("b" + std::to_string(i)));
        if (i > 0)
            chain.push_back(makeConstraint("b" + std::to_string(i - 1), "b" + std::to_string(i)));
    }
    const osg::Quat turn(0.5, osg::Vec3d(0, 0, 1));
    auto* const last = static_cast<osgAnimation::Bone*>(root->getChild(count - 1));
    last->setMatrix(osg::Matrix::rotate(turn));
    last->setMatrixInSkeletonSpace(last->getMatrix());
    const osg::ref_ptr<Constraints> constraints = new Constraints(chain);
    constraints->apply(*skeleton);
    auto* const first = static_cast<osgAnimation::Bone*>(root->getChild(0));
    EXPECT_LT((first->getMatrix().getRotate() - turn).length(), 1e-6);
}

TEST(Constraints, ComeBeforeSprings) {
    osgSkin::SpringSettings springs;
    springs.chains.resize(1);
    springs.chains[0].joints = {{"hand", {0, 2, 0}}};
    for (const bool springsFirst : {true, false}) {
        test::ConstrainedRig rig(0);
        osgSkin::Character character = osgSkin::loadCharacter(rig.write("order.vrm", kArm));
        osgAnimation::Skeleton& skeleton = *character.skeleton;
        const osg::ref_ptr<Constraints> constraints = find<Constraints>(skeleton);
        ASSERT_TRUE(constraints);
        attach<SpringBones>(*character.root, springs);
        if (springsFirst) attach(*character.root, *constraints); // again
        EXPECT_EQ(orderOf(*character.bone("root")), "springs constraints ");
    }
}

TEST(Constraints, FollowABonePlayer) {
    test::ConstrainedRig rig(4);
    osgSkin::Character character = osgSkin::loadCharacter(rig.write("player.vrm", kArm));
    const auto player = attach<osgSkin::ClipPlayer>(*character.root);
    player->setLayer(0, {player->clip("move"), 1.0, 0.0});
    test::updateAt(*character.root, 0.0);
    test::updateAt(*character.root, 0.5);
    EXPECT_LT(rig.error(*character.skeleton, rig.expected(1, kArm)), 1e-5);
}

/// Which copies without bones, crowds and walkers play.
TEST(Constraints, AreInSampledClips) {
    test::ConstrainedRig rig(4, true);
    osgSkin::Character character = osgSkin::loadCharacter(rig.write("sampled.vrm", kArm));
    const auto clips = osgSkin::ClipCharacter::create(*character.root);
    const osg::Matrixd before = character.bone("copy")->getMatrix();
    const auto clip = clips->clip("move");
    EXPECT_EQ(character.bone("copy")->getMatrix(), before);
    const auto bind = rig.placesOf([&](std::size_t n) { return rig.nodes[n].bind; });
    for (const int key : {0, 1}) {
        const auto expected = rig.expected(key, kArm);
        const osgSkin::JointSample* const sample =
            clip->sample(std::size_t(key / clip->step() + 0.5));
        std::vector<glm::dquat> turns;
        for (std::size_t j = 0; j < clip->joints().size(); ++j) {
            const osgSkin::SampledClip::Joint& joint = clip->joints()[j];
            turns.push_back(sample[j].rotation);
            if (joint.parent >= 0) turns[j] = turns[std::size_t(joint.parent)] * turns[j];
            const std::size_t n = rig.indexOf(joint.name);
            const glm::dmat3 wanted =
                glm::mat3_cast(expected[n]) * glm::inverse(glm::dmat3(bind[n]));
            const glm::dmat3 found = glm::mat3_cast(turns[j]);
            for (int c = 0; c < 3; ++c)
                EXPECT_LT(glm::length(found[c] - wanted[c]), 1e-5) << joint.name << ", " << key;
        }
    }
}

TEST(Constraints, OutliveBones) {
    test::ConstrainedRig rig(4);
    osgSkin::Character character = osgSkin::loadCharacter(rig.write("lost.vrm", kArm));
    test::updateAt(*character.root, 1.0);
    const osg::ref_ptr<osgAnimation::Bone> lower = character.bone("lower");
    const test::Notices notices; // of the skin
    lower->removeChild(character.bone("twist"));
    test::updateAt(*character.root, 1.1);
    osg::Group& upper = *lower->getParent(0);
    upper.removeChild(lower);
    test::updateAt(*character.root, 1.2);
}

class SavedConstraints : public testing::TestWithParam<const char*> {};

TEST_P(SavedConstraints, PoseAsBefore) {
    test::ConstrainedRig rig(6, true);
    const osgSkin::Character character = osgSkin::loadCharacter(rig.write("saved.vrm", kArm));
    const std::string file = testing::TempDir() + "constraints." + GetParam();
    ASSERT_TRUE(osgDB::writeNodeFile(*character.root, file));
    const osg::ref_ptr<osg::Node> read = osgDB::readRefNodeFile(file);
    ASSERT_TRUE(read);
    const auto skeletons = test::findNodes<osgAnimation::Skeleton>(*read);
    ASSERT_EQ(skeletons.size(), 1u);
    const Constraints* const found = find<Constraints>(*skeletons[0].node);
    ASSERT_TRUE(found);
    ASSERT_EQ(found->get().size(), 3u);
    for (const double time : {0.0, 1.0}) {
        test::updateAt(*read, time);
        EXPECT_LT(rig.error(*skeletons[0].node, rig.expected(int(time), kArm)), 1e-5);
    }
    const osg::ref_ptr<osg::Node> copy =
        osg::clone(read.get(), osg::CopyOp::DEEP_COPY_NODES | osg::CopyOp::DEEP_COPY_DRAWABLES |
                                   osg::CopyOp::DEEP_COPY_CALLBACKS);
    test::updateAt(*copy, 0.0);
    test::updateAt(*copy, 1.0);
    const auto copies = test::findNodes<osgAnimation::Skeleton>(*copy);
    EXPECT_LT(rig.error(*copies.at(0).node, rig.expected(1, kArm)), 1e-5);
}

INSTANTIATE_TEST_SUITE_P(Formats, SavedConstraints, testing::Values("osgt", "osgb", "osgx"));
