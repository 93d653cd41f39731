// SPDX-License-Identifier: MIT
// glTF features of various exporters, each in a small file, compared with linear blending by the
// format's definition.
#include "BlendError.h"
#include "ExpectContains.h"
#include "GltfBuilder.h"
#include "Notices.h"
#include "WhyRefused.h"

#include <osgSkinCharacter/LoadCharacter>

#include <gtest/gtest.h>
#include <osgAnimation/BoneMapVisitor>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

namespace {

using osgSkin::Character;
using osgSkin::loadCharacter;
using test::BlendError;
using test::blendError;
using test::GltfColumn;

constexpr double kExact = 1e-5; ///< relative to the size: single precision

std::vector<std::string> jointsOf(const Character& character) {
    std::vector<std::string> result;
    for (const osgSkin::RestJoint& joint : character.rest.joints) result.push_back(joint.name);
    return result;
}

void expectExact(const std::string& file) {
    const BlendError error = blendError(file);
    EXPECT_LT(error.whole, kExact) << error.clip;
    EXPECT_LT(error.mixed, kExact) << error.clip;
}

} // namespace

TEST(WildGltf, MeshAndBoneMayShareAName) {
    GltfColumn column;
    column.bend();
    column.json["nodes"][column.meshNode]["name"] = "top";
    // The mesh comes first, as some exporters order it.
    column.json["scenes"][0]["nodes"] = {column.meshNode, 0};
    const std::string file = column.save("twin_mesh.gltf");
    expectExact(file);
    EXPECT_EQ(jointsOf(loadCharacter(file)), (std::vector<std::string>{"base", "middle", "top"}));
}

TEST(WildGltf, JointsMayShareAName) {
    GltfColumn column;
    column.bend();
    for (const std::size_t joint : column.joints) column.json["nodes"][joint]["name"] = "Bone";
    const std::string file = column.save("twin_joints.gltf");
    expectExact(file);
    EXPECT_EQ(jointsOf(loadCharacter(file)),
              (std::vector<std::string>{"Bone", "Bone.001", "Bone.002"}));
}

TEST(WildGltf, JointsMayHaveNoNamesOrThatOfAssimpsRoot) {
    GltfColumn column;
    column.bend();
    column.json["nodes"][column.joints[0]]["name"] = "ROOT";
    column.json["nodes"][column.joints[1]].erase("name");
    column.json["nodes"][column.joints[2]]["name"] = "";
    expectExact(column.save("no_names.gltf"));
}

/// Sketchfab's layout: the mesh in centimetres and Z up, rotated and scaled by nodes above a root
/// joint that has no weights and whose inverse bind matrix is the identity.
TEST(WildGltf, IgnoresHelperJointsWithoutWeights) {
    for (const bool isTop : {true, false}) {
        GltfColumn column(100.0);
        column.bend();
        std::vector<double> matrices(16, 0.0);
        for (int k = 0; k < 16; k += 5) matrices[std::size_t(k)] = 1.0;
        for (int j = 0; j < 3; ++j)
            for (int k = 0; k < 16; ++k)
                matrices.push_back(k == 13 ? -j : k == 15 ? 1.0 : k % 5 == 0 ? 0.01 : 0.0);
        const std::size_t helper = column.node({{"name", "_rootJoint"}});
        if (isTop) { // above all, under a rotating node
            column.json["nodes"][helper]["children"] = {column.joints[0]};
            column.json["nodes"][helper]["translation"] = {0, 0.5, 0};
        } else { // a leaf
            column.json["nodes"][helper]["translation"] = {0, 0.5, 0.5};
            column.json["nodes"][column.joints[1]]["children"].push_back(helper);
        }
        const std::size_t above =
            column.node({{"name", "Sketchfab_model"},
                         {"rotation", {-std::sqrt(0.5), 0, 0, std::sqrt(0.5)}},
                         {"children", {isTop ? helper : column.joints[0]}}});
        std::vector<double> indices;
        for (int v = 0; v < 24; ++v)
            indices.insert(indices.end(), {double(1 + (v >= 8) + (v >= 16)), 0, 0, 0});
        column.attributes()["JOINTS_0"] = column.accessor("VEC4", indices, 5121);
        column.json["skins"][0] = {
            {"joints", {helper, column.joints[0], column.joints[1], column.joints[2]}},
            {"inverseBindMatrices", column.accessor("MAT4", matrices)}};
        column.json["scenes"][0]["nodes"] = {above, column.meshNode};
        const std::string file = column.save(isTop ? "helper_root.gltf" : "helper_leaf.gltf");
        expectExact(file);
        // The rest pose is the character's own: as tall as the mesh, with its joints inside.
        const Character character = loadCharacter(file);
        EXPECT_NEAR(character.body.mesh.size(), 2.9, 0.01);
        const int top = character.rest.find("top");
        ASSERT_GE(top, 0);
        double nearest = 10.0;
        for (const glm::dvec3& p : character.body.mesh.positions)
            nearest =
                std::min(nearest, glm::length(p - character.rest.joints[std::size_t(top)].centre));
        EXPECT_LT(nearest, 0.5);
        const int odd = character.rest.find("_rootJoint");
        ASSERT_GE(odd, 0);
        const glm::dvec3 hips =
            character.rest.joints[std::size_t(character.rest.find("base"))].centre;
        EXPECT_LT(glm::length(character.rest.joints[std::size_t(odd)].centre - hips), 2.0);
    }
}

TEST(WildGltf, AcceptsSkinWithoutInverseBindMatrices) {
    GltfColumn column;
    column.json["skins"][0].erase("inverseBindMatrices");
    // Joints at the origin in the bind pose move from there.
    for (const std::size_t joint : {column.joints[1], column.joints[2]})
        column.json["nodes"][joint].erase("translation");
    column.bend();
    expectExact(column.save("no_inverse_bind.gltf"));
    column.json["skins"][0]["inverseBindMatrices"] =
        column.accessor("MAT4", std::vector<double>(32, 1.0));
    column.json.erase("buffers");
    test::expectContains(test::whyRefused(column.save("few_inverse_bind.gltf")),
                         "2 inverse bind matrices");
}

TEST(WildGltf, ReadsQuantisedNumbers) {
    GltfColumn column;
    std::vector<double> small = column.places;
    for (double& p : small) p /= 4.0;
    column.attributes()["POSITION"] = column.accessor("VEC3", small, 5122, true);
    std::vector<double> weights, corners, matrices;
    for (int v = 0; v < 24; ++v) {
        weights.insert(weights.end(), {0.4, 0.6, 0, 0});
        const double third = (v >= 8) + (v >= 16);
        corners.insert(corners.end(), {third, third, 0, 0});
    }
    column.attributes()["WEIGHTS_0"] = column.accessor("VEC4", weights, 5121, true);
    column.attributes()["JOINTS_0"] = column.accessor("VEC4", corners, 5123);
    for (int j = 0; j < 3; ++j)
        for (int k = 0; k < 16; ++k)
            matrices.push_back(k == 13 ? -j : k == 15 ? 1.0 : k % 5 == 0 ? 4.0 : 0.0);
    column.json["skins"][0]["inverseBindMatrices"] = column.accessor("MAT4", matrices);
    column.animate("bend", column.joints[1], "rotation", {0.0, 0.5, 1.0},
                   GltfColumn::turns({0, 60, 90}), "LINEAR", 5122);
    column.json["extensionsUsed"] = column.json["extensionsRequired"] = {"KHR_mesh_quantization"};
    const BlendError error = blendError(column.save("quantised.gltf"));
    EXPECT_LT(error.whole, kExact);
    EXPECT_LT(error.mixed, kExact);
}

/// Up to sixteen joints per vertex: ignoring a set would rotate vertices to other positions.
TEST(WildGltf, ReadsEverySetOfJoints) {
    using Set = std::pair<double, double>; // the joint and the weight of all vertices
    for (const auto& sets : {std::vector<Set>{{0, 0.25}, {2, 0.75}},
                             std::vector<Set>{{0, 0.25}, {1, 0.25}, {2, 0.5}}}) {
        GltfColumn column;
        for (const std::size_t joint : {column.joints[1], column.joints[2]})
            column.animate("nod", joint, "rotation", {0.0, 1.0}, GltfColumn::turns({0, 10}));
        for (std::size_t k = 0; k < sets.size(); ++k) {
            std::vector<double> joints(96, 0.0), weights(96, 0.0);
            for (std::size_t v = 0; v < 96; v += 4) {
                joints[v] = sets[k].first;
                weights[v] = sets[k].second;
            }
            const std::string number = std::to_string(k);
            column.attributes()["JOINTS_" + number] = column.accessor("VEC4", joints, 5121);
            column.attributes()["WEIGHTS_" + number] = column.accessor("VEC4", weights);
        }
        const BlendError error = blendError(column.save("sets.gltf"));
        EXPECT_LT(error.mixed, 0.01) << sets.size();
        EXPECT_LT(error.whole, kExact) << sets.size();
    }
}

TEST(WildGltf, ReadsSplinesAndSteps) {
    GltfColumn column;
    std::vector<double> spline;
    for (const double angle : {0.0, 60.0, 30.0})
        for (const auto& part : {std::vector<double>{0.8, 0, 0, 0}, GltfColumn::turn(angle),
                                 std::vector<double>{0.8, 0, 0, 0}})
            spline.insert(spline.end(), part.begin(), part.end());
    column.animate("spline", column.joints[1], "rotation", {0.0, 0.7, 1.0}, spline, "CUBICSPLINE");
    column.animate("steps", column.joints[1], "rotation", {0.0, 0.4, 1.0},
                   GltfColumn::turns({0, 60, 90}), "STEP");
    const BlendError error = blendError(column.save("splines.gltf"));
    EXPECT_EQ(error.clips, 2u);
    EXPECT_LT(error.whole, 1e-3) << error.clip; // 30 samples a second between the keys
}

/// Copies a box of the column's first vertices and faces as a mesh without a skin.
static std::size_t addBox(GltfColumn& column) {
    std::vector<double> places(column.places.begin(), column.places.begin() + 24);
    std::vector<double> indices;
    for (const int corner : {0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6}) indices.push_back(corner);
    column.json["meshes"].push_back(
        {{"name", "box"},
         {"primitives",
          {{{"attributes", {{"POSITION", column.accessor("VEC3", places)}}},
            {"indices", column.accessor("SCALAR", indices, 5123)}}}}});
    return column.json["meshes"].size() - 1;
}

TEST(WildGltf, MeshesFollowTheirParentNode) {
    GltfColumn column;
    column.bend();
    // An object on an animated node below a joint; no skin names the node.
    const std::size_t grip = column.node({{"name", "grip"}, {"translation", {0.5, 0.5, 0}}});
    const std::size_t thing =
        column.node({{"name", "thing"}, {"mesh", addBox(column)}, {"translation", {0, 0.2, 0}}});
    column.json["nodes"][column.joints[2]]["children"] = {grip};
    column.json["nodes"][grip]["children"] = {thing};
    column.animate("bend", grip, "rotation", {0.0, 1.0}, GltfColumn::turns({0, 80}));
    expectExact(column.save("thing.gltf"));
}

TEST(WildGltf, LeavesOutScenery) {
    GltfColumn column;
    column.bend();
    const std::size_t box = addBox(column);
    const std::size_t floor =
        column.node({{"name", "floor"}, {"mesh", box}, {"scale", {20, 0.1, 20}}});
    const std::size_t stand =
        column.node({{"name", "stand"}, {"mesh", box}, {"translation", {5, 0, 0}}});
    const std::size_t eye =
        column.node({{"name", "eye"}, {"mesh", box}, {"scale", {0.2, 0.2, 0.2}}});
    column.json["scenes"][0]["nodes"] = {0, column.meshNode, floor, stand, eye};
    const test::Notices notices;
    const Character character = loadCharacter(column.save("scenery.gltf"));
    EXPECT_EQ(character.body.mesh.positions.size(), 24u + 8u);
    EXPECT_TRUE(notices.say("objects beside the figure are left out: \"floor\" and 1 more"))
        << notices.text();
}

/// A floor and a ball at a figure that walks off stay, or follow their own nodes.
TEST(WildGltf, FreeMeshesFollowTheirOwnNodes) {
    GltfColumn column;
    column.bend();
    column.animate("bend", column.joints[0], "translation", {0.0, 1.0}, {0, 0, 0, 2, 0, 0});
    const std::size_t box = addBox(column);
    const std::size_t floor =
        column.node({{"name", "floor"}, {"mesh", box}, {"scale", {2, 0.1, 2}}});
    const std::size_t ball =
        column.node({{"name", "ball"}, {"mesh", box}, {"scale", {0.2, 0.2, 0.2}}});
    column.animate("bend", ball, "translation", {0.0, 1.0}, {0, 1, 0, 4, 2, 0});
    column.json["scenes"][0]["nodes"] = {0, column.meshNode, floor, ball};
    expectExact(column.save("floor.gltf"));
}

/// Without a clip of its own, the figure is to be moved by others, and eyes with it.
TEST(WildGltf, WithoutClipsFreeMeshesInsideTheFigureBelongToIt) {
    GltfColumn column;
    const std::size_t box = addBox(column);
    const std::size_t floor = column.node(
        {{"name", "floor"}, {"mesh", box}, {"scale", {1, 0.1, 1}}, {"translation", {0, -0.1, 0}}});
    const std::size_t eye = column.node(
        {{"name", "eye"}, {"mesh", box}, {"scale", {0.2, 0.2, 0.2}}, {"translation", {0, 2, 0}}});
    column.json["scenes"][0]["nodes"] = {0, column.meshNode, floor, eye};
    const test::Notices notices;
    const Character character = loadCharacter(column.save("still.gltf"));
    EXPECT_EQ(character.body.mesh.positions.size(), 24u + 8u);
    EXPECT_TRUE(notices.say("objects beside the figure are left out: \"floor\"\n"))
        << notices.text();
}

TEST(WildGltf, PartsPaintedForOneJointFollowIt) {
    GltfColumn column;
    column.bend();
    std::vector<double> indices;
    for (int v = 0; v < 24; ++v) indices.insert(indices.end(), {1, 0, 0, 0});
    column.attributes()["JOINTS_0"] = column.accessor("VEC4", indices, 5121);
    expectExact(column.save("shirt.gltf"));
}

/// Blender's exporter puts vertices that nobody painted on a joint of its own.
TEST(WildGltf, UnpaintedVerticesFollowTheirNeighbours) {
    test::GltfColumn column;
    column.json["nodes"][column.joints[2]]["name"] = "neutral_bone";
    const test::Notices notices;
    const Character character = osgSkin::loadCharacter(column.save("neutral_bone.gltf"));
    EXPECT_TRUE(notices.say("8 of 24 vertices have no weights, they take those of the nearest"))
        << notices.text();
    const osgSkin::Binding& binding = character.binding;
    for (const std::uint32_t joint : binding.regions)
        EXPECT_NE(binding.joints[joint].name, "neutral_bone");
}

/// Sketchfab's layout: a scale of the topmost joint's node that every clip replaces.
TEST(WildGltf, ClipsMayReplaceAJointsScale) {
    GltfColumn column;
    column.bend();
    column.json["nodes"][0]["scale"] = {0.45, 0.6, 0.27};
    column.animate("bend", 0, "scale", {0.0, 1.0}, {1, 1, 1, 1, 1, 1});
    expectExact(column.save("top_scale.gltf"));
}

TEST(WildGltf, WarnsOnceAboutNonUniformScaleAboveFivePerCent) {
    for (const double scale : {1.04, 1.2}) {
        GltfColumn column;
        for (const std::size_t joint : column.joints)
            column.animate("squash", joint, "scale", {0.0, 1.0}, {1, 1, 1, 1, scale, 1});
        const test::Notices notices;
        const Character character = loadCharacter(column.save("squash.gltf"));
        EXPECT_EQ(character.notes.size(), scale > 1.05 ? 1u : 0u);
        EXPECT_EQ(notices.lines(), scale > 1.05 ? 1u : 0u) << notices.text();
        EXPECT_EQ(notices.say("\"squash\" and 2 more scaled non-uniformly"), scale > 1.05);
    }
}

TEST(WildGltf, ClipsMayStartAfterZero) {
    GltfColumn column;
    column.animate("late", column.joints[1], "rotation", {5.0, 5.5, 6.0},
                   GltfColumn::turns({0, 60, 90}));
    const std::string file = column.save("late.gltf");
    expectExact(file);
    EXPECT_NEAR(loadCharacter(file).motions.front().duration(), 1.0, 1e-6);
}

TEST(WildGltf, AccessorWithoutBufferViewIsZeros) {
    const auto jointAt = [](bool isStored) {
        GltfColumn column;
        column.animate("still", column.joints[1], "translation", {0.0, 1.0},
                       std::vector<double>(6, 0.0));
        const nlohmann::json& sampler = column.json["animations"][0]["samplers"][0];
        if (!isStored)
            column.json["accessors"][sampler["output"].get<std::size_t>()].erase("bufferView");
        Character character = loadCharacter(column.save(isStored ? "stored.gltf" : "nowhere.gltf"));
        character.poseAt(character.motions.at(0), 0.5);
        osgAnimation::BoneMapVisitor bones;
        character.skeleton->accept(bones);
        return bones.getBoneMap().at(character.rest.joints.at(1).name)->getMatrixInSkeletonSpace();
    };
    EXPECT_EQ(jointAt(false), jointAt(true));
}

TEST(WildGltf, ReadsMeshWithTwoSkins) {
    GltfColumn column;
    column.bend();
    std::vector<std::size_t> twins;
    twins.reserve(3);
    for (int j = 0; j < 3; ++j)
        twins.push_back(column.node({{"name", "twin" + std::to_string(j)},
                                     {"translation", {j == 0 ? 3 : 0, j == 0 ? 0 : 1, 0}}}));
    column.json["nodes"][twins[0]]["children"] = {twins[1]};
    column.json["nodes"][twins[1]]["children"] = {twins[2]};
    const std::size_t base = column.node({{"name", "both"}, {"children", {0, twins[0]}}});
    column.json["skins"].push_back(
        {{"joints", twins}, {"inverseBindMatrices", column.inverseBind}});
    const std::size_t second = column.node({{"name", "body2"}, {"mesh", 0}, {"skin", 1}});
    column.json["scenes"][0]["nodes"] = {base, column.meshNode, second};
    expectExact(column.save("two_skins.gltf"));
}

TEST(WildGltf, RejectsBrokenCompression) {
    GltfColumn column;
    column.json["extensionsUsed"] = column.json["extensionsRequired"] = {"EXT_meshopt_compression"};
    column.json["buffers"] = {
        {{"byteLength", 4}, {"uri", "data:;base64,AAAAAA=="}},
        {{"byteLength", column.bytes().size()},
         {"extensions", {{"EXT_meshopt_compression", {{"fallback", true}}}}}}};
    for (auto& view : column.json["bufferViews"]) {
        view["buffer"] = 1;
        view["extensions"]["EXT_meshopt_compression"] = {{"buffer", 0},
                                                         {"byteLength", 4},
                                                         {"byteStride", 4},
                                                         {"count", 1},
                                                         {"mode", "ATTRIBUTES"}};
    }
    const std::string why = test::whyRefused(column.save("meshopt.gltf"));
    test::expectContains(why, "meshopt compression");
    test::expectContains(why, "meshopt.gltf");
}

TEST(WildGltf, ReadsVrm) {
    GltfColumn column;
    column.bend();
    expectExact(column.save("avatar.vrm"));
    const Character plain = loadCharacter(column.save("avatar.VRM"));
    EXPECT_LT((osg::Vec3d(0, 0, 1) * plain.toWorld - osg::Vec3d(0, -1, 0)).length(), 1e-6);
    column.json["extensions"]["VRM"] = {{"specVersion", "0.0"}}; // its front is -Z
    const Character turned = loadCharacter(column.save("avatar0.vrm"));
    EXPECT_LT((osg::Vec3d(0, 0, -1) * turned.toWorld - osg::Vec3d(0, -1, 0)).length(), 1e-6);
    EXPECT_LT((osg::Vec3d(0, 1, 0) * turned.toWorld - osg::Vec3d(0, 0, 1)).length(), 1e-6);
}

TEST(WildGltf, AppliesDefaultMorphWeights) {
    GltfColumn column;
    column.bend();
    const std::vector<osg::Vec3d> plain = [&] {
        std::vector<osg::Vec3d> result;
        for (const glm::dvec3& p : loadCharacter(column.save("plain.gltf")).body.mesh.positions)
            result.emplace_back(p.x, p.y, p.z);
        return result;
    }();
    std::vector<double> moves(column.places.size(), 0.0);
    for (std::size_t i = 0; i < moves.size(); i += 3) moves[i] = 0.4;
    column.json.erase("buffers");
    const std::size_t target = column.accessor("VEC3", moves);
    auto& mesh = column.json["meshes"][0];
    mesh["primitives"][0]["targets"] = {{{"POSITION", target}}};
    mesh["weights"] = {0.25};
    const auto expectMoved = [&](const std::string& file, double by) {
        const Character moved = loadCharacter(file);
        ASSERT_EQ(moved.body.mesh.positions.size(), plain.size());
        for (std::size_t v = 0; v < plain.size(); ++v)
            EXPECT_NEAR(moved.body.mesh.positions[v].x, plain[v].x() + by, 1e-6) << v;
    };
    expectMoved(column.save("by_mesh.gltf"), 0.1);
    column.json["nodes"][column.meshNode]["weights"] = {0.5}; // takes precedence over the mesh's
    const test::Notices notices;
    expectMoved(column.save("by_node.gltf"), 0.2);
    EXPECT_EQ(notices.lines(), 0u) << notices.text();
    column.json["animations"][0]["samplers"].push_back(
        {{"input", column.accessor("SCALAR", {0, 1})},
         {"output", column.accessor("SCALAR", {0, 1})},
         {"interpolation", "LINEAR"}});
    column.json["animations"][0]["channels"].push_back(
        {{"sampler", 2}, {"target", {{"node", column.meshNode}, {"path", "weights"}}}});
    column.json.erase("buffers");
    expectMoved(column.save("moving.gltf"), 0.2);
    EXPECT_EQ(notices.lines(), 0u) << notices.text();
}

TEST(WildGltf, ReadsPercentEncodedFileNames) {
    GltfColumn column;
    column.bend();
    const std::string inside = column.save("inside.gltf");
    std::ofstream(testing::TempDir() + "with a space.bin", std::ios::binary) << column.bytes();
    column.json["buffers"] = {
        {{"byteLength", column.bytes().size()}, {"uri", "with%20a%20space.bin"}}};
    Character character = loadCharacter(column.save("outside.gltf"));
    EXPECT_LT(blendError(character, inside).whole, kExact);
}
