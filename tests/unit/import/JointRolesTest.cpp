// SPDX-License-Identifier: MIT
// Joint roles from names, and motions for a body with any joint names.
#include "Figure.h"
#include "RenamedBody.h"

#include <osgSkin/Error>
#include <osgSkinImport/ImportMotion>
#include <osgSkinImport/ImportSkeleton>
#include <osgSkinRig/FindJoint>
#include <osgSkinRig/JointRoles>
#include <osgSkinRig/Retarget>
#include <osgSkinRig/RetargetReport>

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

using namespace osgSkin;

namespace {

/// The role of a single name, without a family.
JointPart partOf(const std::string& name, const std::string& child = {}) {
    RestSkeleton skeleton{{{"root", -1, {}, {}}, {name, 0, {}, {}}}};
    if (!child.empty()) skeleton.joints.push_back({child, 1, {}, {}});
    const JointRoles roles = recogniseJoints(skeleton);
    EXPECT_FALSE(roles.known());
    EXPECT_EQ(roles.roles[1], "");
    return roles.parts[1];
}

TEST(JointRoles, EmptySkeletonHasNoRoles) {
    const JointRoles roles = recogniseJoints({});
    EXPECT_FALSE(roles.known());
    EXPECT_TRUE(roles.parts.empty());
}

/// A name wins over a role, and a name that is neither is refused with the likely one.
TEST(JointRoles, FindsJointsByNameOrRole) {
    const RestSkeleton skeleton{{{"Bip01Pelvis", -1, {}, {}},
                                 {"Bip01Spine", 0, {}, {}},
                                 {"Bip01Neck", 1, {}, {}},
                                 {"Bip01Head", 2, {}, {}},
                                 {"Spine", 3, {}, {}}}};
    JointRoles roles;
    roles.joints["Spine"] = {1};
    roles.joints["Head"] = {3};
    EXPECT_EQ(findJoint(skeleton, "Spine", roles), 4u);
    EXPECT_EQ(findJoint(skeleton, "Head", roles), 3u);
    EXPECT_EQ(findJoint(skeleton, "Bip01Neck"), 2u);
    try {
        findJoint(skeleton, "Haed", roles);
        ADD_FAILURE();
    } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()).find("did you mean \"Head\""), std::string::npos)
            << error.what();
    }
}

TEST(JointRoles, RecognisesWordsWithoutFamily) {
    const struct {
        const char* name;
        JointPart part;
    } cases[] = {{"rig|Head", JointPart::Head},      {"Forehead", JointPart::Other},
                 {"HeadTop_End", JointPart::Other},  {"DEF-hand.L", JointPart::Hand},
                 {"righthand", JointPart::Hand},     {"Bip01 L Hand", JointPart::Hand},
                 {"wrist.L", JointPart::Hand},       {"Hand1", JointPart::Other},
                 {"handle", JointPart::Other},       {"hand_ik_l", JointPart::Other},
                 {"ankle_r", JointPart::Foot},       {"LeftHandThumb2", JointPart::Thumb},
                 {"lMid1", JointPart::MiddleFinger}, {"clavicle.R", JointPart::Collar},
                 {"LHipJoint", JointPart::HipJoint}, {"rButtock", JointPart::HipJoint},
                 {"shoulder", JointPart::UpperArm},  {"", JointPart::Other}};
    for (const auto& c : cases) EXPECT_EQ(partOf(c.name), c.part) << c.name;
    EXPECT_EQ(partOf("shoulder_l", "arm_l"), JointPart::Collar);
    EXPECT_EQ(partOf("shoulder_l", "forearm_l"), JointPart::UpperArm);
}

TEST(JointRoles, FamilyOverridesWords) {
    JointNames family{"odd", {}};
    family.roles = {{"Hips", {"base"}},
                    {"LeftHand", {"foot"}}, // possibly a chimpanzee
                    {"LeftUpperArm", {"wrist"}},
                    {"Head", {"servo1"}}};
    const RestSkeleton skeleton{{{"base", -1, {}, {}},
                                 {"wrist", 0, {}, {}},
                                 {"foot", 1, {}, {}},
                                 {"servo1", 0, {}, {}},
                                 {"hand", 0, {}, {}}}};
    const JointRoles roles = recogniseJoints(skeleton, {family});
    EXPECT_EQ(roles.family, "odd");
    EXPECT_EQ(roles.roles[2], "LeftHand");
    EXPECT_EQ(roles.joints.at("Head"), std::vector<int>{3});
    EXPECT_EQ(roles.parts,
              (std::vector<JointPart>{JointPart::Other, JointPart::UpperArm, JointPart::Hand,
                                      JointPart::Head, JointPart::Hand}));
}

/// As in VRM files, whose nodes may have any names.
TEST(JointRoles, FileOverridesNames) {
    RestSkeleton body = importSkeleton(OSGSKIN_DATA "/thrower.bvh");
    const JointRoles named = recogniseJoints(body);
    for (std::size_t j = 0; j < body.joints.size(); ++j) body.joints[j].role = named.roles[j];
    std::vector<std::string> names;
    for (const RestJoint& joint : body.joints) names.push_back(joint.name);
    std::rotate(names.begin(), names.begin() + 5, names.end());
    for (std::size_t j = 0; j < names.size(); ++j) body.joints[j].name = names[j];
    const JointRoles roles = recogniseJoints(body);
    EXPECT_EQ(roles.family, kStatedByFile);
    for (std::size_t j = 0; j < names.size(); ++j)
        if (!named.roles[j].empty()) {
            EXPECT_EQ(roles.roles[j], named.roles[j]);
        }
}

/// Two characters merged into one file.
TEST(JointRoles, OfSeveralFiguresTheFirstHasRoles) {
    const RestSkeleton figure = importSkeleton(OSGSKIN_DATA "/thrower.bvh");
    RestSkeleton scene;
    scene.add("scene", -1, glm::dvec3(0.0));
    std::vector<int> tops;
    for (const std::string counter : {"", ".001"}) {
        const int first = static_cast<int>(scene.joints.size());
        tops.push_back(first);
        for (const osgSkin::RestJoint& joint : figure.joints) {
            scene.joints.push_back(joint);
            scene.joints.back().name += counter;
            scene.joints.back().parent = joint.parent < 0 ? 0 : first + joint.parent;
        }
    }
    const JointRoles alone = recogniseJoints(figure), roles = recogniseJoints(scene);
    for (std::size_t j = 0; j < figure.joints.size(); ++j) {
        EXPECT_EQ(roles.roles[std::size_t(tops[0]) + j], alone.roles[j]) << figure.joints[j].name;
        EXPECT_EQ(roles.roles[std::size_t(tops[1]) + j], "") << figure.joints[j].name;
    }
    RetargetReport report;
    retarget(importMotion(OSGSKIN_DATA "/throw.bvh"), scene, {}, &report);
    EXPECT_NE(report.text().find("the rig has 2 figures; the motion moves the first, and not that "
                                 "of joint \"" +
                                 scene.joints[std::size_t(tops[1])].name),
              std::string::npos)
        << report.text().substr(0, 600);
}

TEST(JointRoles, FamilyNeedsFourRoles) {
    JointNames family{"few", {}};
    family.roles = {{"Hips", {"base"}}, {"LeftHand", {"servo1"}}, {"RightHand", {"servo2"}}};
    const RestSkeleton skeleton{
        {{"base", -1, {}, {}}, {"servo1", 0, {}, {}}, {"servo2", 0, {}, {}}}};
    EXPECT_FALSE(recogniseJoints(skeleton, {family}).known());
}

/// The thrower without CMU's special joints: a second joint in the neck, and one for the fingers.
RestSkeleton plainThrower() {
    RestSkeleton body = osgSkin::importSkeleton(OSGSKIN_DATA "/thrower.bvh");
    for (const char* joint : {"Neck1", "LHipJoint", "RHipJoint", "LeftFingerBase",
                              "RightFingerBase", "LeftHandIndex1", "RightHandIndex1"})
        body = test::without(body, joint);
    return body;
}

/// Expects the clip of the body with CMU's names; `options` give the names.
void expectAlike(const JointNames& family, const RetargetOptions& options) {
    const RestSkeleton body = plainThrower();
    const Motion motion = osgSkin::importMotion(OSGSKIN_DATA "/throw.bvh");
    const RestSkeleton other = test::renamed(body, test::namesIn(body, family));
    RetargetReport ours, theirs;
    const Clip expected = osgSkin::retarget(motion, body, {}, &ours);
    const Clip clip = osgSkin::retarget(motion, other, options, &theirs);
    EXPECT_EQ(theirs.rigNames, family.name);
    for (std::size_t j = 0; j < body.joints.size(); ++j)
        EXPECT_EQ(theirs.entries[j].motionJoint, ours.entries[j].motionJoint)
            << theirs.entries[j].rigJoint;
    EXPECT_EQ(clip.rotations, expected.rotations);
    EXPECT_EQ(clip.rootPositions, expected.rootPositions);
}

/// MakeHuman's "pelvis.L" leads from the root to the thigh: a hip, however far from the middle.
TEST(JointRoles, HipsOfEveryFamilyAreNotAligned) {
    RestSkeleton body = osgSkin::importSkeleton(OSGSKIN_DATA "/thrower.bvh");
    body = test::renamed(body, test::namesIn(body, test::knownNames("MakeHuman")));
    for (const char* name : {"pelvis.L", "pelvis.R"}) {
        osgSkin::RestJoint& hip = body.joints.at(std::size_t(body.find(name)));
        hip.centre += glm::dvec3(0.0, 0.03, 0.05);
    }
    RetargetReport report;
    osgSkin::retarget(osgSkin::importMotion(OSGSKIN_DATA "/throw.bvh"), body, {}, &report);
    EXPECT_EQ(report.rigNames, "MakeHuman");
    std::size_t hips = 0;
    for (const RetargetReport::Entry& entry : report.entries)
        if (entry.rigJoint.rfind("pelvis.", 0) == 0) {
            ++hips;
            EXPECT_FALSE(entry.motionJoint.empty());
            EXPECT_EQ(entry.alignmentDegrees, 0.0) << entry.rigJoint;
        }
    EXPECT_EQ(hips, 2u);
}

TEST(JointRoles, RokokoBodyMovesAlike) {
    expectAlike(test::knownNames("Rokoko"), {});
}

/// Some authors name left and right as they see them from the front.
TEST(JointRoles, ToesDistinguishLeftAndRight) {
    JointNames seen = test::knownNames("Rokoko");
    for (auto& [role, names] : seen.roles)
        if (role.rfind("Left", 0) == 0) std::swap(names, seen.roles.at("Right" + role.substr(4)));
    expectAlike(seen, {});
}

/// Skeletons that name joints alike mean the same sides, though the toes of one point backwards.
TEST(JointRoles, EqualNamesShareASide) {
    const Motion motion = osgSkin::importMotion(OSGSKIN_DATA "/throw.bvh");
    RestSkeleton body = motion.skeleton;
    const auto place = [&](const char* name) -> glm::dvec3& {
        return body.joints.at(std::size_t(body.find(name))).centre;
    };
    for (const auto& [foot, toe] :
         {std::pair("LeftFoot", "LeftToeBase"), std::pair("RightFoot", "RightToeBase")})
        place(toe).z = 2.0 * place(foot).z - place(toe).z;
    RetargetReport report;
    osgSkin::retarget(motion, body, {}, &report);
    for (const RetargetReport::Entry& entry : report.entries)
        EXPECT_EQ(entry.motionJoint, entry.rigJoint);
}

/// Assimp's exporters write the pivots of an FBX joint as joints.
TEST(JointRoles, IgnoresPivots) {
    const std::string pivot = "_$AssimpFbx$_Rotation";
    RestSkeleton skeleton;
    int above = -1;
    double height = 0.0;
    const auto add = [&](const std::string& name, int parent, double x) {
        for (const std::string& one : {"mixamorig:" + name + pivot, "mixamorig:" + name}) {
            skeleton.joints.push_back({one, parent, {x, height, 0}, {}});
            parent = static_cast<int>(skeleton.joints.size()) - 1;
        }
        return parent;
    };
    for (const char* name : {"Hips", "Spine", "Spine1", "Neck", "Head"}) {
        above = add(name, above, 0.0);
        height += 0.2;
    }
    for (const std::string side : {"Left", "Right"}) {
        const double x = side == "Left" ? 0.2 : -0.2;
        height = 0.5;
        const int spine = skeleton.find("mixamorig:Spine1");
        add(side + "Hand", add(side + "ForeArm", add(side + "Arm", spine, x), 2 * x), 3 * x);
        height = -0.5;
        const int hips = skeleton.find("mixamorig:Hips");
        add(side + "Foot", add(side + "Leg", add(side + "UpLeg", hips, x), x), x);
    }
    const JointRoles roles = recogniseJoints(skeleton);
    EXPECT_TRUE(roles.known());
    for (std::size_t j = 0; j < skeleton.joints.size(); ++j) {
        const std::string& name = skeleton.joints[j].name;
        EXPECT_EQ(roles.roles[j].empty(), name.find(pivot) != std::string::npos) << name;
    }
}

TEST(JointRoles, VrmBodyMovesAlike) {
    expectAlike(test::knownNames("VRM"), {});
}

TEST(JointRoles, CustomNamesMoveAlike) {
    RetargetOptions options;
    options.names.push_back(test::robotNames());
    expectAlike(options.names.front(), options);
}

} // namespace
