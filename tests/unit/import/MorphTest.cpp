// SPDX-License-Identifier: MIT
//
// Morph targets of glTF files, expressions of VRM files, and blend shapes of FBX files.
#include "ExpectError.h"
#include "GltfBuilder.h"
#include "Notices.h"
#include "Paths.h"

#include <osgSkin/UpdateMorphs>
#include <osgSkinImport/ImportMesh>
#include <osgSkinImport/ImportMotion>
#include <osgSkinImport/ImportRig>
#include <osgSkinRig/FaceNames>
#include <osgSkinRig/Motion>

#include <osgAnimation/Channel>

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace {

using nlohmann::json;
using osgSkin::ImportedMesh;
using osgSkin::ImportedRig;
using osgSkin::MorphTarget;
using test::GltfColumn;

constexpr std::size_t kVertices = 24; ///< of a column

json& primitiveOf(GltfColumn& column) {
    return column.json["meshes"][0]["primitives"][0];
}

/// Offsets of a column's vertices that move one vertex.
std::vector<double> moving(std::size_t vertex, const glm::dvec3& offset) {
    std::vector<double> result(3 * kVertices, 0.0);
    for (std::size_t axis = 0; axis < 3; ++axis)
        result[3 * vertex + axis] = offset[static_cast<int>(axis)];
    return result;
}

/// Adds a morph target that moves one vertex; returns its index.
std::size_t addTarget(GltfColumn& column, const std::string& name, std::size_t vertex,
                      const glm::dvec3& offset) {
    json& targets = primitiveOf(column)["targets"];
    targets.push_back({{"POSITION", column.accessor("VEC3", moving(vertex, offset))}});
    column.json["meshes"][0]["extras"]["targetNames"].push_back(name);
    return targets.size() - 1;
}

/// A column with the target "wide", which moves vertex 3, and "tall", which moves vertex 20.
struct Face : GltfColumn {
    Face() {
        addTarget(*this, "wide", 3, {0.5, 0.0, 0.0});
        addTarget(*this, "tall", 20, {0.0, 0.25, 0.125});
    }
};

/// How far a target moves each vertex of the mesh. Its copies in the parts move alike.
std::map<std::uint32_t, glm::dvec3> offsetsOf(const ImportedMesh& mesh, const std::string& name) {
    std::map<std::uint32_t, glm::dvec3> result;
    for (const osgSkin::MeshPart& part : mesh.parts)
        for (const MorphTarget& target : part.morphs) {
            if (target.name != name) continue;
            for (std::size_t i = 0; i < target.vertices.size(); ++i) {
                const std::uint32_t vertex = part.sourceVertex.at(target.vertices[i]);
                const glm::dvec3 offset(target.positions.at(i));
                const auto [known, isNew] = result.emplace(vertex, offset);
                EXPECT_EQ(known->second, offset) << name << ", vertex " << vertex;
            }
            for (std::uint32_t v = 0; v < part.sourceVertex.size(); ++v) {
                const bool isListed =
                    std::binary_search(target.vertices.begin(), target.vertices.end(), v);
                EXPECT_EQ(isListed, result.count(part.sourceVertex[v]) > 0)
                    << name << ", copy " << v;
            }
        }
    return result;
}

std::vector<std::string> namesOf(const ImportedMesh& mesh) {
    std::vector<std::string> result;
    for (const osgSkin::MeshPart& part : mesh.parts)
        for (const MorphTarget& target : part.morphs) result.push_back(target.name);
    return result;
}

float initialOf(const ImportedMesh& mesh, const std::string& name) {
    for (const osgSkin::MeshPart& part : mesh.parts)
        for (const MorphTarget& target : part.morphs)
            if (target.name == name) return target.initial;
    ADD_FAILURE() << "no target " << name;
    return -1.0f;
}

void expectMoved(const ImportedMesh& mesh, const std::string& name,
                 const std::map<std::uint32_t, glm::dvec3>& expected) {
    const auto found = offsetsOf(mesh, name);
    ASSERT_EQ(found.size(), expected.size()) << name;
    for (const auto& [vertex, offset] : expected) {
        ASSERT_EQ(found.count(vertex), 1u) << name << ", vertex " << vertex;
        EXPECT_LT(glm::distance(found.at(vertex), offset), 1e-6) << name << ", vertex " << vertex;
    }
}

using FloatKeys = std::vector<std::pair<double, float>>;

/// The keys of a morph target in a clip; none if it has no channel.
FloatKeys keysOf(const osgAnimation::Animation& clip, const std::string& morph) {
    FloatKeys result;
    for (const auto& channel : clip.getChannels()) {
        if (channel->getTargetName() != osgSkin::UpdateMorphs::kName || channel->getName() != morph)
            continue;
        EXPECT_TRUE(result.empty()) << "two channels of " << morph;
        const auto& weights = dynamic_cast<const osgAnimation::FloatLinearChannel&>(*channel);
        for (const osgAnimation::FloatKeyframe& key :
             *weights.getSamplerTyped()->getKeyframeContainerTyped())
            result.emplace_back(key.getTime(), key.getValue());
    }
    return result;
}

float weightAt(const FloatKeys& keys, double time) {
    for (std::size_t k = 1; k < keys.size(); ++k)
        if (time <= keys[k].first) {
            const double share = (time - keys[k - 1].first) / (keys[k].first - keys[k - 1].first);
            return float((1.0 - share) * double(keys[k - 1].second) +
                         share * double(keys[k].second));
        }
    return keys.back().second;
}

} // namespace

TEST(GltfMorphs, ReadsOffsets) {
    Face face;
    const ImportedMesh mesh = osgSkin::importMesh(face.save("face.gltf"));
    EXPECT_EQ(namesOf(mesh), (std::vector<std::string>{"wide", "tall"}));
    expectMoved(mesh, "wide", {{3, {0.5, 0.0, 0.0}}});
    expectMoved(mesh, "tall", {{20, {0.0, 0.25, 0.125}}});
    EXPECT_EQ(initialOf(mesh, "wide"), 0.0f);
}

TEST(GltfMorphs, AppliesDefaultWeights) {
    Face face;
    face.json["meshes"][0]["weights"] = {0.25, 0.0};
    const ImportedMesh mesh = osgSkin::importMesh(face.save("default.gltf"));
    EXPECT_EQ(initialOf(mesh, "wide"), 0.25f);
    EXPECT_EQ(initialOf(mesh, "tall"), 0.0f);
    EXPECT_NEAR(mesh.mesh.positions[3].x, face.places[9] + 0.125, 1e-6);
    expectMoved(mesh, "wide", {{3, {0.5, 0.0, 0.0}}});
    face.json["nodes"][face.meshNode]["weights"] = {0.0, 0.5}; // in place of the mesh's
    const ImportedMesh own = osgSkin::importMesh(face.save("own.gltf"));
    EXPECT_EQ(initialOf(own, "wide"), 0.0f);
    EXPECT_EQ(initialOf(own, "tall"), 0.5f);
}

/// Sparse accessors list the vertices that move.
TEST(GltfMorphs, ReadsSparseTargets) {
    for (const bool isOrdered : {true, false}) {
        GltfColumn column;
        const std::vector<double> places =
            isOrdered ? std::vector<double>{3, 20, 21} : std::vector<double>{20, 3, 21};
        const std::size_t indices = column.accessor("SCALAR", places, 5123);
        const std::size_t values = column.accessor("VEC3", {1, 0, 0, 0, 2, 0, 0, 0, 0});
        json& accessors = column.json["accessors"];
        accessors.push_back(
            {{"type", "VEC3"},
             {"componentType", 5126},
             {"count", kVertices},
             {"sparse",
              {{"count", 3},
               {"indices",
                {{"bufferView", accessors[indices]["bufferView"]}, {"componentType", 5123}}},
               {"values", {{"bufferView", accessors[values]["bufferView"]}}}}}});
        primitiveOf(column)["targets"] = json::array({{{"POSITION", accessors.size() - 1}}});
        const ImportedMesh mesh = osgSkin::importMesh(column.save("sparse.gltf"));
        expectMoved(mesh, "column-0",
                    {{isOrdered ? 3u : 20u, {1, 0, 0}}, {isOrdered ? 20u : 3u, {0, 2, 0}}});
    }
}

TEST(GltfMorphs, ReadsQuantisedTargets) {
    GltfColumn column;
    primitiveOf(column)["targets"] = json::array(
        {{{"POSITION", column.accessor("VEC3", moving(5, {0.0, 1.0, 0.0}), 5120, true)}}});
    expectMoved(osgSkin::importMesh(column.save("quantised.gltf")), "column-0", {{5, {0, 1, 0}}});
}

TEST(GltfMorphs, IgnoresRoundingErrors) {
    GltfColumn column;
    std::vector<double> offsets(3 * kVertices, 1e-8);
    offsets[3 * 7] = 0.1;
    primitiveOf(column)["targets"] =
        json::array({{{"POSITION", column.accessor("VEC3", offsets)}}, json::object()});
    const ImportedMesh mesh = osgSkin::importMesh(column.save("rounded.gltf"));
    EXPECT_EQ(namesOf(mesh), (std::vector<std::string>{"column-0"})) << "the other moves nothing";
    EXPECT_EQ(offsetsOf(mesh, "column-0").size(), 1u);
}

/// A node that mirrors and scales its mesh, below a joint.
/// Such as Blender writes for a shape key that moves nothing.
TEST(GltfMorphs, ReportsTargetsThatMoveNothing) {
    Face face;
    face.json["accessors"].push_back(
        {{"componentType", 5126}, {"count", kVertices}, {"type", "VEC3"}});
    primitiveOf(face)["targets"].push_back({{"POSITION", face.json["accessors"].size() - 1}});
    face.json["meshes"][0]["extras"]["targetNames"].push_back("still");
    const test::Notices notices;
    const ImportedRig rig = osgSkin::importRig(face.save("still_morph.gltf"));
    EXPECT_EQ(namesOf(rig.body), (std::vector<std::string>{"wide", "tall"}));
    EXPECT_TRUE(notices.say("morph target \"still\" moves no vertex; left out")) << notices.text();
}

TEST(GltfMorphs, TransformsOffsets) {
    Face face;
    json& node = face.json["nodes"][face.meshNode];
    node.erase("skin");
    node["scale"] = {-2.0, 3.0, 1.0};
    node["rotation"] = GltfColumn::turn(90.0);
    node["translation"] = {5.0, 0.0, 0.0};
    std::vector<double> normals, turned(3 * kVertices, 0.0);
    for (std::size_t v = 0; v < kVertices; ++v) {
        normals.insert(normals.end(), {1.0, 0.0, 0.0});
        turned[3 * v + 1] = 1.0;
    }
    face.attributes()["NORMAL"] = face.accessor("VEC3", normals);
    primitiveOf(face)["targets"][1]["NORMAL"] = face.accessor("VEC3", turned);
    const ImportedMesh mesh = osgSkin::importMesh(face.save("mirrored.gltf"));
    expectMoved(mesh, "wide", {{3, {-1.0, 0.0, 0.0}}});
    const auto tall = offsetsOf(mesh, "tall");
    ASSERT_EQ(tall.size(), kVertices) << "their normals turn";
    EXPECT_LT(glm::distance(tall.at(20), glm::dvec3(0.0, -0.125, 0.75)), 1e-6);
    EXPECT_LT(glm::length(tall.at(4)), 1e-6);
    // Normals become (-1/2, 0, 0) + weight * (0, 0, 1/3) before they are of unit length.
    for (const osgSkin::MeshPart& part : mesh.parts)
        for (const MorphTarget& target : part.morphs)
            for (const glm::vec3& change : target.normals)
                EXPECT_LT(glm::distance(glm::dvec3(change), glm::dvec3(0.0, 0.0, 2.0 / 3.0)), 1e-5);
}

/// Two meshes of one skeleton, one of them bound in another pose: all vertices are brought to one
/// pose, and their offsets are the difference between the file's shapes in it.
TEST(GltfMorphs, OffsetsAreInTheCommonBindPose) {
    Face face;
    face.json["meshes"].push_back(face.json["meshes"][0]);
    std::vector<double> matrices;
    for (std::size_t j = 0; j < 3; ++j) { // the top is turned by 30 degrees about x
        const double angle = j == 2 ? std::acos(-1.0) / 6.0 : 0.0;
        const double c = std::cos(angle), s = std::sin(angle), y = -double(j);
        matrices.insert(matrices.end(), {1, 0, 0, 0, 0, c, s, 0, 0, -s, c, 0, 0, c * y, s * y, 1});
    }
    face.json["skins"].push_back(face.json["skins"][0]);
    face.json["skins"][1]["inverseBindMatrices"] = face.accessor("MAT4", matrices);
    face.json["scenes"][0]["nodes"].push_back(face.node({{"mesh", 1}, {"skin", 1}}));
    const ImportedMesh rest = osgSkin::importMesh(face.save("poses.gltf"));
    for (json& mesh : face.json["meshes"]) mesh["weights"] = {1.0, 1.0};
    const ImportedMesh whole = osgSkin::importMesh(face.save("poses_whole.gltf"));
    ASSERT_EQ(whole.mesh.positions.size(), 2 * kVertices);
    auto offsets = offsetsOf(rest, "wide");
    offsets.merge(offsetsOf(rest, "tall"));
    EXPECT_EQ(offsets.size(), 4u);
    for (std::uint32_t v = 0; v < 2 * kVertices; ++v) {
        const glm::dvec3 moved = whole.mesh.positions[v] - rest.mesh.positions[v];
        EXPECT_LT(glm::distance(moved, offsets[v]), 1e-6) << v;
    }
    EXPECT_GT(glm::distance(offsets[20], offsets[kVertices + 20]), 0.05) << "turned";
}

/// Exporters split meshes by material, and faces have teeth and lashes of their own.
TEST(GltfMorphs, MergesTargetsOfOneName) {
    Face face;
    json teeth = face.json["meshes"][0];
    teeth["extras"]["targetNames"] = {"tall", "closed"};
    face.json["meshes"].push_back(teeth);
    face.json["scenes"][0]["nodes"].push_back(face.node({{"mesh", 1}, {"skin", 0}}));
    const test::Notices notices;
    const ImportedMesh mesh = osgSkin::importMesh(face.save("teeth.gltf"));
    EXPECT_EQ(namesOf(mesh), (std::vector<std::string>{"wide", "tall", "closed"}));
    expectMoved(mesh, "tall", {{20, {0.0, 0.25, 0.125}}, {kVertices + 3, {0.5, 0.0, 0.0}}});
    EXPECT_EQ(notices.lines(), 0u) << notices.text();
}

TEST(GltfMorphs, KeepsTargetsWithDifferentInitialWeights) {
    Face face;
    json teeth = face.json["meshes"][0];
    teeth["weights"] = {0.5, 0.0};
    face.json["meshes"].push_back(teeth);
    face.json["scenes"][0]["nodes"].push_back(face.node({{"mesh", 1}, {"skin", 0}}));
    const test::Notices notices;
    const ImportedMesh mesh = osgSkin::importMesh(face.save("apart.gltf"));
    EXPECT_EQ(initialOf(mesh, "wide"), 0.0f);
    EXPECT_EQ(initialOf(mesh, "wide.001"), 0.5f);
    EXPECT_EQ(offsetsOf(mesh, "tall").size(), 2u);
    EXPECT_TRUE(notices.say("1 were renamed, the first to \"wide.001\"")) << notices.text();
}

TEST(GltfMorphs, NamesMayBeMissingOrTheSame) {
    Face face;
    face.json["meshes"][0]["extras"]["targetNames"] = {"smile", "smile"};
    EXPECT_EQ(namesOf(osgSkin::importMesh(face.save("twice.gltf"))),
              (std::vector<std::string>{"smile", "smile.001"}));
    face.json["meshes"][0]["extras"]["targetNames"] = {7, ""};
    EXPECT_EQ(namesOf(osgSkin::importMesh(face.save("none.gltf"))),
              (std::vector<std::string>{"column-0", "column-1"}));
    face.json["meshes"][0].erase("extras");
    primitiveOf(face)["extras"]["targetNames"] = {"a", "b"};
    EXPECT_EQ(namesOf(osgSkin::importMesh(face.save("primitive.gltf"))),
              (std::vector<std::string>{"a", "b"}));
}

TEST(GltfMorphs, RejectsInfiniteOffsets) {
    Face face;
    addTarget(face, "broken", 4, {0.0, HUGE_VAL, 0.0});
    const std::string path = face.save("broken.gltf");
    expectError([&] { osgSkin::importMesh(path); },
                path + ": morph target \"broken\": its offset of vertex 4 is not finite");
}

TEST(VrmExpressions, BecomeMorphTargets) {
    for (const bool isSecond : {true, false}) {
        Face face;
        addTarget(face, "happy", 8, {0.0, 0.0, 1.0});
        json bind = {{isSecond ? "node" : "mesh", isSecond ? face.meshNode : 0}};
        const double whole = isSecond ? 1.0 : 100.0;
        json wide = bind, tall = bind;
        wide.update({{"index", 0}, {"weight", 0.5 * whole}});
        tall.update({{"index", 1}, {"weight", whole}});
        if (isSecond)
            face.json["extensions"]["VRMC_vrm"]["expressions"] = {
                {"preset",
                 {{"happy", {{"morphTargetBinds", {wide, tall}}}},
                  {"neutral", {{"isBinary", false}}}}},
                {"custom",
                 {{"grin",
                   {{"morphTargetBinds", json::array({wide})},
                    {"materialColorBinds", json::array({1})}}}}}};
        else
            face.json["extensions"]["VRM"]["blendShapeMaster"]["blendShapeGroups"] = {
                {{"name", "Happy"}, {"presetName", "happy"}, {"binds", {wide, tall}}},
                {{"name", "grin"},
                 {"presetName", "unknown"},
                 {"binds", json::array({wide})},
                 {"materialValues", json::array({1})}}};
        const test::Notices notices;
        const ImportedMesh mesh = osgSkin::importMesh(face.save("avatar.vrm"));
        EXPECT_EQ(namesOf(mesh),
                  (std::vector<std::string>{"wide", "tall", "happy.001", "happy", "grin"}));
        expectMoved(mesh, "happy", {{3, {0.25, 0.0, 0.0}}, {20, {0.0, 0.25, 0.125}}});
        expectMoved(mesh, "grin", {{3, {0.25, 0.0, 0.0}}});
        expectMoved(mesh, "happy.001", {{8, {0.0, 0.0, 1.0}}});
        const auto joy = osgSkin::matchFace({"joy"}, namesOf(mesh)).at(0);
        EXPECT_EQ(joy.parts.at(0).morphs.at(0), "happy") << "before the mesh's own";
        EXPECT_TRUE(notices.say("the first to \"happy.001\"")) << notices.text();
        EXPECT_TRUE(notices.say("1 expressions change colours or textures"));
        EXPECT_EQ(notices.lines(), 2u) << notices.text();
    }
}

TEST(VrmExpressions, IgnoresInvalidParts) {
    Face face;
    face.json["extensions"]["VRMC_vrm"]["expressions"]["preset"]["happy"]["morphTargetBinds"] = {
        {{"node", face.meshNode}, {"index", 2}, {"weight", 1.0}},
        {{"node", 0}, {"index", 0}, {"weight", 1.0}},
        {{"node", face.meshNode}, {"index", 0}},
        {{"node", -1}, {"index", 0}, {"weight", 1.0}},
        "smile",
        {{"node", face.meshNode}, {"index", 1}, {"weight", 1.0}}};
    const test::Notices notices;
    const ImportedMesh mesh = osgSkin::importMesh(face.save("parts.vrm"));
    EXPECT_TRUE(notices.say("5 parts of expressions name no morph target")) << notices.text();
    expectMoved(mesh, "happy", {{20, {0.0, 0.25, 0.125}}});
}

TEST(GltfMorphs, ClipsAnimateWeights) {
    Face face;
    face.bend();
    face.animate("talk", face.meshNode, "weights", {0.0, 1.0}, {0.0, 0.5, 1.0, 0.5});
    face.animate("blink", face.meshNode, "weights", {0.0, 1.0, 2.0}, {0, 0, 1, 1, 0, 0}, "STEP");
    const test::Notices notices;
    const ImportedRig rig = osgSkin::importRig(face.save("talk.gltf"));
    EXPECT_EQ(notices.lines(), 0u) << notices.text();
    ASSERT_EQ(rig.animations.size(), 3u) << "a clip of the face alone is a clip";
    const osgAnimation::Animation &bend = *rig.animations[0], &talk = *rig.animations[1],
                                  &blink = *rig.animations[2];
    EXPECT_EQ(keysOf(talk, "wide"), (FloatKeys{{0.0, 0.0f}, {1.0, 1.0f}}));
    EXPECT_EQ(keysOf(talk, "tall"), (FloatKeys{{0.0, 0.5f}})) << "constant";
    EXPECT_EQ(keysOf(bend, "wide"), (FloatKeys{{0.0, 0.0f}})) << "holds its weight at rest";
    const FloatKeys steps = keysOf(blink, "wide");
    for (const auto& [time, weight] :
         std::map<double, float>{{0.0, 0.0f}, {0.9, 0.0f}, {1.0, 1.0f}, {1.9, 1.0f}, {2.0, 0.0f}})
        EXPECT_NEAR(weightAt(steps, time), weight, 1e-5) << time;
    EXPECT_EQ(talk.getDuration(), 1.0);
}

TEST(GltfMorphs, SplinesAnimateWeights) {
    Face face;
    // In-tangents, values and out-tangents of both targets, key by key.
    face.animate("talk", face.meshNode, "weights", {0.0, 1.0},
                 {0, 0, 0, 1, 1, 0, /**/ 1, 0, 1, 1, 0, 0}, "CUBICSPLINE");
    const ImportedRig rig = osgSkin::importRig(face.save("spline.gltf"));
    ASSERT_EQ(rig.animations.size(), 1u);
    const FloatKeys wide = keysOf(*rig.animations[0], "wide");
    ASSERT_GT(wide.size(), 20u);
    for (const auto& [time, weight] : wide) EXPECT_NEAR(weight, time, 1e-6); // a straight line
    EXPECT_EQ(keysOf(*rig.animations[0], "tall"), (FloatKeys{{0.0, 1.0f}}));
}

TEST(GltfMorphs, StaticTargetsHaveNoChannels) {
    Face face;
    face.bend();
    face.json["meshes"][0]["weights"] = {0.5, 0.0};
    face.animate("bend", face.meshNode, "weights", {0.0, 1.0}, {0.5, 0.0, 0.5, 0.0});
    const ImportedRig rig = osgSkin::importRig(face.save("still.gltf"));
    ASSERT_EQ(rig.animations.size(), 1u);
    EXPECT_TRUE(keysOf(*rig.animations[0], "wide").empty());
    EXPECT_TRUE(keysOf(*rig.animations[0], "tall").empty());
}

TEST(GltfMorphs, RejectsWrongNumberOfWeights) {
    Face face;
    face.animate("talk", face.meshNode, "weights", {0.0, 1.0}, {0.0, 0.5, 1.0});
    const std::string path = face.save("short.gltf");
    expectError([&] { osgSkin::importRig(path); },
                path + ": animation \"talk\": sampler 0: 2 keys and 3 values, expected 2 numbers");
}

TEST(GltfMorphs, MeshesMoveByTheirOwnWeights) {
    Face face;
    face.json["meshes"].push_back(face.json["meshes"][0]);
    const std::size_t teeth = face.node({{"mesh", 1}, {"skin", 0}});
    face.json["scenes"][0]["nodes"].push_back(teeth);
    face.animate("talk", face.meshNode, "weights", {0.0, 1.0}, {0, 0, 1, 1});
    face.animate("talk", teeth, "weights", {0.0, 1.0}, {0, 0, 0, 1});
    const test::Notices notices;
    const ImportedRig rig = osgSkin::importRig(face.save("torn.gltf"));
    EXPECT_EQ(keysOf(*rig.animations.at(0), "wide"), (FloatKeys{{0.0, 0.0f}, {1.0, 1.0f}}));
    const std::vector<std::string> names = namesOf(rig.body);
    EXPECT_EQ(std::set<std::string>(names.begin(), names.end()).size(), 3u);
    EXPECT_TRUE(keysOf(*rig.animations.at(0), "wide.001").empty()) << "stays 0";
    EXPECT_TRUE(notices.say("move differently; renamed: \"wide.001\"")) << notices.text();
}

TEST(GltfMorphs, MotionMayMoveAFaceAlone) {
    Face face;
    face.animate("talk", face.meshNode, "weights", {0.0, 1.0}, {0, 0, 1, 1});
    const osgSkin::Motion motion = osgSkin::importMotion(face.save("talk_only.gltf"));
    ASSERT_EQ(motion.frames, 31u);
    ASSERT_EQ(motion.morphs.size(), 2u);
    for (const auto& [morph, weights] : motion.morphs) {
        ASSERT_EQ(weights.size(), 31u) << morph;
        EXPECT_EQ(weights.front(), 0.0f) << morph;
        EXPECT_NEAR(double(weights[15]), 0.5, 1e-6) << morph;
        EXPECT_EQ(weights.back(), 1.0f) << morph;
    }
}

/// A square that follows one joint, with two shapes and a clip of one of them.
TEST(FbxMorphs, ReadsShapes) {
    const test::Notices notices;
    const ImportedRig rig = osgSkin::importRig(testData("rig/shapes.fbx"));
    EXPECT_EQ(notices.lines(), 0u) << notices.text();
    // Assimp 5.4 keeps channels in a set of pointers, in any order.
    std::vector<std::string> names = namesOf(rig.body);
    std::sort(names.begin(), names.end());
    EXPECT_EQ(names, (std::vector<std::string>{"tall", "wide"}));
    const auto wide = offsetsOf(rig.body, "wide"), tall = offsetsOf(rig.body, "tall");
    EXPECT_EQ(wide.size(), 2u);
    EXPECT_EQ(tall.size(), 1u);
    for (const auto& [vertex, offset] : wide) {
        const glm::dvec3& place = rig.body.mesh.positions[vertex];
        EXPECT_LT(glm::distance(offset, glm::dvec3(place.y > 0.5 ? 0.25 : 0.5, 0.0, 0.0)), 1e-6);
    }
    for (const auto& [vertex, offset] : tall)
        EXPECT_LT(glm::distance(offset, glm::dvec3(0.0, 1.0, 0.0)), 1e-6);
    ASSERT_EQ(rig.animations.size(), 1u);
    EXPECT_EQ(keysOf(*rig.animations[0], "tall"),
              (FloatKeys{{0.0, 0.0f}, {0.5, 1.0f}, {1.0, 0.5f}}));
    EXPECT_TRUE(keysOf(*rig.animations[0], "wide").empty());
}

/// A second square has shapes of the same names, and a curve of its own.
TEST(FbxMorphs, MeshesMoveByTheirOwnCurves) {
    const ImportedRig rig = osgSkin::importRig(testData("rig/two_shapes.fbx"));
    ASSERT_EQ(rig.animations.size(), 1u);
    const std::vector<std::string> all = namesOf(rig.body);
    const std::set<std::string> names(all.begin(), all.end());
    EXPECT_EQ(names.size(), 3u) << "no curve moves the shapes \"wide\", so they are one";
    std::set<float> middles;
    for (const std::string& name : names)
        for (const auto& [time, weight] : keysOf(*rig.animations[0], name))
            if (time == 0.5) middles.insert(weight);
    EXPECT_EQ(middles, (std::set<float>{0.9f, 1.0f}));
}

/// Two nodes show one mesh, as a face and its mirror image.
TEST(MorphTracks, NodesOfOneMeshMoveByTheirOwn) {
    test::GltfColumn face;
    face.json.erase("skins");
    face.json["nodes"][face.meshNode].erase("skin");
    face.json["meshes"][0]["primitives"][0]["targets"] = {
        {{"POSITION", face.accessor("VEC3", std::vector<double>(face.places.size(), 0.1))}}};
    const std::size_t other = face.node({{"name", "other"}, {"mesh", 0}});
    face.json["scenes"][0]["nodes"].push_back(other);
    face.animate("talk", face.meshNode, "weights", {0.0, 1.0}, {0.0, 1.0});
    face.animate("talk", other, "weights", {0.0, 1.0}, {0.0, 0.5});
    const test::Notices notices;
    const ImportedRig rig = osgSkin::importRig(face.save("two_faces.gltf"));
    EXPECT_TRUE(notices.say("move differently; renamed: \"")) << notices.text();
    std::set<float> ends;
    for (const std::string& name : namesOf(rig.body))
        for (const auto& [time, weight] : keysOf(*rig.animations.at(0), name))
            if (time == 1.0) ends.insert(weight);
    EXPECT_EQ(ends, (std::set<float>{0.5f, 1.0f}));
}
