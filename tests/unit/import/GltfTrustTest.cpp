// SPDX-License-Identifier: MIT
//
// glTF files whose indices are out of range, and every allowed location of a buffer.
//
// glTF files that are broken as a whole, or of another version: each error names the location.
#include "ExpectError.h"
#include "Glb.h"
#include "GltfBuilder.h"
#include "Notices.h"
#include "Paths.h"
#include "TextFile.h"

#include <osgSkinImport/ImportMesh>
#include <osgSkinImport/ImportRig>

#include <osgAnimation/Channel>
#include <osgDB/Options>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <ctime>
#include <fstream>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#ifndef _WIN32
#include <sys/resource.h>
#endif

namespace {

using nlohmann::json;
using test::GltfColumn;
using test::saveText;

/// Vertex indices of the column's faces.
std::vector<double> indices() {
    std::vector<double> result;
    for (int j = 0; j < 3; ++j)
        for (const int corner : {0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6})
            result.push_back(8.0 * j + corner);
    return result;
}

void expectMeshRefused(GltfColumn& column, const std::string& message) {
    const std::string path = column.save("untrue.gltf");
    expectError([&] { osgSkin::importMesh(path); }, path + ": " + message);
    expectError([&] { osgSkin::importRig(path); }, path + ": " + message);
}

/// A column with some joint indices and weights changed; the first joint's come first.
void expectWeights(const std::vector<double>& joints, const std::vector<double>& weights,
                   const std::string& message, bool normalized = false) {
    GltfColumn column;
    constexpr std::size_t kVertices = 24, kChanged = 5;
    std::vector<double> allJoints(4 * kVertices, 0.0), allWeights(4 * kVertices, 0.0);
    for (std::size_t v = 0; v < kVertices; ++v) {
        const std::size_t ring = v / 8;
        allJoints[4 * v] = double(ring);
        allWeights[4 * v] = 1.0;
    }
    for (std::size_t k = 0; k < 4; ++k) {
        allJoints[4 * kChanged + k] = joints[k];
        allWeights[4 * kChanged + k] = weights[k];
    }
    column.attributes()["JOINTS_0"] = column.accessor("VEC4", allJoints, 5121);
    column.json["accessors"].back()["normalized"] = normalized;
    column.attributes()["WEIGHTS_0"] = column.accessor("VEC4", allWeights);
    if (!message.empty()) return expectMeshRefused(column, message);
    const osgSkin::ImportedRig rig = osgSkin::importRig(column.save("true.gltf"));
    ASSERT_EQ(rig.body.weights.size(), 3u);
    double weight = 0.0;
    for (const osgSkin::BoneWeights::Entry& entry : rig.body.weights[0].entries)
        if (entry.vertex == 5) weight += entry.weight;
    EXPECT_NEAR(weight, 1.0, 1e-6);
}

std::string escaped(const std::string& bytes) {
    static const char* const digits = "0123456789aBcDeF";
    std::string result;
    for (const char c : bytes) {
        const auto byte = static_cast<std::uint8_t>(c);
        result += {'%', digits[byte >> 4], digits[byte & 15]};
    }
    return result;
}

/// Peak memory of this program, MB; 0 on Windows.
long peakMegabytes() {
#ifdef _WIN32
    return 0;
#else
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return usage.ru_maxrss / 1024;
#endif
}

void expectColumn(const std::string& path) {
    const std::vector<double> known = GltfColumn().places;
    const osgSkin::ImportedMesh found = osgSkin::importMesh(path);
    ASSERT_EQ(found.mesh.positions.size(), known.size() / 3) << path;
    ASSERT_EQ(found.mesh.faceSizes.size(), 36u) << path;
    for (std::size_t v = 0; v < found.mesh.positions.size(); ++v)
        for (int axis = 0; axis < 3; ++axis)
            EXPECT_NEAR(found.mesh.positions[v][axis], known[3 * v + std::size_t(axis)], 1e-6);
}

} // namespace

TEST(BadGltf, RejectsIndicesOutOfRange) {
    for (const int beyond : {24, 65535}) {
        GltfColumn column;
        std::vector<double> corners = indices();
        corners[5] = beyond;
        column.json["meshes"][0]["primitives"][0]["indices"] =
            column.accessor("SCALAR", corners, 5123);
        column.json["accessors"].back()["normalized"] = beyond > 24; // which has no meaning here
        expectMeshRefused(column, "malformed glTF: accessors[5], meshes[0].primitives[0].indices: "
                                  "number 5 is " +
                                      std::to_string(beyond) + ", expected a vertex below 24");
    }
}

TEST(BadGltf, RejectsInvalidJointsAndWeights) {
    const std::string primitive = ", meshes[0].primitives[0].";
    expectWeights(
        {0, 3, 0, 0}, {0.5, 0.5, 0, 0},
        "malformed glTF: accessors[5]" + primitive +
            "JOINTS_0: vertex 5 follows joint 3, expected one of the 3 that the skin has");
    expectWeights({0, 3, 0, 0}, {0.5, 0.5, 0, 0},
                  "malformed glTF: accessors[5]" + primitive + "JOINTS_0: vertex 5 follows joint 3",
                  true); // which has no meaning here
    expectWeights({0, 0, 0, 0}, {std::nan(""), 0, 0, 0},
                  "malformed glTF: accessors[6]" + primitive +
                      "WEIGHTS_0: vertex 5 has the weight nan, expected a number of 0 or more");
    expectWeights({0, 1, 0, 0}, {1.5, -0.5, 0, 0},
                  "malformed glTF: accessors[6]" + primitive +
                      "WEIGHTS_0: vertex 5 has the weight -0.5");
    // Exporters write these: unused joints, and rounding errors.
    expectWeights({0, 200, 0, 0}, {1, 0, 0, 0}, "");
    expectWeights({0, 200, 1, 0}, {1, 0, -1e-8, 0}, "");
}

TEST(BadGltf, RejectsMoreThanFourJointSets) {
    GltfColumn column;
    json& attributes = column.json["meshes"][0]["primitives"][0]["attributes"];
    attributes["JOINTS_4"] = attributes["POSITION"];
    expectMeshRefused(column,
                      "malformed glTF: meshes[0].primitives[0].JOINTS_4: expected four sets "
                      "of joints and weights at most");
}

/// A mesh that two nodes instance, only one of which animates it.
TEST(GltfMorphs, NodeWeightsOverrideTheMesh) {
    for (const bool first : {true, false}) {
        GltfColumn column;
        std::vector<double> up(column.places.size(), 0.0);
        for (std::size_t v = 0; v < up.size() / 3; ++v) up[3 * v + 1] = 100.0;
        column.json["meshes"][0]["primitives"][0]["targets"] =
            json::array({{{"POSITION", column.accessor("VEC3", up)}}});
        json other;
        for (json& node : column.json["nodes"])
            if (node.contains("mesh")) {
                node.erase("skin");
                other = {{"mesh", node["mesh"]}, {"name", "other"}};
                (first ? node : other)["weights"] = {1.0};
            }
        column.json["scenes"][0]["nodes"].push_back(column.node(other));
        const osgSkin::ImportedMesh mesh = osgSkin::importMesh(column.save("weights.gltf"));
        ASSERT_EQ(mesh.mesh.positions.size(), 2 * up.size() / 3);
        std::size_t moved = 0;
        for (const glm::dvec3& p : mesh.mesh.positions) moved += p.y > 50.0 ? 1u : 0u;
        EXPECT_EQ(moved, up.size() / 3) << first;
    }
}

/// Like exporters that write a body with several materials: one list of vertices for all
/// primitives.
TEST(GltfMeshes, DropsUnusedSharedVertices) {
    GltfColumn column;
    json& primitives = column.json["meshes"][0]["primitives"];
    json other = primitives[0];
    primitives[0]["indices"] = column.accessor("SCALAR", {0, 2, 1, 1, 2, 3, 17, 5, 6}, 5123);
    other["indices"] = column.accessor("SCALAR", {8, 10, 9, 23, 17, 18}, 5123);
    primitives.push_back(other);
    const osgSkin::ImportedMesh body = osgSkin::importRig(column.save("shared.gltf")).body;
    const std::vector<std::uint32_t> used = {0, 1, 2, 3, 5, 6, 17, 8, 9, 10, 17, 18, 23};
    ASSERT_EQ(body.mesh.positions.size(), used.size());
    for (std::size_t v = 0; v < used.size(); ++v)
        for (int k = 0; k < 3; ++k)
            EXPECT_NEAR(body.mesh.positions[v][k], column.places[3 * used[v] + unsigned(k)], 1e-6)
                << v;
    EXPECT_EQ(body.mesh.faceVertices,
              (std::vector<std::uint32_t>{0, 2, 1, 1, 2, 3, 6, 4, 5, 7, 9, 8, 12, 10, 11}));
    std::vector<std::string> boneOf(used.size());
    for (const osgSkin::BoneWeights& bone : body.weights)
        for (const osgSkin::BoneWeights::Entry& entry : bone.entries) {
            ASSERT_LT(entry.vertex, used.size());
            if (entry.weight > 0.5) boneOf[entry.vertex] = bone.bone;
        }
    const char* const names[] = {"base", "middle", "top"};
    for (std::size_t v = 0; v < used.size(); ++v) EXPECT_EQ(boneOf[v], names[used[v] / 8]) << v;
}

/// Each vertex of each primitive takes memory, however few bytes describe it.
TEST(BadGltf, LimitsPrimitivesThatShareVertices) {
    GltfColumn column;
    json& primitives = column.json["meshes"][0]["primitives"];
    const json one = {
        {"attributes", {{"POSITION", column.accessor("VEC3", std::vector<double>(900))}}}};
    for (int copy = 0; copy < 1600; ++copy) primitives.push_back(one);
    const std::string path = column.save("repeated.gltf");
    expectError([&] { osgSkin::importMesh(path); },
                "expected fewer vertices, corners and keys for the file's size");
    const osg::ref_ptr<osgDB::Options> more = new osgDB::Options("maxSamples=9000000");
    EXPECT_EQ(osgSkin::importMesh(path, more).mesh.positions.size(), 24u + 1600u * 300u);
}

TEST(GltfSkins, WarnsAboutSingularBindMatrices) {
    for (const bool flat : {false, true}) {
        GltfColumn column;
        std::vector<double> matrices;
        for (int joint = 0; joint < 3; ++joint)
            for (int i = 0; i < 16; ++i)
                matrices.push_back(i == 13 ? -joint : i % 5 == 0 ? 1.0 : 0.0);
        if (flat) matrices[16 + 5] = 0.0;
        column.json["skins"][0]["inverseBindMatrices"] = column.accessor("MAT4", matrices);
        const std::string path = column.save("flat.gltf");
        const test::Notices notices;
        const osgSkin::ImportedRig rig = osgSkin::importRig(path);
        EXPECT_EQ(notices.say("has 1 singular inverse bind matrices"), flat);
        EXPECT_EQ(rig.body.mesh.positions.size(), 24u);
    }
}

TEST(GltfAnimations, LastOfDuplicateChannelsWins) {
    const std::vector<double> half = {0, 0, 0, 1, 0, 0, std::sqrt(0.5), std::sqrt(0.5)};
    const std::vector<double> none = {0, 0, 0, 1, 0, 0, 0, 1};
    for (const bool twice : {false, true}) {
        GltfColumn column;
        if (twice) column.animate("bend", column.joints[1], "rotation", {0, 1}, none);
        column.animate("bend", column.joints[1], "rotation", {0, 1}, half);
        column.animate("bend", column.joints[2], "rotation", {0, 1}, none);
        const test::Notices notices;
        const osgSkin::ImportedRig rig = osgSkin::importRig(column.save("twice.gltf"));
        EXPECT_EQ(notices.say("the last is used, 1 are ignored"), twice);
        ASSERT_EQ(rig.animations.size(), 1u);
        double turned = 0.0;
        for (const auto& channel : rig.animations[0]->getChannels()) {
            const auto* rotation =
                dynamic_cast<const osgAnimation::QuatSphericalLinearChannel*>(channel.get());
            if (rotation != nullptr && channel->getTargetName() == "middle")
                turned = std::abs(rotation->getSamplerTyped()
                                      ->getKeyframeContainerTyped()
                                      ->back()
                                      .getValue()
                                      .z());
        }
        EXPECT_NEAR(turned, std::sqrt(0.5), 1e-5);
    }
}

TEST(BadGltf, RejectsDecreasingKeyTimes) {
    const auto moved = [](const std::vector<double>& times, const char* interpolation) {
        GltfColumn column;
        column.animate("bend", 1, "rotation", times, GltfColumn::turns({0, 60, 90}), interpolation);
        return column;
    };
    for (const char* interpolation : {"LINEAR", "STEP"}) {
        const std::string where = testing::TempDir() + "back.gltf: animation \"bend\": sampler 0: ";
        for (const double back : {0.4, std::nan("")}) {
            GltfColumn column = moved({0.0, 0.5, back}, interpolation);
            const std::string path = column.save("back.gltf");
            expectError([&] { osgSkin::importRig(path); }, where + "accessors[5]: key 2 is at ");
        }
        GltfColumn column = moved({0.0, 0.5, 0.5}, interpolation);
        EXPECT_EQ(osgSkin::importRig(column.save("back.gltf")).animations.size(), 1u);
    }
}

TEST(GltfBuffers, ReadsChunkDataUriAndFile) {
    GltfColumn column;
    const std::string bytes = column.bytes();
    const auto text = [&](const json& buffer) {
        json file = column.json;
        file["buffers"] = {buffer};
        file["buffers"][0]["byteLength"] = bytes.size();
        return file.dump();
    };
    std::ofstream(testing::TempDir() + "my buffer%.bin", std::ios::binary) << bytes;
    const json beside = {{"uri", "my%20buffer%25.bin"}};
    const json escapes = {{"uri", "data:," + escaped(bytes)}};
    expectColumn(saveText("chunk.glb", test::glb(text(json::object()), bytes)));
    // The chunk belongs to no buffer if the first buffer has another location.
    for (const std::string& chunk : {std::string(), std::string("abcd")}) {
        expectColumn(saveText("beside.glb", test::glb(text(beside), chunk)));
        expectColumn(saveText("escapes.glb", test::glb(text(escapes), chunk)));
    }
    expectColumn(saveText("mark.glb", test::glb("\xef\xbb\xbf" + text(json::object()), bytes)));
    const std::string path = saveText("empty.glb", test::glb(text(json::object())));
    expectError([&] { osgSkin::importMesh(path); }, "expected a buffer view within its buffer");
}

TEST(GltfBuffers, RejectsInvalidBase64) {
    const auto save = [](const std::function<std::string(std::string)>& change) {
        GltfColumn column;
        column.save("data.gltf");
        std::string uri = column.json["buffers"][0]["uri"];
        column.json["buffers"][0]["uri"] = change(uri);
        return column.save("data.gltf");
    };
    const auto replaced = [](std::string text, const std::string& letter,
                             const std::string& other) {
        for (std::size_t at = text.find(','); (at = text.find(letter, at)) != std::string::npos;
             at += other.size())
            text.replace(at, letter.size(), other);
        return text;
    };
    expectColumn(save([&](const std::string& uri) {
        return replaced(replaced(replaced(uri, "/", "%2F"), "+", "%2b"), "=", "%3D");
    }));
    expectColumn(save([](std::string uri) { return uri.insert(uri.size() - 40, " \r\n\t"); }));
    expectColumn(
        save([](std::string uri) { return uri.replace(uri.find("base64"), 6, "BASE64"); }));
    const std::string reason = "data.gltf: malformed glTF: buffers[0].uri: letter ";
    for (const char* none : {"_", "-", "*", "%"}) {
        const std::string path =
            save([&](const std::string& uri) { return replaced(uri, "A", none); });
        expectError([&] { osgSkin::importMesh(path); }, reason);
    }
}

TEST(GltfBuffers, ReadsSharedFileOnce) {
    GltfColumn column;
    std::ofstream(testing::TempDir() + "shared.bin", std::ios::binary)
        << column.bytes() << std::string(3'000'000, '\0');
    json buffers = json::array();
    for (int i = 0; i < 300; ++i) {
        std::string name;
        for (int k = 0; k < i % 9; ++k) name += "./";
        buffers.push_back({{"byteLength", 1}, {"uri", name + "shared.bin"}});
    }
    column.json["buffers"] = buffers;
    column.json["bufferViews"][0]["buffer"] = 200;
    const std::string path = column.save("shared.gltf");
    const std::clock_t begin = std::clock();
    const long before = peakMegabytes();
    expectColumn(path);
    EXPECT_LT(double(std::clock() - begin) / CLOCKS_PER_SEC, 2.0);
    EXPECT_LT(peakMegabytes() - before, 100);
}

namespace {

/// The text of a column, padded as in a binary file.
std::string textOf(GltfColumn& column) {
    column.save("whole.gltf");
    std::string text = column.json.dump();
    text.resize((text.size() + 3) / 4 * 4, ' ');
    return text;
}

void expectRefused(const std::string& content, const std::string& message) {
    const std::string path = saveText("broken.gltf", content);
    expectError([&] { osgSkin::importMesh(path); }, path + ": " + message);
}

void expectRead(const std::string& content) {
    EXPECT_EQ(osgSkin::importMesh(saveText("whole.gltf", content)).mesh.positions.size(), 24u);
}

} // namespace

TEST(BadGltf, ErrorsNameLineAndColumn) {
    GltfColumn column;
    const std::string text = textOf(column);
    expectRefused("{\n  \"asset\": {,}\n}", "malformed glTF: line 2, column 13: expected JSON");
    expectRefused(text.substr(0, text.rfind('}')), "malformed glTF: line 1, column ");
    expectRefused(text + "{}", "malformed glTF: line 1, column ");
    expectRefused("{\"asset\":{\"version\":\"2.0\",\"x\":1e999}}",
                  "malformed glTF: line 1, column 35: expected a finite number");
    expectRefused("", "malformed glTF: line 1, column 1: expected JSON");
    expectRefused(text + std::string(1, '\0') + "{}",
                  "malformed glTF: byte " + std::to_string(text.size()) + " of its text is 0");
    expectRead(text + std::string(3, '\0'));
}

TEST(BadGltf, RejectsDuplicateMembers) {
    GltfColumn column;
    std::string text = textOf(column);
    const std::string named = "\"name\":\"column\"";
    text.replace(text.find(named), named.size(), named + ",\"n\\u0061me\":\"other\"");
    expectRefused(text, "malformed glTF: meshes[0].name is a duplicate member");
}

TEST(BadGltf, RejectsOtherVersions) {
    GltfColumn column;
    const std::string text = textOf(column);
    expectRefused("[]", "not a glTF 2 file: expected an object \"asset\"");
    expectRefused("{\"asset\":{\"version\":2}}", "not a glTF 2 file: asset.version is \"\"");
    json later = json::parse(text);
    later["asset"]["minVersion"] = "3.0";
    expectRefused(later.dump(), "not a glTF 2 file: asset.minVersion is \"3.0\", expected \"2.0\"");
    expectRefused(test::glb(text, {}, 1), "not a glTF 2 file: binary version 1, expected 2");
}

TEST(BadGltf, RejectsTruncatedChunks) {
    GltfColumn column;
    const std::string text = textOf(column), whole = test::glb(text);
    expectRefused("glTF", "malformed glTF: 4 bytes, expected a header of 12");
    expectRefused(whole.substr(0, 12), "malformed glTF: expected a chunk of JSON");
    expectRefused(whole.substr(0, whole.size() - 5),
                  "malformed glTF: the chunk at byte 12 has " + std::to_string(text.size()) +
                      " bytes, expected at most the " + std::to_string(text.size() - 5));
    expectRead(whole);
    expectRead(whole + "behind the length that the header tells");
    expectRead(test::glb(text + std::string(8, '\0')));
}

TEST(GltfExtensions, WarnsInOneLine) {
    GltfColumn column;
    for (int i = 0; i < 1000; ++i)
        column.json["extensionsRequired"].push_back("KHR_new_" + std::to_string(i % 500));
    const std::string path = column.save("many.gltf");
    const test::Notices notices;
    osgSkin::importMesh(path);
    EXPECT_EQ(notices.lines(), 1u) << notices.text().substr(0, 1000);
    EXPECT_TRUE(notices.say("requires 500 extensions, \"KHR_new_0\" among them"));
}

TEST(GltfNames, ReplaceZeroBytes) {
    GltfColumn column;
    column.bend();
    using namespace std::string_literals;
    column.json["nodes"][0]["name"] = "bone\0a"s;
    column.json["nodes"][1]["name"] = "bone\0b"s;
    const osgSkin::ImportedRig rig = osgSkin::importRig(column.save("zeros.gltf"));
    EXPECT_EQ(rig.rest.joints[0].name, "bone_a");
    EXPECT_EQ(rig.rest.joints[1].name, "bone_b");
    EXPECT_EQ(rig.body.weights.size(), 3u);
    ASSERT_EQ(rig.animations.size(), 1u);
}

/// If two nodes have the same name, the animated one keeps it.
TEST(GltfNames, AnimatedNodeKeepsTheSharedName) {
    GltfColumn column;
    column.bend();
    json& nodes = column.json["nodes"];
    json& roots = column.json["scenes"][0]["nodes"];
    const json before = roots;
    const std::size_t moved = column.node({{"name", "twin"}, {"children", before}});
    const std::size_t still = column.node({{"name", "twin"}, {"children", {moved}}});
    std::swap(nodes[moved], nodes[still]); // the static one comes first in the file
    nodes[moved]["children"] = {still};
    roots = {moved};
    column.animate("bend", still, "translation", {0.0, 1.0}, {0, 0, 0, 0, 1, 0});
    const osgSkin::ImportedRig rig = osgSkin::importRig(column.save("twins.gltf"));
    std::vector<std::string> targets;
    for (const auto& channel : rig.animations.at(0)->getChannels())
        targets.push_back(channel->getTargetName());
    EXPECT_GT(std::count(targets.begin(), targets.end(), "twin"), 0);
}

TEST(GltfNames, AreTruncated) {
    GltfColumn column;
    // Assimp appends a number to the name of each of several primitives.
    json& mesh = column.json["meshes"][0];
    mesh["name"] = std::string(1023, 'm');
    const json primitive = mesh["primitives"][0];
    for (int i = 0; i < 11; ++i) mesh["primitives"].push_back(primitive);
    std::string joint; // whose 500th byte is within a character
    for (int i = 0; i < 300; ++i) joint += i == 0 ? "j" : "\u00e9";
    column.json["nodes"][0]["name"] = joint;
    const osgSkin::ImportedRig rig = osgSkin::importRig(column.save("long.gltf"));
    EXPECT_EQ(rig.body.mesh.positions.size(), 12u * 24);
    EXPECT_EQ(rig.rest.joints[0].name, joint.substr(0, 499));
}
