// SPDX-License-Identifier: MIT
// The joint whose position moves a motion's figure, and warnings about others.
#include "Figure.h"
#include "GltfBuilder.h"
#include "Notices.h"

#include <osgSkinImport/ImportMotion>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <string>

namespace {

using test::GltfColumn;

/// Distance of the figure's last sample from its first.
double wayOf(const osgSkin::Motion& motion) {
    return glm::distance(motion.rootPositions.front(), motion.rootPositions.back());
}

} // namespace

TEST(RootJoint, NodesMayHaveOtherUnits) {
    for (const double unit : {0.01, 1.0, 100.0, 10000.0}) {
        GltfColumn column;
        const std::size_t armature =
            column.node({{"name", "armature"}, {"children", {0}}, {"scale", {unit, unit, unit}}});
        for (const std::size_t joint : {column.joints[1], column.joints[2]})
            column.json["nodes"][joint]["translation"] = {0, 1.0 / unit, 0};
        column.json["scenes"][0]["nodes"] = {armature};
        column.json.erase("skins"); // only a motion
        column.json.erase("meshes");
        column.json["nodes"][column.meshNode] = {{"name", "empty"}};
        column.animate("walk", column.joints[0], "rotation", {0.0, 1.0},
                       GltfColumn::turns({0, 10}));
        column.animate("walk", column.joints[1], "translation", {0.0, 1.0},
                       {0, 1.0 / unit, 0, 0, 1.05 / unit, 0});
        column.animate("walk", column.joints[2], "rotation", {0.0, 1.0},
                       GltfColumn::turns({0, 10}));
        const osgSkin::Motion motion = osgSkin::importMotion(column.save("units.gltf"));
        ASSERT_EQ(motion.skeleton.joints.front().name, "middle") << unit;
        EXPECT_GT(wayOf(motion), 0.04) << unit;
    }
}

/// For a figure that crouches in place below a static root.
TEST(RootJoint, BvhFiguresMayBeSmall) {
    for (const double unit : {0.002, 0.01, 1.0, 100.0}) {
        const auto vector = [&](double y) { return "0 " + std::to_string(unit * y) + " 0"; };
        const std::string path = testing::TempDir() + "small_figure.bvh";
        std::ofstream(path)
            << "HIERARCHY\nROOT reference\n{\nOFFSET 0 0 0\nCHANNELS 3 Zrotation Xrotation "
               "Yrotation\nJOINT hips\n{\nOFFSET "
            << vector(1.0)
            << "\nCHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation\nJOINT "
               "spine\n{\nOFFSET "
            << vector(0.5) << "\nCHANNELS 3 Zrotation Xrotation Yrotation\nEnd Site\n{\nOFFSET "
            << vector(0.3) << "\n}\n}\n}\n}\nMOTION\nFrames: 2\nFrame Time: 0.1\n0 0 0 "
            << vector(1.0) << " 0 0 0 0 0 0\n0 0 0 " << vector(0.92) << " 0 0 0 0 0 0\n";
        const osgSkin::Motion motion = osgSkin::importMotion(path);
        EXPECT_EQ(motion.skeleton.joints.front().name, "hips") << unit;
        EXPECT_NEAR(wayOf(motion), 0.08 * unit, 0.01 * unit);
    }
}

TEST(RootJoint, IgnoresLeafJoints) {
    GltfColumn column;
    column.bend();
    column.animate("bend", column.joints[2], "translation", {0.0, 1.0}, {0, 1, 0, 0, 2, 0});
    const test::Notices notices;
    const osgSkin::Motion motion = osgSkin::importMotion(column.save("end.gltf"));
    EXPECT_EQ(motion.skeleton.joints.size(), 3u);
    ASSERT_EQ(motion.moves.size(), 1u);
    EXPECT_EQ(motion.moves.begin()->first, 2u);
    EXPECT_LT(glm::distance(motion.moves.begin()->second.back(), glm::dvec3(0, 2, 0)), 1e-6);
    EXPECT_EQ(notices.text(), "");
}

TEST(RootJoint, WarnsAboutScales) {
    for (const double scale : {1.0, 2.0}) {
        GltfColumn column;
        column.bend();
        column.animate("bend", column.joints[2], "scale", {0.0, 1.0},
                       {1, 1, 1, scale, scale, scale});
        const test::Notices notices;
        osgSkin::importMotion(column.save("scaled.gltf"));
        EXPECT_EQ(notices.say("joint \"top\" is scaled; motions have no scales"), scale > 1.0)
            << notices.text();
    }
}

/// The same clip plays sheared on its own body, and not on one that it is retargeted to.
TEST(RootJoint, WarnsAboutRotationWithinUnevenScale) {
    for (const double length : {1.0, 2.0}) {
        GltfColumn column;
        column.bend();
        const std::size_t above = column.node(
            {{"name", "Armature"}, {"scale", {1, length, 1}}, {"children", {column.joints[0]}}});
        column.json["scenes"][0]["nodes"] = {above, column.meshNode};
        const test::Notices notices;
        osgSkin::importMotion(column.save("uneven.gltf"));
        EXPECT_EQ(notices.say(" is scaled unevenly; motions have no scales"), length > 1.0)
            << notices.text();
    }
}

/// Game engines' skeletons have a root on the ground, and targets beside the hips.
TEST(RootJoint, HipsCarryTheFigure) {
    const std::string moves =
        "CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation\n";
    const std::string turns = "CHANNELS 3 Zrotation Xrotation Yrotation\n";
    const auto joint = [](const std::string& name, const std::string& offset,
                          const std::string& channels, const std::string& below) {
        return "JOINT " + name + "\n{\nOFFSET " + offset + "\n" + channels + below + "}\n";
    };
    const std::string end = "End Site\n{\nOFFSET 0 0.1 0\n}\n";
    std::string body = joint("spine_01", "0 0.2 0", turns, joint("head", "0 0.4 0", turns, end));
    for (const std::string side : {"l", "r"}) {
        const std::string foot = joint("foot_" + side, "0 -0.5 0", turns, end);
        const std::string calf = joint("calf_" + side, "0 -0.5 0", turns, foot);
        body += joint("thigh_" + side, side == "l" ? "0.1 0 0" : "-0.1 0 0", turns, calf);
    }
    std::string rest;
    for (int i = 0; i < 24; ++i) rest += "0 ";
    const std::string path = testing::TempDir() + "engine.bvh";
    std::ofstream(path) << "HIERARCHY\nROOT root\n{\nOFFSET 0 0 0\n"
                        << moves << joint("ik_foot_root", "0 0 0", turns, end)
                        << joint("pelvis", "0 1 0", moves, body)
                        << "}\nMOTION\nFrames: 2\nFrame Time: 0.1\n"
                        << "0 0 0 0 0 0  0 0 0  0 1 0 0 0 0 " << rest << "\n"
                        << "1 0 0 0 0 90  0 40 0  0 0.5 0 0 30 0 " << rest << "\n";
    const test::Notices notices;
    const osgSkin::Motion motion = osgSkin::importMotion(path);
    ASSERT_EQ(motion.skeleton.joints.size(), 10u);
    EXPECT_EQ(motion.skeleton.joints[0].name, "pelvis");
    EXPECT_EQ(motion.skeleton.joints[1].name, "ik_foot_root");
    EXPECT_EQ(motion.skeleton.joints[1].parent, 0);
    EXPECT_EQ(motion.skeleton.joints[1].centre, glm::dvec3(0.0));
    EXPECT_LT(glm::distance(motion.rootPositions[0], {0, 1, 0}), 1e-9);
    EXPECT_LT(glm::distance(motion.rootPositions[1], {1, 0.5, 0}), 1e-9);
    const glm::dquat above = turnDegrees(90, {0, 1, 0});
    const glm::dquat pelvis = motion.rotation(1, 0), target = pelvis * motion.rotation(1, 1);
    EXPECT_GT(std::abs(glm::dot(pelvis, above * turnDegrees(30, {1, 0, 0}))), 1.0 - 1e-9);
    EXPECT_GT(std::abs(glm::dot(target, above * turnDegrees(40, {1, 0, 0}))), 1.0 - 1e-9);
    EXPECT_EQ(notices.text(), "");
}
