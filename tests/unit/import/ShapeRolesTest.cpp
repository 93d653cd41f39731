// SPDX-License-Identifier: MIT
//
// Joints with meaningless names, recognised by the skeleton's shape.
//
// Joints that are not part of the body: targets, cloth, held objects. They move nothing else.
//
// Third-party skeletons, whose bones have their own axes and update callbacks, in a clip's frame.
#include "ExpectError.h"
#include "Figure.h"
#include "FindNodes.h"
#include "Notices.h"
#include "Paths.h"
#include "UpdateAt.h"

#include <osgSkin/AutoPlayManager>
#include <osgSkin/BoneReader>
#include <osgSkin/GlmOsg>
#include <osgSkin/UpdatePlayedSkeleton>
#include <osgSkinImport/ImportMotion>
#include <osgSkinImport/ImportSkeleton>
#include <osgSkinRig/ApplyFrame>
#include <osgSkinRig/Clip>
#include <osgSkinRig/JointRoles>
#include <osgSkinRig/MakeAnimation>
#include <osgSkinRig/MakeSkeleton>
#include <osgSkinRig/ReadSkeleton>
#include <osgSkinRig/Retarget>
#include <osgSkinRig/RetargetReport>

#include <gtest/gtest.h>
#include <osgAnimation/Bone>
#include <osgAnimation/StackedMatrixElement>
#include <osgAnimation/StackedQuaternionElement>
#include <osgAnimation/StackedRotateAxisElement>
#include <osgAnimation/StackedScaleElement>
#include <osgAnimation/StackedTranslateElement>
#include <osgAnimation/UpdateBone>

#include <functional>
#include <map>
#include <string>
#include <vector>

using namespace osgSkin;

namespace {

RestSkeleton nameless(RestSkeleton skeleton) {
    for (std::size_t j = 0; j < skeleton.joints.size(); ++j)
        skeleton.joints[j].name = "Bone." + std::to_string(100 + j);
    return skeleton;
}

/// Joints that the shape gives another role than their names do, among those that every body has.
std::string wrongByShape(const RestSkeleton& body, const JointRoles& told) {
    const JointRoles named = recogniseJoints(body);
    std::string result;
    for (const char* role :
         {"Hips", "Head", "LeftUpperLeg", "LeftLowerLeg", "LeftFoot", "RightUpperLeg",
          "RightLowerLeg", "RightFoot", "LeftUpperArm", "LeftLowerArm", "LeftHand", "RightUpperArm",
          "RightLowerArm", "RightHand"}) {
        const auto found = told.joints.find(role);
        const int theirs = found == told.joints.end() ? -1 : found->second[0];
        if (theirs != named.joints.at(role)[0])
            result += std::string(role) + " is " +
                      (theirs < 0 ? "none" : body.joints[std::size_t(theirs)].name) + "; ";
    }
    return result;
}

/// A body with 60 chains of three bones around its hips, as long as its thighs.
RestSkeleton skirted(RestSkeleton body, const JointRoles& roles, double length) {
    const int hips = roles.joints.at("Hips")[0];
    const glm::dvec3 from = body.joints[std::size_t(hips)].centre;
    for (int i = 0; i < 60; ++i) {
        const double angle = glm::radians(6.0 * i);
        const glm::dvec3 way(0.4 * std::cos(angle), -0.9, 0.4 * std::sin(angle));
        int parent = hips;
        for (int part = 1; part <= 3; ++part)
            parent = body.add("skirt" + std::to_string(i) + "_" + std::to_string(part), parent,
                              from + length * part / 3.0 * glm::normalize(way));
    }
    return body;
}

class ShapeRoles : public testing::TestWithParam<const char*> {
protected:
    RestSkeleton body() const {
        const std::string path = GetParam();
        return importSkeleton(path[0] == '/' ? path : sharedData(path));
    }
    bool missing() const {
        const std::string path = GetParam();
        return !std::filesystem::exists(path[0] == '/' ? path : sharedData(path));
    }
};

} // namespace

TEST_P(ShapeRoles, TellsTheMainJoints) {
    if (missing()) GTEST_SKIP() << "needs " << GetParam();
    const RestSkeleton standing = body();
    const JointRoles told = recogniseJoints(nameless(standing));
    EXPECT_EQ(told.family, kInferredFromGeometry);
    EXPECT_EQ(wrongByShape(standing, told), "");
}

TEST_P(ShapeRoles, OfABodyInASkirtOfManyBones) {
    if (missing()) GTEST_SKIP() << "needs " << GetParam();
    RestSkeleton standing = body();
    const JointRoles bare = recogniseJoints(standing);
    const glm::dvec3 hips = standing.joints[std::size_t(bare.joints.at("Hips")[0])].centre;
    const int knee = bare.joints.at("LeftLowerLeg")[0];
    const double length = glm::distance(hips, standing.joints[std::size_t(knee)].centre);
    const JointRoles told = recogniseJoints(nameless(skirted(standing, bare, length)));
    EXPECT_EQ(wrongByShape(standing, told), "");
}

TEST_P(ShapeRoles, WhicheverWayTheBodyFaces) {
    if (missing()) GTEST_SKIP() << "needs " << GetParam();
    RestSkeleton turned = body();
    const glm::dquat turn = turnDegrees(90.0, {1, 0, 0}) * turnDegrees(140.0, {0, 1, 0});
    for (RestJoint& joint : turned.joints) {
        joint.centre = 0.01 * (turn * joint.centre) + glm::dvec3(3, 4, 5);
        if (joint.tip) joint.tip = 0.01 * (turn * *joint.tip) + glm::dvec3(3, 4, 5);
    }
    EXPECT_EQ(wrongByShape(turned, recogniseJoints(nameless(turned))), "");
}

INSTANTIATE_TEST_SUITE_P(Bodies, ShapeRoles,
                         testing::Values(OSGSKIN_DATA "/thrower.bvh",
                                         "makehuman/rig/cmu_mb_neutral.bvh",
                                         "makehuman/rig/game_engine_male.bvh", "cmu/daz/02_05.bvh",
                                         "cmu/max/131_01.bvh",
                                         "/usr/share/assimp/models/BVH/Boxing_Toes.bvh"),
                         [](const auto& tested) {
                             std::string name = std::filesystem::path(tested.param).stem();
                             for (char& c : name)
                                 if (std::isalnum(static_cast<unsigned char>(c)) == 0) c = '_';
                             return name;
                         });

/// Any two of its limbs are mirror images.
TEST(ShapeRolesOf, AStarOfThreeThousandLimbsIsNone) {
    RestSkeleton star;
    star.add("middle", -1, glm::dvec3(0));
    for (int i = 0; i < 3000; ++i) {
        const glm::dvec3 way(std::cos(i), std::sin(i), 0.001 * i);
        int parent = 0;
        for (int part = 1; part <= 3; ++part)
            parent = star.add("b" + std::to_string(i) + "_" + std::to_string(part), parent,
                              double(part) * glm::normalize(way));
    }
    EXPECT_FALSE(recogniseJoints(star).known());
}

TEST(ShapeRolesOf, ThingsThatAreNoPersonAreNone) {
    RestSkeleton snake;
    for (int j = 0; j < 20; ++j) snake.add("b" + std::to_string(j), j - 1, glm::dvec3(0, 0, j));
    EXPECT_FALSE(recogniseJoints(snake).known());

    // A dog: its trunk is perpendicular to its legs.
    RestSkeleton dog;
    const int rump = dog.add("a", -1, glm::dvec3(0, 1, 0));
    const int chest = dog.add("b", rump, glm::dvec3(0, 1, 1));
    const int neck = dog.add("c", chest, glm::dvec3(0, 1.2, 1.2));
    dog.add("d", neck, glm::dvec3(0, 1.4, 1.4));
    for (const int base : {rump, chest})
        for (const double across : {0.2, -0.2}) {
            const double along = base == rump ? 0.0 : 1.0;
            const std::string name = std::to_string(base) + (across > 0.0 ? "l" : "r");
            const int upper = dog.add(name + "1", base, glm::dvec3(across, 0.9, along));
            const int lower = dog.add(name + "2", upper, glm::dvec3(across, 0.5, along));
            dog.add(name + "3", lower, glm::dvec3(across, 0.1, along));
        }
    EXPECT_FALSE(recogniseJoints(dog).known());
}

TEST(ShapeRolesOf, TheReportSaysWhatTheShapeTold) {
    const RestSkeleton body = nameless(importSkeleton(OSGSKIN_DATA "/thrower.bvh"));
    RetargetReport report;
    retarget(importMotion(OSGSKIN_DATA "/throw.bvh"), body, {}, &report);
    EXPECT_EQ(report.rigNames, kInferredFromGeometry);
    ASSERT_FALSE(report.notes.empty());
    EXPECT_NE(report.notes[0].find("inferred from its shape"), std::string::npos)
        << report.notes[0];
    EXPECT_NE(report.text().find("names: rig inferred from the skeleton's shape, motion CMU"),
              std::string::npos);
}

namespace {

/// makeFigure() with its right side.
RestSkeleton makeBody(double armDegrees) {
    RestSkeleton body = makeFigure(armDegrees);
    const std::vector<RestJoint> left = body.joints;
    const auto mirrored = [](glm::dvec3 p) { return glm::dvec3(-p.x, p.y, p.z); };
    const auto otherSide = [](const std::string& name) {
        return name.substr(0, 4) == "Left" ? "Right" + name.substr(4) : "R" + name.substr(1);
    };
    for (const RestJoint& joint : left) {
        if (joint.name[0] != 'L') continue;
        RestJoint other = joint;
        other.name = otherSide(joint.name);
        other.centre = mirrored(joint.centre);
        if (joint.tip) other.tip = mirrored(*joint.tip);
        const std::string& above = left[std::size_t(joint.parent)].name;
        if (above[0] == 'L') other.parent = body.find(otherSide(above));
        body.joints.push_back(other);
    }
    return body;
}

struct Helper {
    const char* what;
    std::function<void(RestSkeleton&)> add;
};

void chain(RestSkeleton& body, const char* name, const char* above, glm::dvec3 to) {
    const int top = body.find(above);
    const glm::dvec3 from = body.joints[std::size_t(top)].centre;
    const int first = body.add(std::string(name) + "1", top, 0.5 * (from + to));
    body.add(std::string(name) + "2", first, to);
}

std::vector<Helper> helpers() {
    return {
        {"a cape",
         [](RestSkeleton& body) {
             chain(body, "cape", "Spine", {0, 0.2, -1});
         }},
        {"a tail",
         [](RestSkeleton& body) {
             chain(body, "tail", "Hips", {0, -0.5, -2});
         }},
        {"cloth on a thigh",
         [](RestSkeleton& body) {
             chain(body, "dress", "LeftUpLeg", {2, -1, 0});
         }},
        {"a sword",
         [](RestSkeleton& body) {
             chain(body, "blade", "LeftHand", {8, -3, 0});
         }},
        {"a camera", [](RestSkeleton& body) { body.add("eye", 0, glm::dvec3(0, 100, 0)); }},
        {"a joint under the floor",
         [](RestSkeleton& body) { body.add("under", 0, glm::dvec3(0, -9, 0)); }},
        {"targets of feet",
         [](RestSkeleton& body) {
             const int root = body.add("ik_foot_root", 0, glm::dvec3(0, 0, 0));
             body.add("ik_foot_l", root, glm::dvec3(1, 1, 0));
             body.add("ik_foot_r", root, glm::dvec3(-1, 1, 0));
         }},
    };
}

Motion walkAway(const RestSkeleton& actor) {
    Motion motion = standStill(actor, 20);
    for (std::size_t f = 0; f < motion.frames; ++f) {
        motion.rootPositions[f] += glm::dvec3(0.1, 0.0, 0.3) * double(f);
        motion.rotations[f * actor.joints.size() + std::size_t(actor.find("LeftUpLeg"))] =
            turnDegrees(2.0 * double(f), {1, 0, 0});
    }
    return motion;
}

void expectTheSame(const Clip& clip, const RetargetReport& report, const Clip& plain,
                   const RetargetReport& plainReport) {
    EXPECT_NEAR(report.scale, plainReport.scale, 1e-12);
    ASSERT_EQ(clip.frames, plain.frames);
    for (std::size_t f = 0; f < plain.frames; ++f) {
        EXPECT_LT(glm::length(clip.rootPositions[f] - plain.rootPositions[f]), 1e-9) << f;
        for (std::size_t j = 0; j < plain.joints; ++j)
            ASSERT_LT(angleBetween(clip.rotations[f * clip.joints + j],
                                   plain.rotations[f * plain.joints + j]),
                      1e-6)
                << "joint " << j << ", sample " << f;
    }
}

} // namespace

TEST(HelperJoints, OfARigChangeNoPose) {
    const Motion motion = walkAway(makeBody(30.0));
    const RestSkeleton rig = makeBody(0.0);
    RetargetReport plainReport;
    const Clip plain = retarget(motion, rig, {}, &plainReport);
    for (const Helper& helper : helpers()) {
        SCOPED_TRACE(helper.what);
        RestSkeleton with = rig;
        helper.add(with);
        RetargetReport report;
        const Clip clip = retarget(motion, with, {}, &report);
        expectTheSame(clip, report, plain, plainReport);
    }
}

TEST(HelperJoints, OfAMotionChangeNoPose) {
    const RestSkeleton actor = makeBody(30.0);
    const RestSkeleton rig = makeBody(0.0);
    RetargetReport plainReport;
    const Clip plain = retarget(walkAway(actor), rig, {}, &plainReport);
    for (const Helper& helper : helpers()) {
        SCOPED_TRACE(helper.what);
        RestSkeleton with = actor;
        helper.add(with);
        RetargetReport report;
        const Clip clip = retarget(walkAway(with), rig, {}, &report);
        expectTheSame(clip, report, plain, plainReport);
    }
}

/// There is no height to compare: the motion's unit stays.
TEST(HelperJoints, AMotionWithoutLegsKeepsItsUnit) {
    RestSkeleton actor;
    const RestSkeleton body = makeBody(30.0);
    std::vector<int> now(body.joints.size(), -1);
    for (std::size_t j = 0; j < body.joints.size(); ++j) {
        RestJoint joint = body.joints[j];
        if (joint.name.find("Leg") != std::string::npos ||
            joint.name.find("Foot") != std::string::npos ||
            joint.name.find("HipJoint") != std::string::npos)
            continue;
        if (joint.parent >= 0) joint.parent = now[std::size_t(joint.parent)];
        now[j] = int(actor.joints.size());
        actor.joints.push_back(joint);
    }
    Motion motion = standStill(actor, 2);
    motion.rootPositions[1] += glm::dvec3(4, 0, -2);
    RetargetReport report;
    const Clip clip = retarget(motion, makeBody(0.0), {}, &report);
    EXPECT_DOUBLE_EQ(report.scale, 1.0);
    EXPECT_LT(glm::length(clip.rootPositions[1] - clip.rootPositions[0] - glm::dvec3(4, 0, -2)),
              1e-9);
}

/// A held object does not give the hand's direction; its tip and its fingers do.
TEST(HelperJoints, AHandDoesNotTurnToWhatItHolds) {
    RestSkeleton rig = makeBody(0.0);
    const int hand = rig.find("LeftHand");
    rig.joints[std::size_t(hand)].tip.reset();
    const Motion motion = standStill(makeBody(0.0), 1);
    const glm::dvec3 at = rig.joints[std::size_t(hand)].centre;
    for (const char* held : {"staff", "sword_l", "weapon"}) {
        RestSkeleton with = rig;
        with.add(held, hand, at + glm::dvec3(0.0, -0.5, 1.0));
        RetargetReport report;
        retarget(motion, with, {}, &report);
        EXPECT_NEAR(report.entries[std::size_t(hand)].alignmentDegrees, 0.0, 1e-9) << held;
    }
    RestSkeleton ends = rig;
    ends.add("LeftHand_end", hand, at + glm::dvec3(0.0, 0.0, 1.0));
    RetargetReport report;
    retarget(motion, ends, {}, &report);
    EXPECT_NEAR(report.entries[std::size_t(hand)].alignmentDegrees, 90.0, 1e-6);
}

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

TEST_P(OwnAxes, MoveTheSkinAsTheClipDoes) {
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

TEST_P(OwnAxes, PlayWhatAClipSays) {
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
    osgSkin::setBonesFollow(*own, true);
    for (std::size_t frame = 0; frame < clip.frames; ++frame) {
        osgSkin::applyFrame(clip, rig, frame, *plain);
        test::updateAt(*scene, 0.1 * static_cast<double>(frame));
        EXPECT_LT(largestDifference(skinning(*own), skinning(*plain)), 2e-4) << frame;
    }
}

/// A skeleton that no skin was bound to: bones keep the axes of the file.
TEST(OwnAxesTrees, MayBeBoundToNothing) {
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
TEST(OwnAxesTrees, MayDiffer) {
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
