// SPDX-License-Identifier: MIT
// Motions with a zero pose in which no body could stand.
#include "ActorMotions.h"
#include "BvhWriter.h"
#include "ExpectError.h"
#include "Figure.h"
#include "GltfWriter.h"

#include <osgSkinImport/ImportMotion>
#include <osgSkinImport/ImportSkeleton>
#include <osgSkinRig/Retarget>

#include <glm/gtc/quaternion.hpp>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <cmath>

using namespace osgSkin;

namespace {

/// Every bone along +y, like the zero poses of capture suits' software.
std::vector<glm::dquat> alongOneAxis(const RestSkeleton& skeleton) {
    std::vector<glm::dquat> result;
    for (std::size_t j = 0; j < skeleton.joints.size(); ++j) {
        glm::dvec3 bone(0.0, 1.0, 0.0);
        for (const int child : skeleton.children(int(j)))
            bone = skeleton.joints[std::size_t(child)].centre - skeleton.joints[j].centre;
        if (!(glm::length(bone) > 1e-9)) bone = {0.0, 1.0, 0.0};
        bone = glm::normalize(bone);
        const glm::dvec3 axis = glm::cross(bone, glm::dvec3(0.0, 1.0, 0.0));
        result.push_back(
            glm::length(axis) < 1e-9
                ? kIdentity
                : glm::angleAxis(std::acos(std::clamp(bone.y, -1.0, 1.0)), glm::normalize(axis)));
    }
    return result;
}

class StandingPose : public testing::Test {
protected:
    void expectLikeTheActor(const Motion& motion, const char* note) {
        RetargetReport report;
        const Clip clip = retarget(motion, rig, {}, &report);
        EXPECT_TRUE(saysOf(report, note)) << report.text().substr(0, 600);
        const Difference difference = compare(clip, rig, actor);
        EXPECT_LT(difference.limbs, 1.0);
        EXPECT_LT(difference.heads, 12.0); // the chosen sample may lean
        EXPECT_GT(difference.lowest, -0.1 * rig.joints[0].centre.y);
        EXPECT_NEAR(report.scale, 1.0, 0.1) << "the same body";
    }

    /// Through a file, like a user.
    Motion throughBvh(const Motion& motion, bool offsetsInChannels = false) {
        const std::string path = testing::TempDir() + "osgskin_" +
                                 testing::UnitTest::GetInstance()->current_test_info()->name() +
                                 ".bvh";
        writeBvh(motion, path, offsetsInChannels);
        return importMotion(path);
    }

    const Motion actor = importMotion(OSGSKIN_DATA "/throw.bvh");
    const RestSkeleton rig = importSkeleton(OSGSKIN_DATA "/thrower.bvh");
    const std::size_t joints = actor.skeleton.joints.size();
};

} // namespace

TEST_F(StandingPose, ReplacesFoldedZeroPose) {
    expectLikeTheActor(throughBvh(rebasedFrom(actor, folded(joints))), "counted from sample");
}

TEST_F(StandingPose, ReplacesBonesAlongOneAxis) {
    expectLikeTheActor(throughBvh(rebasedFrom(actor, alongOneAxis(actor.skeleton))),
                       "counted from sample");
}

TEST_F(StandingPose, KeepsHeadingsOfTheFile) {
    Motion turned = actor;
    const glm::dquat turn = turnDegrees(60, {0, 1, 0});
    for (std::size_t f = 0; f < turned.frames; ++f) {
        turned.rotations[f * joints] = turn * turned.rotations[f * joints];
        turned.rootPositions[f] = turn * turned.rootPositions[f];
    }
    for (const auto& zero : {folded(joints), alongOneAxis(actor.skeleton)}) {
        const Clip clip = retarget(throughBvh(rebasedFrom(turned, zero)), rig);
        const Difference difference = compare(clip, rig, turned);
        EXPECT_LT(difference.limbs, 1.0);
        EXPECT_LT(difference.heading, 1.0);
        const auto way = [](const std::vector<glm::dvec3>& path) {
            return path.back() - path.front();
        };
        EXPECT_LT(glm::distance(way(clip.rootPositions), way(turned.rootPositions)),
                  0.05 * rig.joints[0].centre.y);
    }
    // The same where z is up and -y is the front.
    Motion zUp = turned;
    const glm::dquat lay = turnDegrees(90, {1, 0, 0});
    for (std::size_t f = 0; f < zUp.frames; ++f) {
        zUp.rotations[f * joints] = lay * zUp.rotations[f * joints];
        zUp.rootPositions[f] = lay * zUp.rootPositions[f];
    }
    RetargetOptions options;
    options.up = RetargetOptions::Up::Z;
    const Clip clip = retarget(throughBvh(rebasedFrom(zUp, folded(joints))), rig, options);
    EXPECT_LT(compare(clip, rig, turned).heading, 1.0);
}

TEST_F(StandingPose, PrefersCalibrationPose) {
    Motion calibrated = actor;
    calibrated.frames += 1;
    calibrated.rotations.insert(calibrated.rotations.begin() + std::ptrdiff_t(40 * joints), joints,
                                kIdentity);
    calibrated.rootPositions.insert(calibrated.rootPositions.begin() + 40, actor.rootPositions[0]);
    const Motion motion = throughBvh(rebasedFrom(calibrated, folded(joints, 3)));
    RetargetReport report;
    retarget(motion, rig, {}, &report);
    EXPECT_TRUE(saysOf(report, "counted from sample 40,")) << report.text().substr(0, 600);
    for (const RetargetReport::Entry& entry : report.entries)
        EXPECT_LT(entry.alignmentDegrees, 0.01) << entry.rigJoint << ": the rig's own rest pose";
}

/// Every frame has the offsets of all joints, and OFFSET is zero.
TEST_F(StandingPose, ReadsOffsetsFromFrames) {
    const Motion motion = throughBvh(actor, true);
    for (std::size_t j = 1; j < joints; ++j)
        EXPECT_LT(glm::distance(motion.skeleton.joints[j].centre - motion.skeleton.joints[0].centre,
                                actor.skeleton.joints[j].centre - actor.skeleton.joints[0].centre),
                  1e-9);
    const Difference difference = compare(retarget(motion, rig), rig, actor);
    EXPECT_LT(difference.limbs, 1.0);
    EXPECT_GT(difference.lowest, -0.1 * rig.joints[0].centre.y);
}

TEST_F(StandingPose, KeepsStandingZeroPose) {
    RetargetReport report;
    retarget(actor, rig, {}, &report);
    EXPECT_TRUE(report.notes.empty()) << report.notes[0];
}

/// An actor without neck and head joints is upright by his arms, in any position.
TEST_F(StandingPose, KeepsZeroPoseWithoutHead) {
    Motion aside = actor;
    for (RestJoint& joint : aside.skeleton.joints) {
        joint.centre.x += 40.0;
        if (joint.tip) joint.tip->x += 40.0;
    }
    for (glm::dvec3& root : aside.rootPositions) root.x += 40.0;
    Motion headless = aside;
    for (RestJoint& joint : headless.skeleton.joints)
        for (const char* top : {"Neck", "Head"})
            if (joint.name.find(top) != std::string::npos)
                joint.name = "x" + std::to_string(joint.parent);
    RestSkeleton wide = rig; // not the actor's own
    for (RestJoint& joint : wide.joints) joint.centre.x *= 1.3;
    RetargetReport ours, theirs;
    const Clip expected = retarget(aside, wide, {}, &ours);
    const Clip clip = retarget(headless, wide, {}, &theirs);
    EXPECT_TRUE(ours.notes.empty());
    ASSERT_EQ(theirs.notes.size(), 1u);
    EXPECT_EQ(theirs.notes[0].find("no motion data for \"Head\" of the rig"), 0u)
        << theirs.notes[0];
    const auto arm = std::size_t(wide.find("LeftArm"));
    for (std::size_t f = 0; f < clip.frames; ++f)
        ASSERT_LT(angleBetween(clip.rotations[f * clip.joints + arm],
                               expected.rotations[f * clip.joints + arm]),
                  1e-6);
}

/// A motion without a standing sample cannot be retargeted, and no pose is invented.
TEST_F(StandingPose, RejectsActorWhoNeverStands) {
    Motion sitting = actor;
    for (std::size_t f = 0; f < sitting.frames; ++f)
        for (const std::string side : {"Left", "Right"}) {
            const auto at = [&](const std::string& name) -> glm::dquat& {
                return sitting
                    .rotations[f * joints + std::size_t(sitting.skeleton.find(side + name))];
            };
            at("UpLeg") = turnDegrees(-100, {1, 0, 0});
            at("Leg") = turnDegrees(120, {1, 0, 0});
        }
    const Motion motion = throughBvh(rebasedFrom(sitting, folded(joints)));
    expectError([&] { retarget(motion, rig); }, "does not stand");
    expectError([&] { retarget(motion, rig); }, "such as a T-pose");
    EXPECT_NO_THROW(retarget(sitting, rig)) << "its zero pose stands";
}

TEST_F(StandingPose, CopiesRotationsToTheSameSkeleton) {
    const Motion motion = throughBvh(rebasedFrom(actor, folded(joints)));
    RestSkeleton same = motion.skeleton;
    RetargetReport report;
    const Clip clip = retarget(motion, same, {}, &report);
    EXPECT_TRUE(saysOf(report, "local rotations are copied"));
    ASSERT_EQ(clip.rotations.size(), motion.rotations.size());
    for (std::size_t i = 0; i < clip.rotations.size(); ++i)
        ASSERT_LT(angleBetween(clip.rotations[i], motion.rotations[i]), 1e-5);
    for (std::size_t f = 0; f < clip.frames; ++f)
        ASSERT_LT(glm::distance(clip.rootPositions[f], motion.rootPositions[f]), 1e-6);
}

/// A file with only the animation rests in any pose; its joints' axes are the character's.
TEST_F(StandingPose, SameJointsInAnotherPoseMoveAlike) {
    const Motion motion = rebasedFrom(actor, folded(joints), true);
    RetargetReport ours, theirs;
    const Clip expected = retarget(actor, rig, {}, &ours);
    const Clip clip = retarget(motion, rig, {}, &theirs);
    EXPECT_TRUE(saysOf(theirs, "local rotations are copied"));
    for (std::size_t i = 0; i < clip.rotations.size(); ++i)
        ASSERT_LT(angleBetween(clip.rotations[i], expected.rotations[i]), 1e-4);
    for (std::size_t f = 0; f < clip.frames; ++f)
        ASSERT_LT(glm::distance(clip.rootPositions[f], expected.rootPositions[f]), 1e-6);
}

/// A rig that binds no joints above the hips does not stand by itself.
TEST_F(StandingPose, SameJointsNeedNobodyWhoStands) {
    Motion sitting = actor;
    for (std::size_t f = 0; f < sitting.frames; ++f)
        for (const char* leg : {"LeftLeg", "RightLeg"})
            sitting.rotations[f * joints + std::size_t(rig.find(leg))] =
                turnDegrees(120, {1, 0, 0});
    RestSkeleton legs;
    for (const RestJoint& joint : rig.joints)
        if (joint.name.find("Hip") != std::string::npos ||
            joint.name.find("Leg") != std::string::npos ||
            joint.name.find("Foot") != std::string::npos ||
            joint.name.find("Toe") != std::string::npos) {
            RestJoint own = joint;
            if (own.parent >= 0) own.parent = legs.find(rig.joints[std::size_t(joint.parent)].name);
            legs.joints.push_back(own);
        }
    const Motion motion = rebasedFrom(sitting, folded(joints), true);
    RetargetReport report;
    const Clip clip = retarget(motion, legs, {}, &report);
    EXPECT_TRUE(saysOf(report, "local rotations are copied")) << report.text().substr(0, 300);
    for (std::size_t f = 0; f < clip.frames; ++f)
        for (std::size_t j = 1; j < clip.joints; ++j)
            ASSERT_LT(
                angleBetween(
                    clip.rotations[f * clip.joints + j],
                    sitting.rotations[f * joints + std::size_t(rig.find(legs.joints[j].name))]),
                1e-4);
}

/// The same through files, the animation's without a mesh and posed like its first sample.
TEST_F(StandingPose, GltfAnimationMovesItsCharacter) {
    const std::string stem = testing::TempDir() + "osgskin_animation_only_";
    Motion still = actor;
    const std::vector<glm::dquat> axes = folded(joints, 11); // as exporters write them
    writeGltf(still, axes, std::vector<glm::dquat>(joints, kIdentity), stem + "character.gltf");
    std::vector<glm::dquat> crouching(joints, kIdentity);
    for (std::size_t j = 0; j < joints; ++j)
        crouching[j] = folded(joints, 5)[j]; // in any pose of the file
    writeGltf(still, axes, crouching, stem + "only.gltf");

    const RestSkeleton character = importSkeleton(stem + "character.gltf");
    const Motion standing = importMotion(stem + "character.gltf");
    const Motion only = importMotion(stem + "only.gltf");
    RetargetReport report;
    const Clip expected = retarget(standing, character);
    const Clip clip = retarget(only, character, {}, &report);
    EXPECT_TRUE(saysOf(report, "local rotations are copied")) << report.text().substr(0, 300);
    ASSERT_EQ(clip.rotations.size(), expected.rotations.size());
    for (std::size_t i = 0; i < clip.rotations.size(); ++i)
        ASSERT_LT(angleBetween(clip.rotations[i], expected.rotations[i]), 0.01);
    // On another body, a sample in which the actor stands gives the rest pose.
    RetargetReport other;
    const Clip onOther = retarget(only, rig, {}, &other);
    EXPECT_TRUE(saysOf(other, "counted from sample")) << other.text().substr(0, 300);
    EXPECT_LT(compare(onOther, rig, actor).limbs, 1.0);
}

/// Meaningless names, on a folded skeleton: the rig's shape identifies both.
TEST_F(StandingPose, InfersJointsFromTheRig) {
    Motion motion = rebasedFrom(actor, folded(joints));
    RestSkeleton nameless = rig;
    for (std::size_t j = 0; j < joints; ++j)
        motion.skeleton.joints[j].name = nameless.joints[j].name = "b" + std::to_string(j);
    RetargetReport report;
    const Clip clip = retarget(motion, nameless, {}, &report);
    EXPECT_TRUE(saysOf(report, "counted from sample"));
    EXPECT_LT(compare(clip, rig, actor).limbs, 1.0);
}

/// Max's Biped writes a zero pose that stands along z, and frames along y.
TEST_F(StandingPose, ReplacesLyingZeroPose) {
    const std::vector<glm::dquat> lying(joints, turnDegrees(90, {1, 0, 0}));
    expectLikeTheActor(throughBvh(rebasedFrom(actor, lying)), "zero pose lies");
}

TEST_F(StandingPose, ReplacesLyingZeroPoseInPlace) {
    Motion inPlace = actor;
    for (glm::dvec3& position : inPlace.rootPositions) position = glm::dvec3(0.0);
    const std::vector<glm::dquat> lying(joints, turnDegrees(-90, {1, 0, 0}));
    const Motion motion = rebasedFrom(inPlace, lying);
    RetargetReport report;
    const Clip clip = retarget(motion, rig, {}, &report);
    EXPECT_TRUE(saysOf(report, "zero pose lies"));
    EXPECT_LT(compare(clip, rig, actor).limbs, 1.0);
}

/// A sleeping actor has a zero pose that stands.
TEST_F(StandingPose, KeepsLyingActor) {
    Motion asleep = actor;
    for (std::size_t f = 0; f < asleep.frames; ++f) {
        for (std::size_t j = 0; j < joints; ++j) asleep.rotations[f * joints + j] = kIdentity;
        asleep.rotations[f * joints] = turnDegrees(-90, {1, 0, 0});
        asleep.rootPositions[f] = {0.0, 0.1 * rig.joints[0].centre.y, 0.0};
    }
    RestSkeleton broad = rig; // another body
    for (RestJoint& joint : broad.joints) joint.centre.x *= 1.3;
    RetargetReport report;
    const Clip clip = retarget(asleep, broad, {}, &report);
    EXPECT_LT(compare(clip, broad, asleep).limbs, 1.0);
    EXPECT_TRUE(saysOf(report, "he lies, or the zero pose does"));
}

/// An actor who never straightens the legs does not show whether a zero pose along z lies down.
TEST_F(StandingPose, WarnsWithoutStandingSample) {
    Motion crouches = actor;
    for (std::size_t f = 0; f < crouches.frames; ++f)
        for (std::size_t j = 0; j < joints; ++j) {
            const std::string& name = rig.joints[j].name;
            const double bend = name == "LeftUpLeg" || name == "RightUpLeg" ? -60.0
                                : name == "LeftLeg" || name == "RightLeg"   ? 100.0
                                                                            : 0.0;
            crouches.rotations[f * joints + j] = turnDegrees(bend, {1, 0, 0});
        }
    RestSkeleton broad = rig; // another body
    for (RestJoint& joint : broad.joints) joint.centre.x *= 1.3;
    const std::vector<glm::dquat> lying(joints, turnDegrees(90, {1, 0, 0}));
    for (const bool lies : {false, true}) {
        RetargetReport report;
        retarget(lies ? rebasedFrom(crouches, lying) : crouches, broad, {}, &report);
        EXPECT_EQ(saysOf(report, "he lies, or the zero pose does"), lies) << report.text();
    }
}

/// A motion without a character rests in the actor's first sample. glTF defines which axis is up;
/// in other formats the floor shows it, on which he lies.
TEST_F(StandingPose, GettingUpFollowsTheUpAxis) {
    Motion getsUp = actor;
    for (std::size_t f = 0; f < getsUp.frames; ++f) {
        const double share = std::clamp(2.0 * double(f) / double(getsUp.frames) - 0.5, 0.0, 1.0);
        for (std::size_t j = 0; j < joints; ++j) getsUp.rotations[f * joints + j] = kIdentity;
        getsUp.rotations[f * joints] = turnDegrees(90 * (share - 1), {1, 0, 0});
        getsUp.rootPositions[f] = {0.0, (0.1 + 0.9 * share) * rig.joints[0].centre.y, 0.0};
    }
    RestSkeleton broad = rig; // another body
    for (RestJoint& joint : broad.joints) joint.centre.x *= 1.3;
    const std::vector<glm::dquat> lying(joints, turnDegrees(-90, {1, 0, 0}));
    Motion motion = rebasedFrom(getsUp, lying);
    for (const bool isStated : {false, true})
        for (const RestSkeleton& body : {broad, rig}) {
            motion.yIsUp = isStated;
            const Difference difference = compare(retarget(motion, body), body, getsUp);
            EXPECT_LT(difference.limbs, 1.0);
            EXPECT_LT(difference.heads, 2.0) << "upright is by the legs";
        }
}

/// The rig's own skeleton in a space where z is up: the zero pose along y lies there.
TEST_F(StandingPose, KeepsLyingActorWhereTheCallerSaysWhichAxisIsUp) {
    Motion asleep = actor;
    for (std::size_t f = 0; f < asleep.frames; ++f) {
        for (std::size_t j = 0; j < joints; ++j) asleep.rotations[f * joints + j] = kIdentity;
        asleep.rootPositions[f] = {0.0, 0.0, 0.1 * rig.joints[0].centre.y};
    }
    Motion expected = asleep; // in the rig's space
    for (std::size_t f = 0; f < asleep.frames; ++f) {
        expected.rotations[f * joints] = turnDegrees(-90, {1, 0, 0});
        expected.rootPositions[f] = {0.0, 0.1 * rig.joints[0].centre.y, 0.0};
    }
    RetargetOptions options;
    options.up = RetargetOptions::Up::Z;
    EXPECT_LT(compare(retarget(asleep, rig, options), rig, expected).limbs, 1.0);
}

/// A file with curves for few joints has no others: hands and head are missing, and it rests in its
/// first sample.
TEST_F(StandingPose, CopiesRotationsOfFewJointsToTheSameSkeleton) {
    Motion few = actor;
    for (std::size_t f = 0; f < few.frames; ++f) {
        for (std::size_t j = 0; j < joints; ++j) few.rotations[f * joints + j] = kIdentity;
        few.rotations[f * joints] = turnDegrees(-90, {1, 0, 0});
        few.rootPositions[f] = {0.0, 0.1 * rig.joints[0].centre.y, 0.0};
    }
    const Motion whole = few;
    const std::vector<glm::dquat> lying(joints, turnDegrees(-90, {1, 0, 0}));
    few = rebasedFrom(few, lying, true);
    std::vector<std::size_t> kept;
    for (std::size_t j = 0; j < joints; ++j) {
        const std::string& name = few.skeleton.joints[j].name;
        if (name.find("Hand") == std::string::npos && name.find("Head") == std::string::npos &&
            name.find("Neck") == std::string::npos && name.find("Finger") == std::string::npos &&
            name.find("Thumb") == std::string::npos)
            kept.push_back(j);
    }
    Motion result = few;
    result.skeleton.joints.clear();
    result.rotations.clear();
    std::vector<int> index(joints, -1);
    for (const std::size_t j : kept) {
        index[j] = int(result.skeleton.joints.size());
        RestJoint joint = few.skeleton.joints[j];
        if (joint.parent >= 0) joint.parent = index[std::size_t(joint.parent)];
        result.skeleton.joints.push_back(joint);
    }
    for (std::size_t f = 0; f < few.frames; ++f)
        for (const std::size_t j : kept) result.rotations.push_back(few.rotation(f, j));
    RetargetOptions options;
    options.up = RetargetOptions::Up::Y;
    EXPECT_LT(compare(retarget(result, rig, options), rig, whole).heads, 2.0);
}

/// A jaw opens, and a sword beside the hips is drawn.
TEST_F(StandingPose, JointsOfTheSameSkeletonMoveAgainstTheirParents) {
    Motion draws = actor;
    const auto hand = std::size_t(rig.find("RightHand"));
    const auto parent = std::size_t(rig.joints[hand].parent);
    const glm::dvec3 rest = rig.joints[hand].centre - rig.joints[parent].centre;
    for (std::size_t f = 0; f < draws.frames; ++f)
        draws.moves[hand].push_back(rest * (1.0 + double(f) / double(draws.frames)));
    RetargetReport report;
    const Clip clip = retarget(draws, rig, {}, &report);
    ASSERT_EQ(clip.moves.size(), 1u);
    for (const std::size_t f : {std::size_t(0), draws.frames / 2, draws.frames - 1})
        EXPECT_LT(glm::distance(clip.moves.at(hand)[f], draws.moves.at(hand)[f]),
                  1e-6 * glm::length(rest));
    RestSkeleton broad = rig; // another body
    for (RestJoint& joint : broad.joints) joint.centre.x *= 1.3;
    EXPECT_TRUE(retarget(draws, broad, {}, &report).moves.empty());
    EXPECT_TRUE(saysOf(report, "joint \"RightHand\" is translated; only translations of the root"))
        << report.text().substr(0, 600);
}

/// As a model's own clips do.
TEST_F(StandingPose, KeepsHeightsOfOwnMotion) {
    Motion own = actor;
    own.skeleton = rig;
    own.rootPositions = retarget(actor, rig).rootPositions; // on the rig's floor
    const std::vector<glm::dvec3> onFloor = own.rootPositions;
    const double height =
        rig.joints[0].centre.y - rig.joints[std::size_t(rig.find("LeftFoot"))].centre.y;
    for (glm::dvec3& position : own.rootPositions) position.y -= 0.1 * height;
    RetargetReport report;
    const Clip sunk = retarget(own, rig, {}, &report);
    EXPECT_FALSE(saysOf(report, "another floor"));
    for (std::size_t f = 0; f < sunk.frames; ++f)
        ASSERT_LT(glm::distance(sunk.rootPositions[f], own.rootPositions[f]), 1e-6 * height) << f;

    for (glm::dvec3& position : own.rootPositions) position.y -= 0.5 * height; // another floor
    EXPECT_NEAR(retarget(own, rig, {}, &report).rootPositions[0].y, onFloor[0].y, 1e-6 * height);
    EXPECT_TRUE(saysOf(report, "another floor than the body's: it is raised by ")) << report.text();

    own.yIsUp = true; // lies in the air, as in a flip
    const glm::dquat back = glm::angleAxis(glm::radians(-90.0), glm::dvec3(1, 0, 0));
    for (std::size_t f = 0; f < own.frames; ++f) {
        own.rootPositions[f] = onFloor[f] + glm::dvec3(0, height, 0);
        own.rotations[f * rig.joints.size()] = back * own.rotations[f * rig.joints.size()];
    }
    EXPECT_NEAR(retarget(own, rig).rootPositions[0].y, onFloor[0].y + height, 1e-6 * height);
}

/// Files may have no curves for joints that a clip does not move.
TEST_F(StandingPose, KeepsHeightsOfOwnMotionWithoutFeet) {
    Motion own;
    own.frameTime = actor.frameTime;
    own.frames = actor.frames;
    own.rootPositions = retarget(actor, rig).rootPositions; // on the rig's floor
    std::vector<int> indexOf;
    for (const RestJoint& joint : rig.joints) {
        const bool isKept = joint.name.find("Foot") == std::string::npos &&
                            joint.name.find("Toe") == std::string::npos;
        indexOf.push_back(isKept ? static_cast<int>(own.skeleton.joints.size()) : -1);
        if (!isKept) continue;
        own.skeleton.joints.push_back(joint);
        if (joint.parent >= 0)
            own.skeleton.joints.back().parent = indexOf[std::size_t(joint.parent)];
    }
    for (std::size_t f = 0; f < own.frames; ++f)
        for (std::size_t j = 0; j < joints; ++j)
            if (indexOf[j] >= 0) own.rotations.push_back(actor.rotations[f * joints + j]);
    const Clip clip = retarget(own, rig);
    for (std::size_t f = 0; f < clip.frames; ++f)
        ASSERT_LT(glm::distance(clip.rootPositions[f], own.rootPositions[f]), 1e-6) << f;
}

/// Authors name sides from their own view.
TEST_F(StandingPose, WarnsAboutBackwardFeet) {
    RestSkeleton swapped = rig;
    for (RestJoint& joint : swapped.joints) {
        joint.centre.x *= 1.3; // not the actor's own
        const bool left = joint.name.rfind("Left", 0) == 0;
        if (left)
            joint.name.replace(0, 4, "Right");
        else if (joint.name.rfind("Right", 0) == 0)
            joint.name.replace(0, 5, "Left");
        else if (joint.name == "LHipJoint")
            joint.name = "RHipJoint";
        else if (joint.name == "RHipJoint")
            joint.name = "LHipJoint";
    }
    RestSkeleton broad = rig;
    for (RestJoint& joint : broad.joints) joint.centre.x *= 1.3;
    RetargetReport wrong, right;
    retarget(actor, swapped, {}, &wrong);
    retarget(actor, broad, {}, &right);
    EXPECT_TRUE(saysOf(wrong, "feet point backwards")) << wrong.text().substr(0, 500);
    EXPECT_FALSE(saysOf(right, "feet point backwards"));
}

TEST_F(StandingPose, DistantRootStartsAtTheOrigin) {
    Motion far = actor;
    const glm::dvec3 there(1e3, 0.0, -2e3);
    for (glm::dvec3& position : far.rootPositions) position += there;
    RetargetReport report;
    const Clip clip = retarget(far, rig, {}, &report);
    EXPECT_TRUE(saysOf(report, "starts at the origin"));
    const Placed placed = place(clip, rig, 0);
    EXPECT_NEAR(placed.places[0].x, rig.joints[0].centre.x, 1e-6);
    EXPECT_NEAR(placed.places[0].z, rig.joints[0].centre.z, 1e-6);
    EXPECT_LT(compare(clip, rig, actor).limbs, 1.0);
    const std::size_t last = clip.frames - 1; // a prop moves with the actor
    EXPECT_LT(
        glm::distance(clip.rootPositions[last],
                      report.scale * (report.rotation * far.rootPositions[last]) + report.offset),
        1e-6);

    RetargetReport near;
    far = actor;
    for (glm::dvec3& position : far.rootPositions) position.x += 2.0 * rig.joints[0].centre.y;
    const Clip moved = retarget(far, rig, {}, &near);
    EXPECT_FALSE(saysOf(near, "starts at the origin"));
    EXPECT_GT(moved.rootPositions[0].x, 1.9 * rig.joints[0].centre.y);
}

/// A rig that lies while the actor stands is not a dance.
TEST_F(StandingPose, RejectsHipsOnTheFloor) {
    RetargetOptions options;
    for (const std::string side : {"Left", "Right"}) {
        options.joints[side + "UpLeg"] = side + "Arm";
        options.joints[side + "Leg"] = side + "ForeArm";
        options.joints[side + "Foot"] = side + "Hand";
    }
    Motion cross = actor; // arms out to the sides
    for (std::size_t f = 0; f < cross.frames; ++f)
        for (std::size_t j = 1; j < joints; ++j) cross.rotations[f * joints + j] = kIdentity;
    for (const std::string side : {"Left", "Right"}) {
        const RestSkeleton& body = actor.skeleton;
        const auto at = [&](const char* joint) { return std::size_t(body.find(side + joint)); };
        const glm::dvec3 bone =
            glm::normalize(body.joints[at("Hand")].centre - body.joints[at("Arm")].centre);
        const glm::dquat up(bone, glm::dvec3(side == "Left" ? 1 : -1, 0, 0));
        for (std::size_t f = 0; f < cross.frames; ++f) {
            cross.rotations[f * joints] = kIdentity;
            cross.rotations[f * joints + at("Arm")] = up;
        }
    }
    expectError([&] { retarget(cross, rig, options); }, "hips are as low as its feet");
}
