// SPDX-License-Identifier: MIT
// Poses that come over UDP move a VRM file's figure.
#include "GltfBuilder.h"
#include "Performer.h"
#include "UpdateAt.h"

#include <osgSkin/DeformableSkin>

#include <osg/NodeVisitor>
#include <osgAnimation/Bone>

#include <gtest/gtest.h>
#include <lo/lo.h>
#include <lo/lo_cpp.h>

#include <cmath>
#include <map>
#include <memory>
#include <string>
#include <vector>

osg::ref_ptr<osg::Node> receivePoses(const std::string& file,
                                     const std::shared_ptr<lo::Server>& server);

namespace {

struct VrmBone {
    const char* name; ///< of VRM's humanoid
    int parent;
    double x, y, z; ///< in the world, metres; left is +x
};

/// Larger than the performer, with arms that hang at rest.
constexpr VrmBone kBones[] = {
    {"hips", -1, 0, 1.1, 0},
    {"spine", 0, 0, 1.2, 0},
    {"neck", 1, 0, 1.7, 0},
    {"head", 2, 0, 1.8, 0},
    {"leftUpperLeg", 0, 0.1, 1.05, 0},
    {"leftLowerLeg", 4, 0.1, 0.6, 0},
    {"leftFoot", 5, 0.1, 0.1, 0},
    {"rightUpperLeg", 0, -0.1, 1.05, 0},
    {"rightLowerLeg", 7, -0.1, 0.6, 0},
    {"rightFoot", 8, -0.1, 0.1, 0},
    {"leftUpperArm", 1, 0.2, 1.6, 0},
    {"leftLowerArm", 10, 0.4, 1.36, 0},
    {"leftHand", 11, 0.6, 1.12, 0},
    {"rightUpperArm", 1, -0.2, 1.6, 0},
    {"rightLowerArm", 13, -0.4, 1.36, 0},
    {"rightHand", 14, -0.6, 1.12, 0},
};
constexpr std::size_t kCount = std::size(kBones);

/// A VRM file of a figure of triangles, one on each bone, whose nodes' names say nothing.
std::string writeVrm() {
    test::GltfBuilder gltf;
    std::vector<double> places, joints, weights, matrices;
    nlohmann::json nodes, bones;
    for (std::size_t j = 0; j < kCount; ++j) {
        const VrmBone& bone = kBones[j];
        nlohmann::json node = {{"name", "n" + std::to_string(j)}};
        const VrmBone origin{"", -1, 0, 0, 0};
        const VrmBone& parent = bone.parent < 0 ? origin : kBones[bone.parent];
        node["translation"] = {bone.x - parent.x, bone.y - parent.y, bone.z - parent.z};
        for (std::size_t child = 0; child < kCount; ++child)
            if (kBones[child].parent == int(j)) node["children"].push_back(child);
        nodes.push_back(gltf.node(node));
        bones[bone.name] = {{"node", j}};
        for (int corner = 0; corner < 3; ++corner) {
            places.insert(places.end(), {bone.x + 0.05 * corner, bone.y - 0.05 * (corner == 1),
                                         bone.z + 0.05 * (corner == 2)});
            joints.insert(joints.end(), {double(j), 0, 0, 0});
            weights.insert(weights.end(), {1, 0, 0, 0});
        }
        matrices.insert(matrices.end(),
                        {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -bone.x, -bone.y, -bone.z, 1});
    }
    const std::size_t positions = gltf.accessor("VEC3", places);
    gltf.json["meshes"] = {{{"primitives",
                             {{{"attributes",
                                {{"POSITION", positions},
                                 {"JOINTS_0", gltf.accessor("VEC4", joints, 5121)},
                                 {"WEIGHTS_0", gltf.accessor("VEC4", weights)}}}}}}}};
    gltf.json["skins"] = {
        {{"joints", nodes}, {"inverseBindMatrices", gltf.accessor("MAT4", matrices)}}};
    gltf.json["scenes"][0]["nodes"] = {0, gltf.node({{"mesh", 0}, {"skin", 0}})};
    gltf.json["extensions"]["VRMC_vrm"] = {{"specVersion", "1.0"},
                                           {"humanoid", {{"humanBones", bones}}}};
    return gltf.save("performed.vrm");
}

/// The bones' joints, in the skeleton's space.
std::map<std::string, osg::Vec3d> jointsOf(osg::Node& scene) {
    struct Find : osg::NodeVisitor {
        Find() : osg::NodeVisitor(TRAVERSE_ALL_CHILDREN) {}
        void apply(osg::Transform& node) override {
            if (auto* bone = dynamic_cast<osgAnimation::Bone*>(&node))
                found[bone->getName()] = bone->getMatrixInSkeletonSpace().getTrans();
            traverse(node);
        }
        std::map<std::string, osg::Vec3d> found;
    } find;
    scene.accept(find);
    return find.found;
}

class ReceivePoses : public testing::Test {
protected:
    void SetUp() override {
        server = std::make_shared<lo::Server>(lo_server_new(nullptr, nullptr)); // any port
        ASSERT_TRUE(server->is_valid());
        scene = receivePoses(writeVrm(), server);
        test::updateAt(*scene, 0.0);
    }

    /// The direction of the left arm, after an update.
    osg::Vec3d armAt(double time) {
        test::updateAt(*scene, time);
        auto joints = jointsOf(*scene);
        osg::Vec3d arm = joints.at("n12") - joints.at("n10");
        arm.normalize();
        return arm;
    }

    /// For a third of a second, longer than a fade takes.
    void raise(double degrees, double begin = 0.0) {
        const Performer performer(server->port());
        for (int i = 0; i <= 20; ++i) {
            performer.send(begin + i / 60.0, raised(degrees));
            armAt(begin + i / 60.0);
        }
    }

    static std::map<std::string, osg::Quat> raised(double degrees) {
        return {{"LeftUpperArm", osg::Quat(osg::DegreesToRadians(-degrees), osg::Z_AXIS)}};
    }

    std::shared_ptr<lo::Server> server;
    osg::ref_ptr<osg::Node> scene;
};

double angle(const osg::Vec3d& a, const osg::Vec3d& b) {
    return osg::RadiansToDegrees(std::atan2((a ^ b).length(), a * b));
}

} // namespace

TEST_F(ReceivePoses, MovesAVrm) {
    raise(0.0);
    EXPECT_LT(angle(armAt(0.35), osg::X_AXIS), 1.0); // the T-pose, whatever the rest pose
    raise(90.0, 0.36);
    EXPECT_LT(angle(armAt(0.7), osg::Y_AXIS), 1.0);
}

/// Bones that do not stand, and then an actor.
TEST_F(ReceivePoses, WaitsForSomeoneWhoStands) {
    const osg::Vec3d before = armAt(0.0);
    const lo::Address address("127.0.0.1", std::to_string(server->port()));
    for (const char* const name :
         {"Hips", "Spine", "Head", "LeftUpperLeg", "LeftLowerLeg", "LeftFoot", "RightUpperLeg",
          "RightLowerLeg", "RightFoot", "LeftLowerArm", "LeftHand", "RightLowerArm", "RightHand"})
        address.send("/VMC/Ext/Bone/Pos", "sfffffff", name, 0.1, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0);
    address.send("/VMC/Ext/T", "f", 0.0);
    EXPECT_LT(angle(armAt(0.1), before), 1e-3);
    raise(90.0, 0.2);
    EXPECT_LT(angle(armAt(0.6), osg::Y_AXIS), 1.0);
}

/// Its message of the root has a scale and an offset as well.
TEST_F(ReceivePoses, FollowsTheRootOfVmc21) {
    raise(0.0);
    const lo::Address to("127.0.0.1", std::to_string(server->port()));
    for (int i = 1; i <= 20; ++i) { // a quarter turn about Unity's up
        to.send("/VMC/Ext/Root/Pos", "sfffffffffffff", "root", 0.0, 0.0, 0.0, 0.0, M_SQRT1_2, 0.0,
                M_SQRT1_2, 1.0, 1.0, 1.0, 0.0, 0.0, 0.0);
        to.send("/VMC/Ext/T", "f", 0.34 + i / 60.0);
        armAt(0.34 + i / 60.0);
    }
    EXPECT_LT(std::abs(armAt(0.7) * osg::X_AXIS), 0.02);
}

TEST_F(ReceivePoses, HoldsThePoseWhenPacketsAreLost) {
    raise(90.0);
    const osg::Vec3d arm = armAt(0.34);
    for (int i = 0; i < 60; ++i) EXPECT_LT(angle(armAt(0.35 + i / 60.0), arm), 1e-3);
    // The figure fades to the first pose after a pause.
    Performer(server->port()).send(3.0, raised(0.0));
    EXPECT_LT(angle(armAt(1.35), arm), 12.0);
}

TEST_F(ReceivePoses, DropsPacketsThatComeTooLate) {
    raise(90.0);
    const osg::Vec3d arm = armAt(0.34);
    Performer(server->port()).send(0.2, raised(0.0));
    EXPECT_LT(angle(armAt(0.35), arm), 1e-3);
}
