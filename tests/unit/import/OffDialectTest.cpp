// SPDX-License-Identifier: MIT
// OFF meshes as other programs write them, and files that only resemble them.
#include "ExpectError.h"
#include "MeshParts.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <utility>
#include <vector>

namespace {

using osgSkin::ImportedMesh;
using Indices = std::vector<std::uint32_t>;

/// A triangle; `more` follows each vertex.
std::string off(const std::string& keyword, const std::string& more = "",
                const std::string& x = "0") {
    return keyword + "\n3 1 0\n" + x + " 0 0 " + more + "\n1 0 0 " + more + "\n0 1 0 " + more +
           "\n3 0 1 2\n";
}

ImportedMesh readOff(const std::string& content) {
    return readMesh("mesh.off", content);
}

} // namespace

TEST(OffDialect, ReadsLongNumbers) {
    const auto first = [](const std::string& x) {
        return readOff(off("OFF", "", x)).mesh.positions.at(0)[0];
    };
    EXPECT_EQ(first("123456789012345678"), double(123456789012345678.0f));
    EXPECT_EQ(first("-12345678901234567"), double(-12345678901234567.0f));
    EXPECT_EQ(first("-" + std::string(30, '0') + "12.5"), -12.5);
    EXPECT_EQ(first("1." + std::string(500, '3')), double(1.0f / 0.75f));
    EXPECT_EQ(first("2e" + std::string(30, '0') + "3"), 2000.0);
    EXPECT_EQ(first("1e-99999999999999999999"), 0.0);
    for (const char* number : {"12345678901234567890123", "1e99999999999999999999"})
        expectError([&] { first(number); }, "mesh: vertex 0 has a coordinate");
}

TEST(OffDialect, ReadsColours) {
    const struct {
        const char *keyword, *more;
        osg::Vec4 colour;
    } cases[] = {
        {"COFF", "255 0 0 255", {1, 0, 0, 1}},
        {"CNOFF", "0 0 1 255 0 0 255", {1, 0, 0, 1}},
        {"C4OFF", "1 255 0 0 255", {1, 0, 0, 1}},
        {"CN4OFF", "1 0 0 1 255 0 0 255", {1, 0, 0, 1}},
        {"COFF", "255 0 51", {1, 0, .2f, 1}}, // no alpha
        {"COFF", "1 0.5 0", {1, .5f, 0, 1}},
        {"COFF", "255 0 51 0", {1, 0, .2f, 0}},
        {"STCOFF", "1 0.5 0 0.25 0.75", {1, .5f, 0, 1}},
    };
    for (const auto& c : cases)
        EXPECT_EQ(coloursOf(readOff(off(c.keyword, c.more))).at(0), c.colour)
            << c.keyword << c.more;
}

/// The parts of the keyword may have any order; that of a vertex's numbers is fixed.
TEST(OffDialect, ReadsTextureCoordinates) {
    const char* const all = "0 0 1 255 0 0 255 .25 .5";
    for (const auto& [keyword, more] :
         {std::pair("STOFF", ".25 .5"), std::pair("STNOFF", "0 0 1 .25 .5"),
          std::pair("STCNOFF", all), std::pair("NCSTOFF", all), std::pair("CSTNOFF", all)})
        EXPECT_EQ(texCoordsOf(readOff(off(keyword, more))).at(0), osg::Vec2(.25f, .5f)) << keyword;
    expectError([] { readOff("CCOFF\n3 1 0\n"); }, "\"CCOFF\", expected OFF");
    expectError([] { readOff(off("CNOFF", "0 0")); }, "mesh.off: vertex 0: expected a line of 6");
}

TEST(OffDialect, ReadsNormalsAndDivisor) {
    const ImportedMesh mesh = readOff("N4OFF\n3 1 0\n0 0 0 2 0 1 1\n2 0 0 2 0 1 1\n"
                                      "0 2 0 2 0 1 1\n3 0 1 2\n");
    EXPECT_EQ(mesh.mesh.positions.at(1), glm::dvec3(1, 0, 0));
    EXPECT_NEAR(normalsOf(mesh).at(0).y(), std::sqrt(0.5), 1e-6);
}

TEST(OffDialect, CommentsMayBeAnywhere) {
    const ImportedMesh mesh =
        readOff("# made by hand\nOFF # text\n\n4 1 0 # counts\n# places\n \t\n0 0 0\n1 0 0\n"
                "# one more\n1 1 0 # up\n\r\n0 1 0\n\n4 0 1 2 3 255 0 0 # red\n");
    EXPECT_EQ(mesh.mesh.positions.size(), 4u);
    EXPECT_EQ(mesh.mesh.faceVertices, (Indices{0, 1, 2, 3}));
    EXPECT_EQ(diffuseOf(mesh), osg::Vec4(.6f, .6f, .6f, 1));
}

TEST(OffDialect, FacesMayHaveManyCorners) {
    std::string text = "OFF\n300 3 0\n", face = "300";
    for (int k = 0; k < 300; ++k) {
        const double angle = 2.0 * std::acos(-1.0) * k / 300.0;
        text += std::to_string(std::cos(angle)) + " " + std::to_string(std::sin(angle)) + " 0\n";
        face += " " + std::to_string(k);
    }
    // Points and lines are not faces.
    EXPECT_EQ(readOff(text + "1 0\n" + face + "\n2 0 1\n").mesh.faceSizes, Indices{300});
    for (const std::string broken :
         {"0", "4 0 1 2", "-3 0 1 2", "3 0 1 4", "3 0 1 1.5", "3.5 0 1 2", "x"})
        expectError([&] { readOff("OFF\n4 1 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n" + broken + "\n"); },
                    "mesh.off: face 0: expected the number of its corners and as many");
}

TEST(ByteOrderMark, MayBeginMeshes) {
    const std::string ply =
        "element vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face 1\n"
        "property list uchar int vertex_indices\nend_header\n";
    const std::string zero(4, '\0'), one("\x00\x00\x80\x3f", 4), next("\x01\x00\x00\x00", 4),
        last("\x02\x00\x00\x00", 4);
    const std::pair<const char*, std::string> files[] = {
        {"marked.off", off("OFF")},
        {"marked.ply", "ply\nformat ascii 1.0\n" + ply + "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"},
        {"binary.ply", "ply\nformat binary_little_endian 1.0\n" + ply + zero + zero + zero + one +
                           zero + zero + zero + one + zero + "\x03" + zero + next + last}};
    for (const auto& [name, content] : files)
        EXPECT_EQ(readMesh(name, "\xef\xbb\xbf" + content).mesh.positions.size(), 3u) << name;
}
