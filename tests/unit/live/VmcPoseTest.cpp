// SPDX-License-Identifier: MIT
// Bones as programs for motion capture send them, in Unity's space.
#include <osgSkinRig/JointRoles>
#include <osgSkinRig/LiveRetarget>
#include <osgSkinRig/VmcPose>

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

namespace {

using osgSkin::JointSample;
using osgSkin::RestSkeleton;
using osgSkin::VmcPose;

struct Bone {
    const char* name;
    osg::Vec3d position; ///< from the bone above, Unity's space: left is -x, forward +z
};

constexpr double kHips = 0.9;

const std::vector<Bone> kBones = {
    {"Hips", {0, kHips, 0}},
    {"Spine", {0, 0.1, 0}},
    {"Chest", {0, 0.15, 0}},
    {"Neck", {0, 0.25, 0}},
    {"Head", {0, 0.1, 0}},
    {"LeftUpperLeg", {-0.1, -0.05, 0}},
    {"LeftLowerLeg", {0, -0.4, 0}},
    {"LeftFoot", {0, -0.4, 0}},
    {"LeftToes", {0, -0.05, 0.15}},
    {"RightUpperLeg", {0.1, -0.05, 0}},
    {"RightLowerLeg", {0, -0.4, 0}},
    {"RightFoot", {0, -0.4, 0}},
    {"RightToes", {0, -0.05, 0.15}},
    {"LeftUpperArm", {-0.18, 0.2, 0}},
    {"LeftLowerArm", {-0.28, 0, 0}},
    {"LeftHand", {-0.25, 0, 0}},
    {"RightUpperArm", {0.18, 0.2, 0}},
    {"RightLowerArm", {0.28, 0, 0}},
    {"RightHand", {0.25, 0, 0}},
};

bool setBone(VmcPose& pose, const std::string& name, const osg::Vec3d& position,
             const osg::Quat& rotation) {
    return pose.take("/VMC/Ext/Bone/Pos", name, position, rotation);
}

bool setRoot(VmcPose& pose, const osg::Vec3d& position, const osg::Quat& rotation) {
    return pose.take("/VMC/Ext/Root/Pos", "root", position, rotation);
}

VmcPose standing() {
    VmcPose pose;
    for (const Bone& bone : kBones)
        EXPECT_TRUE(setBone(pose, bone.name, bone.position, osg::Quat())) << bone.name;
    return pose;
}

osg::Quat turn(double degrees, const osg::Vec3d& axis) {
    return osg::Quat(glm::radians(degrees), axis);
}

std::vector<glm::dvec3> positions(const VmcPose& pose) {
    std::vector<glm::dquat> world;
    std::vector<glm::dvec3> result;
    const RestSkeleton rest = pose.skeleton();
    osgSkin::worldRotations(rest, pose.rotations().data(), world);
    osgSkin::worldPositions(rest, world, pose.root(), result);
    return result;
}

glm::dvec3 positionOf(const VmcPose& pose, const std::string& bone) {
    return positions(pose)[std::size_t(pose.skeleton().find(bone))];
}

void expectNear(const glm::dvec3& a, const glm::dvec3& b) {
    EXPECT_LT(glm::distance(a, b), 1e-9) << a.x << " " << a.y << " " << a.z;
}

} // namespace

TEST(VmcPose, IsABodyOnceItsBonesHaveCome) {
    VmcPose pose;
    for (const Bone& bone : kBones) {
        EXPECT_FALSE(pose.hasBody()) << "before " << bone.name;
        setBone(pose, bone.name, bone.position, osg::Quat());
    }
    EXPECT_TRUE(pose.hasBody());
    setBone(pose, "LeftLowerArm", {0, 0, 0}, osg::Quat());
    EXPECT_FALSE(pose.hasBody()) << "an arm without length";
}

TEST(VmcPose, StandsOnTheFloorWithItsLeftAtPlusX) {
    const RestSkeleton rest = standing().skeleton();
    EXPECT_NO_THROW(rest.validate());
    const auto at = [&](const char* bone) {
        return rest.joints[std::size_t(rest.find(bone))].centre;
    };
    expectNear(at("LeftToes"), {0.1, 0.0, 0.15});
    expectNear(at("Hips"), {0.0, 0.9, 0.0});
    expectNear(at("LeftHand"), {0.71, 1.35, 0.0});
    const osgSkin::JointRoles roles = osgSkin::recogniseJoints(rest);
    EXPECT_EQ(roles.family, "Unity humanoid");
    for (const char* role : {"LeftUpperArm", "RightFoot", "LeftIndex2", "Head"})
        EXPECT_GE(roles.joint(role), 0) << role;
}

TEST(VmcPose, TurnsAsInUnity) {
    VmcPose pose = standing();
    // In Unity, the left arm at -x is raised by a negative angle about z, and forward is +z.
    setBone(pose, "LeftUpperArm", kBones[13].position, turn(-90.0, osg::Z_AXIS));
    expectNear(positionOf(pose, "LeftHand"), {0.18, 1.35 + 0.53, 0.0});
    setBone(pose, "LeftUpperArm", kBones[13].position, turn(90.0, osg::Y_AXIS)); // to the front
    expectNear(positionOf(pose, "LeftHand"), {0.18, 1.35, 0.53});
}

TEST(VmcPose, MovesWithItsRoot) {
    VmcPose pose = standing();
    EXPECT_TRUE(setBone(pose, "Hips", {0.2, kHips, 0}, osg::Quat()));
    EXPECT_TRUE(setRoot(pose, {1, 0, 2}, turn(90.0, osg::Y_AXIS))); // looks along +x of Unity's
    expectNear(pose.root(), {-1.0, kHips, 1.8});
    expectNear(positionOf(pose, "LeftToes") - positionOf(pose, "LeftFoot"), {-0.15, -0.05, 0.0});
}

/// A stranger may send any positions.
TEST(VmcPose, OfNobodyWhoStandsMovesNoRigAndDoesNotThrow) {
    const RestSkeleton rig = standing().skeleton();
    std::string reason;
    EXPECT_TRUE(osgSkin::LiveRetarget::create(standing().skeleton(), rig, {}, &reason));
    EXPECT_EQ(reason, "");
    for (const osg::Vec3d& each :
         {osg::Vec3d(0.1, 0, 0), osg::Vec3d(9e17, 9e17, -9e17), osg::Vec3d(0, 1e-20, 0)}) {
        VmcPose pose;
        for (const Bone& bone : kBones) setBone(pose, bone.name, each, osg::Quat());
        EXPECT_TRUE(pose.hasBody());
        reason.clear();
        const auto retarget = osgSkin::LiveRetarget::create(pose.skeleton(), rig, {}, &reason);
        EXPECT_NE(retarget.has_value(), !reason.empty());
        EXPECT_FALSE(retarget) << each.x();
    }
}

TEST(VmcPose, RefusesWhatCannotBeUsed) {
    VmcPose pose = standing();
    const glm::dvec3 root = pose.root();
    EXPECT_FALSE(setBone(pose, "Tail", {0, 1, 0}, osg::Quat()));
    EXPECT_FALSE(setBone(pose, "Hips", {0, std::nan(""), 0}, osg::Quat()));
    EXPECT_FALSE(setBone(pose, "Hips", {0, 1, 0}, osg::Quat(0, 0, 0, 0)));
    EXPECT_FALSE(setRoot(pose, {0, 0, std::numeric_limits<double>::infinity()}, osg::Quat()));
    EXPECT_FALSE(pose.take("/VMC/Ext/Hmd/Pos", "Hips", {0, 2, 0}, osg::Quat()));
    expectNear(pose.root(), root);
}

TEST(VmcPose, MovesAnotherBody) {
    VmcPose pose = standing();
    RestSkeleton rig; // arms hang by 45 degrees, twice as large
    rig.add("J_Bip_C_Hips", -1, glm::dvec3(0, 1.8, 0));
    rig.add("J_Bip_C_Spine", 0, glm::dvec3(0, 2.0, 0));
    rig.add("J_Bip_C_Head", 1, glm::dvec3(0, 3.0, 0));
    for (const double side : {1.0, -1.0}) {
        const std::string name = side > 0.0 ? "J_Bip_L_" : "J_Bip_R_";
        int parent = rig.add(name + "UpperLeg", 0, glm::dvec3(0.2 * side, 1.7, 0));
        parent = rig.add(name + "LowerLeg", parent, glm::dvec3(0.2 * side, 0.9, 0));
        rig.add(name + "Foot", parent, glm::dvec3(0.2 * side, 0.1, 0));
        parent = rig.add(name + "UpperArm", 1, glm::dvec3(0.36 * side, 2.7, 0));
        parent = rig.add(name + "LowerArm", parent, glm::dvec3(0.76 * side, 2.3, 0));
        rig.add(name + "Hand", parent, glm::dvec3(1.16 * side, 1.9, 0));
    }
    osgSkin::LiveRetarget live(pose.skeleton(), rig);
    setBone(pose, "LeftUpperArm", kBones[13].position, turn(-90.0, osg::Z_AXIS)); // up
    setRoot(pose, {0.5, 0, 0}, osg::Quat());
    std::vector<JointSample> joints(rig.joints.size());
    ASSERT_TRUE(live.apply(pose.rotations().data(), pose.root(), joints.data()));
    std::vector<glm::dquat> local, world;
    for (const JointSample& joint : joints) local.push_back(joint.rotation);
    std::vector<glm::dvec3> places;
    osgSkin::worldRotations(rig, local.data(), world);
    osgSkin::worldPositions(rig, world, rig.joints[0].centre + joints[0].translation, places);
    const auto at = [&](const char* name) { return places[std::size_t(rig.find(name))]; };
    const glm::dvec3 left = at("J_Bip_L_Hand") - at("J_Bip_L_UpperArm");
    const glm::dvec3 right = at("J_Bip_R_Hand") - at("J_Bip_R_UpperArm");
    EXPECT_LT(glm::distance(glm::normalize(left), glm::dvec3(0, 1, 0)), 1e-6);
    EXPECT_LT(glm::distance(glm::normalize(right), glm::dvec3(-1, 0, 0)), 1e-6);
    EXPECT_LT(at("J_Bip_C_Hips").x, -0.8); // half a metre, for a body of about twice the size
}
