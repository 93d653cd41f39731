// SPDX-License-Identifier: MIT
// PLY meshes as other programs write them, and files that only resemble them.
#include "ExpectError.h"
#include "MeshParts.h"
#include "Notices.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace {

using namespace std::string_literals;
using osgSkin::ImportedMesh;

const std::string kVertices = "element vertex 3\nproperty float x\nproperty float y\n"
                              "property float z\n",
                  kFaces = "element face 1\nproperty list uchar int vertex_indices\n",
                  kPositions = "0 0 0\n1 0 0\n0 1 0\n";

std::string ply(const std::string& header, const std::string& body) {
    return "ply\nformat ascii 1.0\n" + header + "end_header\n" + body;
}

std::string replacedOnce(std::string text, const std::string& from, const std::string& to) {
    return text.replace(text.find(from), from.size(), to);
}

/// A binary triangle with coordinates and indices of one byte.
std::string binary(const std::string& end, const std::string& body) {
    std::string text;
    for (const char* line :
         {"ply", "format binary_little_endian 1.0", "element vertex 3", "property uchar x",
          "property uchar y", "property uchar z", "element face 1",
          "property list uchar uchar vertex_indices", "end_header"})
        text += line + end;
    return text + body;
}

} // namespace

TEST(PlyDialect, ReadsVariants) {
    const std::string text = ply(kVertices + kFaces, kPositions + "3 0 1 2");
    for (const std::string& content :
         {text, text + "\n \r\n", text + "\n\x1a", text + "\n\x1a\n",
          replacedOnce(text, "ply\n", "ply \t\n"), replacedOnce(text, "int", "float")})
        EXPECT_EQ(readMesh("read.ply", content).mesh.faceSizes.size(), 1u) << content;
}

TEST(PlyDialect, RejectsInvalidNumbersAndTypes) {
    const std::string text = ply(kVertices + kFaces, kPositions + "3 0 1 2\n");
    const std::string fraction =
        ply(kVertices + replacedOnce(kFaces, "int", "float"), kPositions + "3 0 1.5 2\n");
    // Rows of four numbers, of which the header declares three.
    const std::string longer = ply(kVertices + kFaces, "0 0 0 3\n0 1 2 3\n1 0 0 3\n");
    const std::pair<std::string, const char*> cases[] = {
        {fraction, "face 0 names vertex 1.5"},
        {replacedOnce(text, "vertex 3", "vertex 3.7"),
         "line 3: \"3.7\" elements, expected a whole number"},
        {replacedOnce(text, "float x", "Float x"),
         "line 4: unknown property type \"Float\", expected one of "},
        {longer, "more numbers than the header declares"}};
    for (const auto& [content, message] : cases)
        expectError([&, &content = content] { readMesh("refused.ply", content); },
                    std::string("refused.ply: ") + message);
}

TEST(PlyDialect, WarnsAboutTrailingBytes) {
    const test::Notices notices;
    readMesh("bytes.ply", binary("\n", "\0\0\0\1\0\0\0\1\0\3\0\1\2\n\n"s));
    EXPECT_TRUE(notices.say("trailing bytes ignored")) << notices.text();
}

TEST(PlyDialect, BodyMayBeginWithLineFeed) {
    for (const std::string end : {"\r", "\n", "\r\n"}) {
        const ImportedMesh mesh = readMesh("feed.ply", binary(end, "\n\0\0\1\0\0\0\1\0\3\0\1\2"s));
        EXPECT_EQ(mesh.mesh.positions.at(0), glm::dvec3(10, 0, 0));
    }
}
