// SPDX-License-Identifier: MIT
// glTF files that are broken as a whole, or of another version: each says where.
#include "ExpectError.h"
#include "GlbNumber.h"
#include "GltfBuilder.h"
#include "Notices.h"
#include "TextFile.h"

#include <osgSkinImport/ImportMesh>
#include <osgSkinImport/ImportRig>

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

namespace {

using nlohmann::json;
using test::glbNumber;
using test::GltfColumn;
using test::saveText;

/// A binary file of one chunk.
/// \param told the length that its header tells; 0: the file's
std::string glbOf(const std::string& text, std::size_t version = 2, std::size_t told = 0) {
    const std::string chunk = glbNumber(text.size()) + "JSON" + text;
    return "glTF" + glbNumber(version) + glbNumber(told > 0 ? told : 12 + chunk.size()) + chunk;
}

std::string textOf(GltfColumn& column) {
    column.save("whole.gltf");
    return column.json.dump();
}

void expectRefused(const std::string& content, const std::string& message) {
    const std::string path = saveText("broken.gltf", content);
    expectError([&] { osgSkin::importMesh(path); }, path + ": " + message);
}

void expectRead(const std::string& content) {
    EXPECT_EQ(osgSkin::importMesh(saveText("whole.gltf", content)).mesh.positions.size(), 24u);
}

} // namespace

TEST(BadGltf, TextsSayWhereTheyAreBroken) {
    GltfColumn column;
    const std::string text = textOf(column);
    expectRefused("{\n  \"asset\": {,}\n}", "malformed glTF: line 2, column 13: expected JSON");
    expectRefused(text.substr(0, text.size() - 1), "malformed glTF: line 1, column ");
    expectRefused(text + "{}", "malformed glTF: line 1, column ");
    expectRefused("{\"asset\":{\"version\":\"2.0\",\"x\":1e999}}",
                  "malformed glTF: line 1, column 35: expected a finite number");
    expectRefused("", "malformed glTF: line 1, column 1: expected JSON");
    expectRefused(text + std::string(1, '\0') + "{}",
                  "malformed glTF: byte " + std::to_string(text.size()) + " of its text is 0");
    expectRead(text + std::string(3, '\0'));
}

TEST(BadGltf, MembersAreThereOnce) {
    GltfColumn column;
    std::string text = textOf(column);
    const std::string named = "\"name\":\"column\"";
    text.replace(text.find(named), named.size(), named + ",\"n\\u0061me\":\"other\"");
    expectRefused(text, "malformed glTF: meshes[0].name is there twice, expected each member once");
}

TEST(BadGltf, VersionsAreTheSecond) {
    GltfColumn column;
    const std::string text = textOf(column);
    expectRefused("[]", "no glTF 2 file: expected an object \"asset\"");
    expectRefused("{\"asset\":{\"version\":2}}", "no glTF 2 file: asset.version is \"\"");
    json later = json::parse(text);
    later["asset"]["minVersion"] = "3.0";
    expectRefused(later.dump(), "no glTF 2 file: asset.minVersion is \"3.0\", expected \"2.0\"");
    expectRefused(glbOf(text, 1), "no glTF 2 file: a binary one of version 1, expected 2");
}

TEST(BadGltf, ChunksAreInTheFile) {
    GltfColumn column;
    const std::string text = textOf(column), whole = glbOf(text);
    expectRefused("glTF", "malformed glTF: 4 bytes, expected a header of 12");
    expectRefused(whole.substr(0, 12), "malformed glTF: expected a chunk of JSON");
    expectRefused(whole.substr(0, whole.size() - 5),
                  "malformed glTF: the chunk at byte 12 has " + std::to_string(text.size()) +
                      " bytes, expected at most the " + std::to_string(text.size() - 5));
    expectRead(whole);
    expectRead(whole + "behind the length that the header tells");
    expectRead(glbOf(text + std::string(5, '\0')));
}

TEST(GltfExtensions, AreToldInOneLine) {
    GltfColumn column;
    for (int i = 0; i < 1000; ++i)
        column.json["extensionsRequired"].push_back("KHR_new_" + std::to_string(i % 500));
    const std::string path = column.save("many.gltf");
    const test::Notices notices;
    osgSkin::importMesh(path);
    EXPECT_EQ(notices.lines(), 1u) << notices.text().substr(0, 1000);
    EXPECT_TRUE(notices.say("requires 500 extensions, \"KHR_new_0\" among them"));
}

TEST(GltfNames, EndWhereTheyEnd) {
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

/// Of two nodes called alike the one that moves keeps its name.
TEST(GltfNames, GoToWhatMovesFirst) {
    GltfColumn column;
    column.bend();
    json& nodes = column.json["nodes"];
    json& roots = column.json["scenes"][0]["nodes"];
    const json before = roots;
    const std::size_t moved = column.node({{"name", "twin"}, {"children", before}});
    const std::size_t still = column.node({{"name", "twin"}, {"children", {moved}}});
    std::swap(nodes[moved], nodes[still]); // the one that stands comes first in the file
    nodes[moved]["children"] = {still};
    roots = {moved};
    column.animate("bend", still, "translation", {0.0, 1.0}, {0, 0, 0, 0, 1, 0});
    const osgSkin::ImportedRig rig = osgSkin::importRig(column.save("twins.gltf"));
    std::vector<std::string> targets;
    for (const auto& channel : rig.animations.at(0)->getChannels())
        targets.push_back(channel->getTargetName());
    EXPECT_GT(std::count(targets.begin(), targets.end(), "twin"), 0);
}

TEST(GltfNames, AreAsLongAsTheyMayBe) {
    GltfColumn column;
    // Assimp writes a number behind the name of each of several primitives.
    json& mesh = column.json["meshes"][0];
    mesh["name"] = std::string(1023, 'm');
    const json primitive = mesh["primitives"][0];
    for (int i = 0; i < 11; ++i) mesh["primitives"].push_back(primitive);
    std::string joint; // whose 500th byte is within a letter
    for (int i = 0; i < 300; ++i) joint += i == 0 ? "j" : "\u00e9";
    column.json["nodes"][0]["name"] = joint;
    const osgSkin::ImportedRig rig = osgSkin::importRig(column.save("long.gltf"));
    EXPECT_EQ(rig.body.mesh.positions.size(), 12u * 24);
    EXPECT_EQ(rig.rest.joints[0].name, joint.substr(0, 499));
}
