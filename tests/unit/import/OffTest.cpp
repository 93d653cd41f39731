// SPDX-License-Identifier: MIT
// OFF files as others write them, and byte order marks before texts of meshes.
#include "ExpectError.h"
#include "Paths.h"
#include "TextFile.h"

#include <osgSkinImport/ImportMesh>

#include <osg/Geometry>

#include <string>

namespace {

using test::saveText;

constexpr char kMark[] = "\xef\xbb\xbf";

/// A triangle; `more` follows each vertex.
std::string off(const std::string& keyword, const std::string& more = "",
                const std::string& x = "0") {
    return keyword + "\n3 1 0\n" + x + " 0 0 " + more + "\n1 0 0 " + more + "\n0 1 0 " + more +
           "\n3 0 1 2\n";
}

const std::string kPly = "element vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
                         "element face 1\nproperty list uchar int vertex_indices\nend_header\n";

} // namespace

TEST(Off, NumbersOfAnyLengthAreTheirValues) {
    const auto first = [](const std::string& x) {
        return osgSkin::importMesh(saveText("long.off", off("OFF", "", x))).mesh.positions.at(0)[0];
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

TEST(Off, ColoursAndTextureCoordinatesFollowNormals) {
    const auto arrays = [](const std::string& text) {
        const osgSkin::ImportedMesh mesh = osgSkin::importMesh(saveText("kinds.off", text));
        return mesh.parts.at(0).geometry;
    };
    for (const auto& [keyword, more] :
         {std::pair("COFF", "255 0 0 255"), std::pair("CNOFF", "0 0 1 255 0 0 255"),
          std::pair("C4OFF", "1 255 0 0 255"), std::pair("CN4OFF", "1 0 0 1 255 0 0 255")}) {
        const auto geometry = arrays(off(keyword, more));
        const auto* colours = dynamic_cast<const osg::Vec4Array*>(geometry->getColorArray());
        ASSERT_NE(colours, nullptr) << keyword;
        EXPECT_EQ(colours->at(0), osg::Vec4(1, 0, 0, 1)) << keyword;
    }
    for (const auto& [keyword, more] :
         {std::pair("STOFF", ".25 .5"), std::pair("STNOFF", "0 0 1 .25 .5")}) {
        const auto geometry = arrays(off(keyword, more));
        const auto* places = dynamic_cast<const osg::Vec2Array*>(geometry->getTexCoordArray(0));
        ASSERT_NE(places, nullptr) << keyword;
        EXPECT_EQ(places->at(0), osg::Vec2(.25f, .5f)) << keyword;
    }
    const std::string path = saveText("short.off", off("CNOFF", "0 0"));
    expectError([&] { osgSkin::importMesh(path); }, path + ": vertex 0: expected a line of 6");
}

TEST(Marks, MayBeginMeshes) {
    const auto vertices = [](const std::string& name, const std::string& content) {
        return osgSkin::importMesh(saveText(name, kMark + content)).mesh.positions.size();
    };
    EXPECT_EQ(vertices("marked.off", off("OFF")), 3u);
    EXPECT_EQ(
        vertices("marked.ply", "ply\nformat ascii 1.0\n" + kPly + "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"),
        3u);
    const std::string zero(4, '\0'), one("\x00\x00\x80\x3f", 4), next("\x01\x00\x00\x00", 4),
        last("\x02\x00\x00\x00", 4);
    EXPECT_EQ(vertices("binary.ply", "ply\nformat binary_little_endian 1.0\n" + kPly + zero + zero +
                                         zero + one + zero + zero + zero + one + zero + "\x03" +
                                         zero + next + last),
              3u);
}
