// SPDX-License-Identifier: MIT
//
// Joints that an editor's constraints hold in place: feet below IK controls, and MMD's "D" bones.
#include "GltfBuilder.h"
#include "Notices.h"
#include "Paths.h"
#include "UpdateAt.h"

#include <osgSkinImport/ImportMotion>
#include <osgSkinImport/ImportRig>
#include <osgSkinRig/JointRoles>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <osg/Group>
#include <osgAnimation/BasicAnimationManager>
#include <osgAnimation/Bone>
#include <osgAnimation/BoneMapVisitor>

#include <algorithm>
#include <map>
#include <string>
#include <vector>

namespace {

using osgSkin::ImportedRig;
using osgSkin::importRig;

/// A figure in metres. Its feet hang on controls on the floor, as far as `controls` has names for
/// them; else on the shins.
class Figure : public test::GltfBuilder {
public:
    std::map<std::string, std::size_t> nodes;

    explicit Figure(const std::vector<std::string>& controls, bool hasCopies = false) {
        root = node({{"name", "Armature"}});
        add("Hips", root, {0, 0.95, 0});
        add("Spine", nodes["Hips"], {0, 0.2, 0});
        add("Head", nodes["Spine"], {0, 0.4, 0});
        for (const int side : {0, 1}) {
            const std::string end = side == 0 ? ".L" : ".R";
            const double x = side == 0 ? 1.0 : -1.0;
            add("UpperArm" + end, nodes["Spine"], {x * 0.2, 0.3, 0});
            add("LowerArm" + end, nodes["UpperArm" + end], {x * 0.3, 0, 0});
            add("Hand" + end, nodes["LowerArm" + end], {x * 0.25, 0, 0});
            add("UpperLeg" + end, nodes["Hips"], {x * 0.1, 0, 0});
            add("LowerLeg" + end, nodes["UpperLeg" + end], {0, -0.45, 0});
            if (controls.empty()) {
                add("Foot" + end, nodes["LowerLeg" + end], {0, -0.42, 0});
            } else {
                std::size_t above = root;
                for (const std::string& control : controls) {
                    const bool isFirst = above == root;
                    above = nodes[control + end] =
                        child(control + end, above,
                              isFirst ? std::vector<double>{x * 0.1, 0.03, -0.1}
                                      : std::vector<double>{0, 0, 0});
                }
                add("Foot" + end, above, {0, 0.05, 0.1});
            }
            add("Toes" + end, nodes["Foot" + end], {0, -0.05, 0.15});
            if (hasCopies) {
                add("UpperLegD" + end, nodes["Hips"], {x * 0.1, 0, 0});
                add("LowerLegD" + end, nodes["UpperLegD" + end], {0, -0.45, 0});
                add("FootD" + end, nodes["LowerLegD" + end], {0, -0.42, 0});
            }
        }
        addSkin();
    }

private:
    std::size_t child(const std::string& name, std::size_t above,
                      const std::vector<double>& offset) {
        const std::size_t index = node({{"name", name}, {"translation", offset}});
        json["nodes"][above]["children"].push_back(index);
        places[index] = places[above] + glm::dvec3(offset[0], offset[1], offset[2]);
        return index;
    }

    void add(const std::string& name, std::size_t above, const std::vector<double>& offset) {
        nodes[name] = child(name, above, offset);
        joints.push_back(nodes[name]);
    }

    /// A triangle around each joint, which follows it wholly.
    void addSkin() {
        std::vector<double> positions, indices, weights, inverse;
        for (std::size_t j = 0; j < joints.size(); ++j) {
            const glm::dvec3 p = places[joints[j]];
            for (int corner = 0; corner < 3; ++corner) {
                positions.insert(positions.end(), {p.x + (corner == 1 ? 0.02 : 0.0),
                                                   p.y + (corner == 2 ? 0.02 : 0.0), p.z});
                indices.insert(indices.end(), {double(j), 0, 0, 0});
                weights.insert(weights.end(), {1, 0, 0, 0});
            }
            inverse.insert(inverse.end(),
                           {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -p.x, -p.y, -p.z, 1});
        }
        json["meshes"] = {{{"primitives",
                            {{{"attributes",
                               {{"POSITION", accessor("VEC3", positions)},
                                {"JOINTS_0", accessor("VEC4", indices, 5121)},
                                {"WEIGHTS_0", accessor("VEC4", weights)}}}}}}}};
        json["skins"] = {{{"joints", joints}, {"inverseBindMatrices", accessor("MAT4", inverse)}}};
        json["scenes"][0]["nodes"] = {root, node({{"mesh", 0}, {"skin", 0}})};
    }

    std::size_t root = 0;
    std::vector<std::size_t> joints;
    std::map<std::size_t, glm::dvec3> places; ///< of nodes, in the scene
};

std::string parentOf(const osgSkin::RestSkeleton& rest, const std::string& joint) {
    const int j = rest.find(joint);
    EXPECT_GE(j, 0) << joint;
    if (j < 0) return {};
    const int parent = rest.joints[static_cast<std::size_t>(j)].parent;
    return parent < 0 ? std::string() : rest.joints[static_cast<std::size_t>(parent)].name;
}

/// Plays a rig's first clip.
class Player {
public:
    explicit Player(const ImportedRig& rig) {
        _root->addChild(rig.skeleton);
        _root->setUpdateCallback(_manager);
        _manager->registerAnimation(rig.animations.at(0));
        _manager->playAnimation(rig.animations.at(0));
        osgAnimation::BoneMapVisitor visitor;
        rig.skeleton->accept(visitor);
        _bones = visitor.getBoneMap();
        test::updateAt(*_root, 0.0);
    }

    osg::Vec3d at(const std::string& bone, double time) {
        test::updateAt(*_root, time);
        return _bones.at(bone)->getMatrixInSkeletonSpace().getTrans();
    }

private:
    osg::ref_ptr<osg::Group> _root = new osg::Group;
    osg::ref_ptr<osgAnimation::BasicAnimationManager> _manager =
        new osgAnimation::BasicAnimationManager;
    osgAnimation::BoneMap _bones;
};

const std::vector<double> kTimes{0.0, 1.0};

} // namespace

TEST(LooseJoints, FeetBelowControlsFollowShins) {
    for (const std::vector<std::string>& controls :
         {std::vector<std::string>{"foot_IK"}, {"ctrl_master", "ctrl_ankle"}}) {
        const ImportedRig rig = importRig(Figure(controls).save("ik_feet.gltf"));
        EXPECT_EQ(parentOf(rig.rest, "Foot.L"), "LowerLeg.L");
        EXPECT_EQ(parentOf(rig.rest, "Foot.R"), "LowerLeg.R");
        EXPECT_EQ(parentOf(rig.rest, "Toes.R"), "Foot.R");
        const auto foot = static_cast<std::size_t>(rig.rest.find("Foot.L"));
        EXPECT_LT(glm::distance(rig.rest.joints[foot].centre, glm::dvec3(0.1, 0.08, 0)), 1e-6);
    }
}

/// As Rigify's deformation bones are exported alone: all limbs hang on the root, on the floor.
TEST(LooseJoints, PartsBesideTheHipsHangOnTheTrunk) {
    Figure figure({});
    nlohmann::json& nodes = figure.json["nodes"];
    const auto hangOnRoot = [&](const std::string& name, const std::string& above,
                                const std::vector<double>& place) {
        const std::size_t n = figure.nodes.at(name);
        nodes[n]["translation"] = place;
        nlohmann::json& siblings = nodes[figure.nodes.at(above)]["children"];
        siblings.erase(std::find(siblings.begin(), siblings.end(), n));
        nodes[0]["children"].push_back(n);
    };
    for (const double x : {1.0, -1.0}) {
        const std::string end = x > 0.0 ? ".L" : ".R";
        hangOnRoot("UpperLeg" + end, "Hips", {x * 0.1, 0.95, 0});
        hangOnRoot("UpperArm" + end, "Spine", {x * 0.2, 1.45, 0});
    }
    nodes[figure.nodes.at("Hips")]["name"] = "Spine0"; // nothing is called hips
    const osgSkin::RestSkeleton rest = importRig(figure.save("rigify.gltf")).rest;
    EXPECT_EQ(parentOf(rest, "UpperLeg.L"), "Spine0");
    EXPECT_EQ(parentOf(rest, "UpperLeg.R"), "Spine0");
    EXPECT_EQ(parentOf(rest, "UpperArm.L"), "Spine");
    EXPECT_EQ(osgSkin::recogniseJoints(rest).joint("Hips"), rest.find("Spine0"));
    const auto thigh = static_cast<std::size_t>(rest.find("UpperLeg.L"));
    EXPECT_LT(glm::distance(rest.joints[thigh].centre, glm::dvec3(0.1, 0.95, 0)), 1e-5);
}

TEST(LooseJoints, AreReportedOnce) {
    const std::string file = Figure({"foot_IK"}).save("ik_feet_notice.gltf");
    test::Notices notices;
    importRig(file);
    EXPECT_EQ(notices.lines(), 1u) << notices.text();
    EXPECT_TRUE(notices.say("\"Foot.L\" follows \"LowerLeg.L\"")) << notices.text();
}

TEST(LooseJoints, KeepsFeetBelowShins) {
    const std::string file = Figure(std::vector<std::string>()).save("feet_below.gltf");
    test::Notices notices;
    EXPECT_EQ(parentOf(importRig(file).rest, "Foot.L"), "LowerLeg.L");
    EXPECT_EQ(notices.text(), "");
}

/// The clip lowers the hips and bends the knee, while the foot's control stays on the floor, or
/// moves by itself.
TEST(LooseJoints, KeepsFootMotionOfClips) {
    for (const double lift : {0.0, 0.2}) {
        Figure figure({"foot_IK"});
        figure.animate("squat", figure.nodes["Hips"], "translation", kTimes,
                       {0, 0.95, 0, 0, 0.6, 0});
        figure.animate("squat", figure.nodes["UpperLeg.L"], "rotation", kTimes,
                       test::GltfColumn::turns({0, -60}));
        figure.animate("squat", figure.nodes["LowerLeg.L"], "rotation", kTimes,
                       test::GltfColumn::turns({0, 110}));
        figure.animate("squat", figure.nodes["foot_IK.L"], "translation", kTimes,
                       {0.1, 0.03, -0.1, 0.1, 0.03 + lift, -0.1});
        const ImportedRig rig = importRig(figure.save("ik_squat.gltf"));
        ASSERT_EQ(parentOf(rig.rest, "Foot.L"), "LowerLeg.L");
        Player player(rig);
        for (const double time : {0.0, 0.13, 0.5, 0.77, 0.999}) {
            const osg::Vec3d expected(0.1, 0.08 + lift * time, 0.0);
            EXPECT_LT((player.at("Foot.L", time) - expected).length(), 2e-3) << time;
        }
    }
}

TEST(LooseJoints, FootFollowsInClipsWithoutIt) {
    Figure figure({"foot_IK"});
    figure.animate("kick", figure.nodes["LowerLeg.L"], "rotation", kTimes,
                   test::GltfColumn::turns({0, 90}));
    Player player(importRig(figure.save("ik_kick.gltf")));
    const osg::Vec3d knee(0.1, 0.5, 0.0);
    EXPECT_LT((player.at("Foot.L", 0.999999) - osg::Vec3d(0.1, 0.5, -0.42)).length(), 1e-3);
    EXPECT_NEAR((player.at("Foot.L", 0.5) - knee).length(), 0.42, 1e-6);
}

TEST(LooseJoints, MotionsBendTheFootWithTheShin) {
    Figure figure({"foot_IK"});
    figure.animate("kick", figure.nodes["LowerLeg.L"], "rotation", kTimes,
                   test::GltfColumn::turns({0, 90}));
    const osgSkin::Motion motion = osgSkin::importMotion(figure.save("ik_motion.gltf"));
    EXPECT_EQ(parentOf(motion.skeleton, "Foot.L"), "LowerLeg.L");
}

TEST(LooseJoints, MmdCopiesFollowOriginals) {
    Figure figure({}, true);
    figure.animate("kick", figure.nodes["LowerLeg.L"], "rotation", kTimes,
                   test::GltfColumn::turns({0, 90}));
    const ImportedRig rig = importRig(figure.save("mmd_copies.gltf"));
    EXPECT_EQ(parentOf(rig.rest, "UpperLegD.L"), "UpperLeg.L");
    EXPECT_EQ(parentOf(rig.rest, "LowerLegD.R"), "LowerLeg.R");
    Player player(rig);
    EXPECT_LT((player.at("FootD.L", 0.7) - player.at("Foot.L", 0.7)).length(), 1e-6);
}

TEST(LooseJoints, KeepsOwnMotionOfCopies) {
    Figure figure({}, true);
    figure.animate("kick", figure.nodes["LowerLegD.L"], "rotation", kTimes,
                   test::GltfColumn::turns({0, 90}));
    Player player(importRig(figure.save("mmd_moved.gltf")));
    EXPECT_LT((player.at("FootD.L", 0.999999) - osg::Vec3d(0.1, 0.5, -0.42)).length(), 1e-3);
    EXPECT_LT((player.at("Foot.L", 0.999999) - osg::Vec3d(0.1, 0.08, 0.0)).length(), 1e-3);
}
