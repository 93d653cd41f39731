// SPDX-License-Identifier: GPL-3.0-or-later
#include "Ratios.h"
#include "Shapes.h"

#include <osgSkin/Error>
#include <osgSkinBind/Bind>
#include <osgSkinBind/RigidSplit>

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

using namespace osgSkin;

namespace {

std::vector<std::string> rigidOf(const std::vector<std::string>& chain) {
    RestSkeleton skeleton;
    for (std::size_t j = 0; j < chain.size(); ++j)
        skeleton.joints.push_back({chain[j], static_cast<int>(j) - 1, {0, double(j), 0}, {}});
    return automaticRigidJoints(skeleton);
}

using Names = std::vector<std::string>;

RestSkeleton limb() {
    RestSkeleton skeleton = shapes::chainAlongY({1.1, 5.1, 9.1, 10.6}, 11.8);
    const char* names[] = {"Arm", "ForeArm", "Hand", "Finger"};
    for (std::size_t j = 0; j < 4; ++j) skeleton.joints[j].name = names[j];
    return skeleton;
}

BindOptions withRigidHand() {
    BindOptions options;
    options.rigid = Names{"Hand"};
    return options;
}

/// A forearm along y with a hand of two fingers, each one bone with a tip.
RestSkeleton handSkeleton() {
    RestSkeleton skeleton;
    shapes::addJoint(skeleton, "LeftArm", "", {0, 0, 0});
    shapes::addJoint(skeleton, "LeftForeArm", "LeftArm", {0, 4, 0});
    shapes::addJoint(skeleton, "LeftHand", "LeftForeArm", {0, 8, 0});
    shapes::addJoint(skeleton, "LeftHandIndex1", "LeftHand", {0, 9, 0});
    skeleton.joints.back().tip = glm::dvec3(0, 11, 0);
    return skeleton;
}

} // namespace

TEST(RigidNames, AreRecognised) {
    for (const char* name :
         {"Head", "head", "LeftHand", "mixamorig:LeftHand", "hand_l", "foot_r", "lHand", "RFoot",
          "wrist.L", "Bip01 L Hand", "LeftAnkle", "righthand", "DEF-hand.L", "rig|Head"})
        EXPECT_EQ(rigidOf({"Hips", name}), Names{name}) << name;
}

TEST(RigidNames, OtherNamesAreNotRecognised) {
    for (const char* name :
         {"LeftHandIndex1", "HandThumb", "LeftForeArm", "HeadTop_End", "Forehead", "LeftToeBase",
          "Neck1", "handle", "hand_ik_l", "LeftFootToe", ""})
        EXPECT_EQ(rigidOf({"Hips", name}), Names{}) << name;
}

TEST(RigidNames, OnlyTheTopmostJointIsRigid) {
    EXPECT_EQ(rigidOf({"Hips", "LeftWrist", "LeftHand", "Finger"}), Names{"LeftWrist"});
    EXPECT_EQ(rigidOf({"Head", "Jaw"}), Names{}) << "the root cannot be a rigid part";
}

TEST(RigidNames, HandIsRigidUnlessAClipMovesItsFingers) {
    const RestSkeleton skeleton = handSkeleton();
    EXPECT_TRUE(automaticRigidJoints(skeleton).empty());
    std::vector<bool> isMoved(skeleton.joints.size(), false);
    isMoved[1] = isMoved[2] = true;
    EXPECT_EQ(automaticRigidJoints(skeleton, {}, isMoved), std::vector<std::string>{"LeftHand"});
    isMoved[3] = true;
    EXPECT_TRUE(automaticRigidJoints(skeleton, {}, isMoved).empty());
}

TEST(RigidPart, StartsOneRadiusBehindTheJoint) {
    const SkinMesh mesh = shapes::cylinder(12.0);
    const Binding binding = bind(mesh, limb(), withRigidHand());
    expectSound(binding);
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
        EXPECT_EQ(ratiosOf(binding, v, 3).bend, 0.0f) << "a joint below the rigid one moves skin";
        EXPECT_NE(binding.regions[v], 3u);
        if (mesh.positions[v].y > 10.4) {
            EXPECT_EQ(ratiosOf(binding, v, 2).bend, 1.0f) << mesh.positions[v].y;
            EXPECT_EQ(ratiosOf(binding, v, 2).twist, 1.0f) << mesh.positions[v].y;
        }
    }
}

TEST(RigidPart, EmptyListLeavesEveryJointItsRegion) {
    BindOptions options;
    options.rigid.emplace();
    BindReport report;
    const Binding binding = bind(shapes::cylinder(12.0), limb(), options, &report);
    expectSound(binding);
    EXPECT_EQ(report.regions.size(), 4u);
    float most = 0.0f;
    for (std::size_t v = 0; v < binding.vertexCount(); ++v)
        most = std::max(most, ratiosOf(binding, v, 3).bend);
    EXPECT_GT(most, 0.9f);
}

TEST(RigidSplit, TakesFacesThatMoveRigidly) {
    const SkinMesh mesh = shapes::cylinder(12.0);
    const Binding binding = bind(mesh, limb(), withRigidHand());
    const RigidSplit split = splitRigid(mesh, binding, {"Hand"});
    ASSERT_EQ(split.faceJoint.size(), mesh.faceSizes.size());
    std::size_t corner = 0, rigid = 0;
    for (std::size_t f = 0; f < mesh.faceSizes.size(); ++f) {
        bool alike = true;
        for (std::uint32_t k = 0; k < mesh.faceSizes[f]; ++k, ++corner)
            for (std::size_t j = 0; j < 4; ++j) {
                const Influence i = ratiosOf(binding, mesh.faceVertices[corner], j);
                const float expected = j < 3 ? 1.0f : 0.0f;
                alike = alike && i.bend == expected && i.twist == expected;
            }
        EXPECT_EQ(split.faceJoint[f], alike ? 2u : RigidSplit::kSkin) << "face " << f;
        if (alike) ++rigid;
    }
    EXPECT_GE(rigid, 6u * 16u);
    EXPECT_LT(rigid, 12u * 16u);
}

TEST(RigidSplit, EmptyListLeavesAllFacesToTheSkin) {
    const SkinMesh mesh = shapes::cylinder(12.0);
    for (const std::uint32_t joint :
         splitRigid(mesh, bind(mesh, limb(), withRigidHand()), {}).faceJoint)
        EXPECT_EQ(joint, RigidSplit::kSkin);
}

TEST(RigidSplit, RejectsMismatchedInput) {
    const SkinMesh mesh = shapes::cylinder(12.0);
    const Binding binding = bind(mesh, limb(), withRigidHand());
    EXPECT_THROW(splitRigid(mesh, binding, {"Foot"}), Error);
    EXPECT_THROW(splitRigid(shapes::cylinder(2.0), binding, {"Hand"}), Error);
    Binding empty = binding;
    std::fill(empty.firstInfluence.begin(), empty.firstInfluence.end(), 0u);
    EXPECT_THROW(splitRigid(mesh, empty, {"Hand"}), Error);
    SkinMesh broken = mesh;
    broken.faceVertices.back() = 1000000;
    EXPECT_THROW(splitRigid(broken, binding, {"Hand"}), Error);
}
