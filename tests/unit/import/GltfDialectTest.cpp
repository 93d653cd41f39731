// SPDX-License-Identifier: MIT
// glTF features that Assimp does not read, or reads wrongly.
#include "ExpectError.h"
#include "FindNodes.h"
#include "GltfBuilder.h"
#include "Notices.h"

#include <osgSkinImport/ImportMesh>
#include <osgSkinImport/ImportMotion>
#include <osgSkinImport/ImportRig>
#include <osgSkinImport/ImportSkeleton>

#include <osgAnimation/Bone>
#include <osgAnimation/Channel>

#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

namespace {

using nlohmann::json;
using test::GltfColumn;

constexpr std::size_t kColumnVertices = 24;

json& primitiveOf(GltfColumn& column) {
    return column.json["meshes"][0]["primitives"][0];
}

/// The column's positions with extra floats after each, missing after the last ones.
std::size_t trimmedPlaces(GltfColumn& column, std::size_t unused) {
    std::vector<double> numbers;
    for (std::size_t v = 0; v < kColumnVertices; ++v) {
        numbers.insert(numbers.end(), column.places.begin() + std::ptrdiff_t(3 * v),
                       column.places.begin() + std::ptrdiff_t(3 * v + 3));
        if (v + 1 < kColumnVertices) numbers.insert(numbers.end(), unused, 0.0);
    }
    const std::size_t accessor = column.accessor("SCALAR", numbers);
    json& all = column.json["accessors"];
    all[accessor]["type"] = "VEC3";
    all[accessor]["count"] = kColumnVertices;
    column.json["bufferViews"][all[accessor]["bufferView"].get<std::size_t>()]["byteStride"] =
        4 * (3 + unused);
    return accessor;
}

/// Turns an accessor into sparse changes to zeros, without a buffer view of its own.
void makeSparse(GltfColumn& column, std::size_t accessor) {
    json& whole = column.json["accessors"][accessor];
    const auto count = whole["count"].get<std::size_t>();
    std::vector<double> places;
    for (std::size_t i = 0; i < count; ++i) places.push_back(double(i));
    const std::size_t indices = column.accessor("SCALAR", places, 5123);
    json& sparse = column.json["accessors"][accessor];
    sparse["sparse"] = {{"count", count},
                        {"indices",
                         {{"bufferView", column.json["accessors"][indices]["bufferView"]},
                          {"componentType", 5123}}},
                        {"values", {{"bufferView", sparse["bufferView"]}}}};
    sparse.erase("bufferView");
}

/// The sum of a bone's weights, by its index.
double weightOf(const osgSkin::ImportedRig& rig, const std::string& bone) {
    double result = 0.0;
    for (const osgSkin::BoneWeights& weights : rig.body.weights)
        for (const osgSkin::BoneWeights::Entry& entry : weights.entries)
            result += weights.bone == bone ? entry.weight : 0.0;
    return result;
}

void expectRigRefused(GltfColumn& column, const std::string& message) {
    const std::string path = column.save("untrue.gltf");
    expectError([&] { osgSkin::importRig(path); }, path + ": " + message);
    expectError([&] { osgSkin::importMotion(path); }, path + ": " + message);
}

/// A column whose middle is animated in one property.
GltfColumn moved(const std::string& path, const std::vector<double>& values,
                 const std::string& interpolation = "LINEAR") {
    GltfColumn column;
    column.animate("move", 1, path, {0.0, 0.5, 1.0}, values, interpolation);
    return column;
}

} // namespace

TEST(GltfDialect, LastStrideMayBeIncomplete) {
    GltfColumn column;
    column.attributes()["POSITION"] = trimmedPlaces(column, 2);
    const osgSkin::ImportedMesh mesh = osgSkin::importMesh(column.save("trimmed.gltf"));
    ASSERT_EQ(mesh.mesh.positions.size(), kColumnVertices);
    for (std::size_t v = 0; v < kColumnVertices; ++v)
        for (int axis = 0; axis < 3; ++axis)
            EXPECT_NEAR(mesh.mesh.positions[v][axis], column.places[3 * v + std::size_t(axis)],
                        1e-6);
}

TEST(GltfDialect, JointsMayBeBytesAndShorts) {
    GltfColumn column;
    std::vector<double> first, second, half;
    for (std::size_t v = 0; v < kColumnVertices; ++v) {
        first.insert(first.end(), {0, 0, 0, 0});
        second.insert(second.end(), {2, 1, 0, 0});
        half.insert(half.end(), {0.25, 0.25, 0, 0});
    }
    column.attributes()["JOINTS_0"] = column.accessor("VEC4", first, 5121);
    column.attributes()["WEIGHTS_0"] = column.accessor("VEC4", half);
    column.attributes()["JOINTS_1"] = column.accessor("VEC4", second, 5123);
    column.attributes()["WEIGHTS_1"] = column.attributes()["WEIGHTS_0"];
    const osgSkin::ImportedRig rig = osgSkin::importRig(column.save("joints.gltf"));
    EXPECT_NEAR(weightOf(rig, "base"), 0.5 * kColumnVertices, 1e-5);
    EXPECT_NEAR(weightOf(rig, "middle"), 0.25 * kColumnVertices, 1e-5);
    EXPECT_NEAR(weightOf(rig, "top"), 0.25 * kColumnVertices, 1e-5);
}

TEST(GltfDialect, JointsAndIndicesMayBeSparse) {
    const osgSkin::ImportedRig whole = osgSkin::importRig(GltfColumn().save("whole.gltf"));
    for (const bool hasMore : {false, true}) {
        GltfColumn column;
        if (hasMore) { // and a second set, which is not
            column.attributes()["JOINTS_1"] =
                column.accessor("VEC4", std::vector<double>(4 * kColumnVertices, 0.0), 5121);
            column.attributes()["WEIGHTS_1"] =
                column.accessor("VEC4", std::vector<double>(4 * kColumnVertices, 0.0));
        }
        const auto indices =
            column.json["meshes"][0]["primitives"][0]["indices"].get<std::size_t>();
        for (const std::size_t accessor : {column.jointIndices, indices}) {
            makeSparse(column, accessor);
            column.json["accessors"][accessor]["normalized"] = true; // which has no meaning here
        }
        const osgSkin::ImportedRig rig = osgSkin::importRig(column.save("sparse.gltf"));
        EXPECT_EQ(rig.body.mesh.positions, whole.body.mesh.positions);
        EXPECT_EQ(rig.body.mesh.faceVertices, whole.body.mesh.faceVertices);
        for (const char* bone : {"base", "middle", "top"})
            EXPECT_NEAR(weightOf(rig, bone), 8.0, 1e-5) << bone << hasMore;
    }
}

TEST(GltfDialect, SkinnedMeshMayBeInstanced) {
    GltfColumn
        column; // a sanitizer finds the bones that Assimp leaks for a mesh that is instanced twice
    const std::size_t again = column.node({{"name", "again"}, {"mesh", 0}, {"skin", 0}});
    column.json["scenes"][0]["nodes"].push_back(again);
    const osgSkin::ImportedRig rig = osgSkin::importRig(column.save("twice.gltf"));
    EXPECT_EQ(rig.body.mesh.positions.size(), 2 * kColumnVertices);
    for (const char* bone : {"base", "middle", "top"})
        EXPECT_NEAR(weightOf(rig, bone), 2.0 * 8, 1e-5) << bone;
}

TEST(GltfDialect, SceneMayBeMissing) {
    GltfColumn column;
    column.bend();
    column.json.erase("scene");
    column.json.erase("scenes");
    const osgSkin::ImportedRig rig = osgSkin::importRig(column.save("library.gltf"));
    EXPECT_EQ(rig.rest.joints.size(), 3u);
    EXPECT_EQ(rig.body.mesh.positions.size(), kColumnVertices);
    EXPECT_EQ(rig.animations.size(), 1u);
}

TEST(GltfDialect, IgnoresIncompleteTriangles) {
    // Points; lines as list, loop and strip; triangles as list, strip and fan.
    const std::size_t faces[7][5] = {{0, 0, 0, 0, 0}, {0, 0, 0, 0, 0}, {0, 0, 0, 0, 0},
                                     {0, 0, 0, 0, 0}, {0, 0, 0, 1, 1}, {0, 0, 0, 1, 2},
                                     {0, 0, 0, 1, 2}};
    for (std::size_t mode = 0; mode < 7; ++mode)
        for (std::size_t corners = 0; corners < 5; ++corners) {
            SCOPED_TRACE("mode " + std::to_string(mode) + ", " + std::to_string(corners));
            GltfColumn column;
            json primitive = primitiveOf(column);
            const std::size_t list = column.accessor("SCALAR", {0, 1, 2, 3}, 5121);
            column.json["accessors"][list]["count"] = corners;
            primitive["indices"] = list;
            primitive["mode"] = mode;
            column.json["meshes"][0]["primitives"].push_back(primitive);
            const std::string path = column.save("modes.gltf");
            const test::Notices notices;
            const osgSkin::ImportedMesh mesh = osgSkin::importMesh(path);
            EXPECT_EQ(mesh.mesh.faceSizes.size(), 36 + faces[mode][corners]);
            const bool isLeftOut = mode >= 4 && (corners < 3 || (mode == 4 && corners == 4));
            EXPECT_EQ(notices.say("incomplete triangles ignored in 1"), isLeftOut)
                << notices.text();
        }
}

TEST(BadGltf, RejectsSamplerForRotationAndTranslation) {
    GltfColumn column = moved("translation", {0, 1, 0, 0, 1, 0, 0, 1, 0});
    json& channels = column.json["animations"][0]["channels"];
    channels.push_back({{"sampler", 0}, {"target", {{"node", 2}, {"path", "rotation"}}}});
    expectRigRefused(column,
                     "animation \"move\": sampler 0: rotations and others, expected a sampler");
    channels[1]["target"]["path"] = "scale";
    EXPECT_EQ(osgSkin::importRig(column.save("shared.gltf")).animations.size(), 1u);
}

TEST(BadGltf, RejectsUnknownInterpolation) {
    for (const char* way : {"STEPPED", "linear", ""}) {
        GltfColumn column = moved("rotation", GltfColumn::turns({0, 60, 90}), way);
        expectRigRefused(column, "malformed glTF: animations[0].samplers.interpolation: expected "
                                 "LINEAR, STEP or CUBICSPLINE, found \"" +
                                     std::string(way) + '"');
    }
}

TEST(BadGltf, RejectsInvalidKeyValues) {
    for (const double number : {std::nan(""), 1e30, std::numeric_limits<double>::infinity()}) {
        const std::string where = "animation \"move\": sampler 0: accessors[6]: element 1 has ";
        for (const char* path : {"translation", "scale"}) {
            GltfColumn column = moved(path, {1, 1, 1, 1, number, 1, 1, 1, 1});
            expectRigRefused(column, where);
        }
        std::vector<double> turns = GltfColumn::turns({0, 60, 90});
        turns[6] = number;
        GltfColumn column = moved("rotation", turns);
        expectRigRefused(column, where);
    }
    GltfColumn column = moved("rotation", {0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 1});
    expectRigRefused(column, "animation \"move\": sampler 0: accessors[6]: element 1 is zero, "
                             "expected a rotation");
}

TEST(BadGltf, RejectsInfiniteBindMatrices) {
    for (const double number : {std::nan(""), 1e30}) {
        GltfColumn column;
        column.bend();
        std::vector<double> matrices(48, 0.0);
        for (std::size_t i = 0; i < matrices.size(); ++i)
            if (i % 16 % 5 == 0) matrices[i] = 1.0;
        matrices[20] = number;
        column.json["skins"][0]["inverseBindMatrices"] = column.accessor("MAT4", matrices);
        expectRigRefused(column,
                         "malformed glTF: accessors[9], skins[0].inverseBindMatrices: number "
                         "20 is ");
    }
}

/// Rotations of joints below negative scales are reversed, about mirrored axes.
TEST(GltfDialect, MotionsMayBeMirrored) {
    const glm::dvec3 scales[] = {{1, 1, 1},   {-1, 1, 1},  {1, -1, 1},  {1, 1, -1},
                                 {-1, -1, 1}, {1, -1, -1}, {-2, -2, -2}};
    for (const glm::dvec3& above : scales)
        for (const glm::dvec3& own : scales) {
            SCOPED_TRACE(testing::Message()
                         << above.x << above.y << above.z << " and " << own.x << own.y << own.z);
            GltfColumn column;
            column.json.erase("skins");
            column.json["nodes"][column.meshNode].erase("skin");
            const std::size_t root = column.node({{"name", "root"}, {"children", {0}}});
            column.json["nodes"][root]["scale"] = {above.x, above.y, above.z};
            column.json["nodes"][1]["scale"] = {own.x, own.y, own.z};
            column.json["scenes"][0]["nodes"] = {root, column.meshNode};
            const std::vector<double> turn = {0.36, 0.48, 0.0, 0.8};
            std::vector<double> keys = {0, 0, 0, 1};
            keys.insert(keys.end(), turn.begin(), turn.end());
            for (const std::size_t joint : column.joints)
                column.animate("turn", joint, "rotation", {0.0, 1.0}, keys);
            const osgSkin::Motion motion = osgSkin::importMotion(column.save("mirrored.gltf"));
            ASSERT_EQ(motion.skeleton.joints.size(), 3u);
            const glm::dquat local(turn[3], turn[0], turn[1], turn[2]);
            glm::dmat3 moved = glm::dmat3(glm::scale(glm::dmat4(1.0), above)), rest = moved;
            glm::dquat found(1.0, 0.0, 0.0, 0.0);
            for (std::size_t j = 0; j < 3; ++j) {
                moved = moved * glm::mat3_cast(local);
                found = found * motion.rotations[3 * (motion.frames - 1) + j];
                if (j == 1) moved = moved * glm::dmat3(glm::scale(glm::dmat4(1.0), own));
                if (j == 1) rest = rest * glm::dmat3(glm::scale(glm::dmat4(1.0), own));
                const glm::dmat3 expected = moved * glm::inverse(rest);
                const glm::dmat3 actual = glm::mat3_cast(found);
                for (int c = 0; c < 3; ++c)
                    EXPECT_LT(glm::length(expected[c] - actual[c]), 1e-5) << j;
            }
        }
}

TEST(GltfDialect, MatrixOverridesTranslation) {
    GltfColumn column;
    auto& shown = column.json["nodes"][column.meshNode];
    shown.erase("skin");
    const osgSkin::ImportedMesh plain = osgSkin::importMesh(column.save("plain.gltf"));
    shown["matrix"] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 2, 0, 1};
    shown["translation"] = {0, 5, 0};
    const test::Notices notices;
    const osgSkin::ImportedMesh mesh = osgSkin::importMesh(column.save("both.gltf"));
    EXPECT_TRUE(
        notices.say("both.gltf: 1 nodes have a matrix and a translation, rotation or scale"))
        << notices.text();
    ASSERT_EQ(mesh.mesh.positions.size(), plain.mesh.positions.size());
    EXPECT_NEAR(mesh.mesh.positions[0].y, plain.mesh.positions[0].y + 2.0, 1e-6);
}

TEST(GltfDialect, NormalisesNodeRotations) {
    const auto topOf = [](double length) {
        GltfColumn column;
        std::vector<double> rotation = GltfColumn::turn(50);
        for (double& number : rotation) number *= length;
        column.json["nodes"][column.joints[1]]["rotation"] = rotation;
        column.json.erase("skins"); // which would give the joints' bind positions
        column.json["nodes"][column.meshNode] = {{"name", "none"}};
        column.animate("move", column.joints[2], "translation", {0.0, 1.0}, {0, 1, 0, 0, 2, 0});
        column.animate("move", column.joints[0], "rotation", {0.0, 1.0}, GltfColumn::turns({0, 0}));
        return osgSkin::importSkeleton(column.save("unit.gltf")).joints.back().centre;
    };
    for (const double length : {0.99, 1.5, 1e-10, 1e10})
        EXPECT_LT(glm::distance(topOf(length), topOf(1.0)), 1e-6) << length;
}

TEST(GltfDialect, IgnoresUnknownChannelPaths) {
    for (const bool alone : {true, false}) {
        GltfColumn column = moved("rotation", {0, 0, 0, 1, 0, 0, 0.6, 0.8, 0, 0, 0, 1});
        auto& channels = column.json["animations"][0]["channels"];
        auto other = channels[0];
        other["target"] = {{"path", "pointer"}};
        channels.insert(channels.begin(), other);
        if (alone) channels.erase(1);
        const std::string path = column.save("pointer.gltf");
        const test::Notices notices;
        const osgSkin::ImportedRig rig = osgSkin::importRig(path);
        EXPECT_TRUE(notices.say("the first \"pointer\"")) << notices.text();
        EXPECT_EQ(rig.body.mesh.positions.size(), kColumnVertices);
        if (alone)
            expectError([&] { osgSkin::importMotion(path); }, path + ": ");
        else
            EXPECT_GT(osgSkin::importMotion(path).frames, 1u);
    }
}

/// Scale 0 hides things: the joint's matrix needs an inverse, or nothing would move.
TEST(GltfDialect, ClampsZeroScales) {
    GltfColumn column;
    column.animate("hide", column.joints[1], "scale", {0.0, 1.0, 2.0},
                   {1, 1, 1, 0, -0.0, 0, 1, 0.5, 1});
    const osgSkin::ImportedRig rig = osgSkin::importRig(column.save("hidden.gltf"));
    ASSERT_EQ(rig.animations.size(), 1u);
    std::size_t keys = 0;
    for (const auto& channel : rig.animations[0]->getChannels()) {
        const auto* scale = dynamic_cast<const osgAnimation::Vec3LinearChannel*>(channel.get());
        if (!scale || channel->getName() != "scale" || channel->getTargetName() != "middle")
            continue;
        for (const osgAnimation::Vec3Keyframe& key :
             *scale->getSamplerTyped()->getKeyframeContainerTyped())
            for (int axis = 0; axis < 3; ++axis, ++keys) {
                const float size = std::abs(key.getValue()[axis]);
                EXPECT_TRUE(size >= 0.5f || size == 1e-5f) << key.getTime() << ' ' << size;
            }
    }
    EXPECT_EQ(keys, 9u);
}

TEST(GltfDialect, JointsMayBeHiddenAtRest) {
    GltfColumn column;
    column.json["nodes"][column.joints[2]]["scale"] = {0, 0.0, -0.0};
    column.animate("show", column.joints[2], "scale", {0.0, 1.0}, {0, 0, 0, 1, 1, 1});
    const osgSkin::ImportedRig rig = osgSkin::importRig(column.save("shown.gltf"));
    const auto bones = test::findNodes<osgAnimation::Bone>(*rig.skeleton);
    ASSERT_EQ(bones.size(), 3u);
    EXPECT_NEAR(std::abs(bones[2].node->getMatrix()(0, 0)), 1e-5, 1e-9);
    EXPECT_TRUE(osg::Matrixd().invert(bones[2].node->getMatrixInSkeletonSpace()));
}

/// Exporters store nodes in the pose of the clip's first frame; the bind pose is the skin's, as
/// given by its mesh and matrices.
TEST(GltfDialect, BindPoseIgnoresThePosedRoot) {
    const struct {
        double degrees;
        double height;     ///< of the first joint
        double meshTurned; ///< of its node, degrees
        bool isPose;
    } cases[] = {{20.0, 0.0, 0.0, true},  {20.0, 1.0, 0.0, true},  {90.0, 1.0, 0.0, true},
                 {90.0, 0.0, 0.0, false}, {60.0, 0.0, 0.0, false}, {0.0, 1.0, 0.0, true},
                 {0.0, 1.0, 20.0, true},  {20.0, 1.0, 10.0, false}};
    for (const auto& c : cases) {
        GltfColumn column;
        const double half = glm::radians(c.degrees) / 2.0;
        column.json["nodes"][column.joints[0]]["rotation"] = {std::sin(half), 0, 0, std::cos(half)};
        column.json["nodes"][column.joints[0]]["translation"] = {0, c.height, 0};
        const double halfOfMesh = glm::radians(c.meshTurned) / 2.0;
        column.json["nodes"][column.meshNode]["rotation"] = {std::sin(halfOfMesh), 0, 0,
                                                             std::cos(halfOfMesh)};
        std::vector<double> matrices;
        for (int j = 0; j < 3; ++j)
            for (int k = 0; k < 16; ++k)
                matrices.push_back(k == 13 ? -(c.height + j) : k % 5 == 0 ? 1.0 : 0.0);
        column.json["skins"][0]["inverseBindMatrices"] = column.accessor("MAT4", matrices);
        const auto skeleton = osgSkin::importSkeleton(column.save("posed_root.gltf"));
        const glm::dvec3 top = skeleton.joints[2].centre - skeleton.joints[0].centre;
        EXPECT_EQ(glm::distance(top, {0, 2, 0}) < 1e-6, c.isPose)
            << c.degrees << " degrees, " << c.height << " above the origin: " << top.x << " "
            << top.y << " " << top.z;
    }
}

TEST(BadGltf, RejectsDuplicateJoints) {
    GltfColumn column;
    column.json["skins"][0]["joints"] = {0, 1, 1};
    expectRigRefused(column,
                     "malformed glTF: skins[0].joints: expected each node once, found 1 again");
}

TEST(GltfDialect, ReadsPointersToNodesAsChannels) {
    const auto clipOf = [](bool byPointer, const std::string& start) {
        GltfColumn column;
        column.bend();
        for (json& channel : column.json["animations"][0]["channels"]) {
            if (!byPointer) continue;
            const std::string node = channel["target"]["node"].dump();
            channel["target"] = {
                {"path", "pointer"},
                {"extensions",
                 {{"KHR_animation_pointer", {{"pointer", start + node + "/rotation"}}}}}};
        }
        column.json["extensionsUsed"] =
            column.json["extensionsRequired"] = {"KHR_animation_pointer"};
        return osgSkin::importMotion(column.save("pointer.gltf"));
    };
    const osgSkin::Motion plain = clipOf(false, ""), pointed = clipOf(true, "/nodes/");
    EXPECT_EQ(pointed.rotations, plain.rotations);
    expectError([&] { clipOf(true, "/cameras/"); }, "no animation");
}

TEST(GltfDialect, ReadsTheRolesOfVrmBones) {
    for (const bool isFirst : {true, false}) {
        GltfColumn column;
        json& extensions = column.json["extensions"];
        if (isFirst)
            extensions["VRM"]["humanoid"]["humanBones"] = {{{"bone", "hips"}, {"node", 0}},
                                                           {{"bone", "leftLowerArm"}, {"node", 2}}};
        else
            extensions["VRMC_vrm"]["humanoid"]["humanBones"] = {{"hips", {{"node", 0}}},
                                                                {"leftLowerArm", {{"node", 2}}}};
        const auto skeleton = osgSkin::importSkeleton(column.save("human.gltf"));
        ASSERT_EQ(skeleton.joints.size(), 3u);
        EXPECT_EQ(skeleton.joints[0].role, "Hips");
        EXPECT_EQ(skeleton.joints[1].role, "");
        EXPECT_EQ(skeleton.joints[2].role, "LeftLowerArm");
    }
}

/// As Blender exports an armature alone: nodes, without a skin or a clip.
TEST(GltfDialect, ReadsSkeletonOfNodesAlone) {
    GltfColumn column;
    column.json["meshes"].clear();
    column.json.erase("skins");
    column.json["nodes"].erase(column.meshNode);
    column.json["scenes"][0]["nodes"] = {0};
    const auto skeleton = osgSkin::importSkeleton(column.save("armature.gltf"));
    ASSERT_EQ(skeleton.joints.size(), 3u);
    EXPECT_EQ(skeleton.joints[2].name, "top");
    EXPECT_EQ(skeleton.joints[2].centre, glm::dvec3(0, 2, 0));
    // The same bones count where a clip moves one of them.
    column.json.erase("buffers"); // of the file without a clip
    column.animate("bend", column.joints[1], "rotation", {0.0, 1.0}, GltfColumn::turns({0, 60}));
    const auto moved = osgSkin::importSkeleton(column.save("bent.gltf"));
    ASSERT_EQ(moved.joints.size(), 3u);
    EXPECT_EQ(moved.joints[2].name, "top");
}

/// A talking head.
TEST(GltfDialect, FaceWithoutBonesIsARig) {
    const auto withoutSkin = [] {
        GltfColumn column;
        column.json.erase("skins");
        column.json["nodes"][column.meshNode].erase("skin");
        column.attributes().erase("JOINTS_0");
        column.attributes().erase("WEIGHTS_0");
        return column;
    };
    const std::string still = withoutSkin().save("statue.gltf");
    GltfColumn column = withoutSkin();
    column.json["meshes"][0]["primitives"][0]["targets"] = {{{"POSITION", column.positions}}};
    column.json["meshes"][0]["extras"]["targetNames"] = {"smile"};
    column.animate("talk", column.meshNode, "weights", {0.0, 1.0}, {0, 1});
    const osgSkin::ImportedRig rig = osgSkin::importRig(column.save("face.gltf"));
    EXPECT_EQ(rig.rest.joints.size(), 1u);
    ASSERT_EQ(rig.animations.size(), 1u);
    EXPECT_EQ(rig.animations[0]->getChannels().size(), 1u);
    expectError([&] { osgSkin::importRig(still); }, "no mesh with bones");
}

/// Draco packs a vertex into a byte or two, for which an uncompressed file has forty.
TEST(GltfDialect, LimitsKnowHowMuchDracoPacks) {
    GltfColumn column;
    const std::size_t packed = column.accessor("SCALAR", std::vector<double>(100'000), 5121);
    const json view = column.json["accessors"][packed]["bufferView"];
    for (const std::size_t accessor : {column.positions, column.weights, column.jointIndices}) {
        column.json["accessors"][accessor].erase("bufferView");
        column.json["accessors"][accessor]["count"] = 150'000;
    }
    const auto errorOf = [&column] {
        try {
            osgSkin::importRig(column.save("packed.gltf"));
        } catch (const osgSkin::Error& error) {
            return std::string(error.what());
        }
        return std::string();
    };
    column.json["accessors"][column.positions]["count"] = 1'500'000;
    EXPECT_NE(errorOf().find("maxSamples"), std::string::npos);
    primitiveOf(column)["extensions"]["KHR_draco_mesh_compression"] = {
        {"bufferView", view}, {"attributes", {{"POSITION", 0}}}};
    EXPECT_EQ(errorOf().find("maxSamples"), std::string::npos) << errorOf();
}

TEST(GltfDialect, ReportsClipsThatMoveNoJoint) {
    GltfColumn column;
    column.bend();
    const std::size_t proxy = column.node({{"name", "proxy"}});
    column.json["scenes"][0]["nodes"].push_back(proxy);
    column.animate("proxies", proxy, "rotation", {0.0, 1.0}, GltfColumn::turns({0, 90}));
    const test::Notices notices;
    EXPECT_EQ(osgSkin::importRig(column.save("proxies.gltf")).animations.size(), 1u);
    EXPECT_TRUE(notices.say("1 clips move no joint and no morph target, and are left out, "
                            "\"proxies\" among them"))
        << notices.text();
}
