// SPDX-License-Identifier: MIT
// OBJ meshes as other programs write them, and files that only resemble them.
#include "ExpectError.h"
#include "MeshParts.h"
#include "Notices.h"

#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

namespace {

using osgSkin::ImportedMesh;

const std::string kSquare = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

/// The diffuse colour of a square with the library's material "m".
osg::Vec4 diffuseBy(const std::string& library) {
    test::saveText("dialect.mtl", "newmtl m\n" + library);
    return diffuseOf(
        readMesh("dialect.obj", "mtllib dialect.mtl\n" + kSquare + "usemtl m\nf 1 2 3 4\n"));
}

/// Files with the number of corners of their faces.
const std::pair<const char*, std::vector<std::uint32_t>> kRead[] = {
    {"# C:\\folder\\\nv 0 0 \\\n0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2\\\n3 \\\n4\n", {4}},
    {"# C:\\folder\\\r\nv 0 0 \\\r\n0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2\\\r\n3 \\\r\n4\n", {4}},
    {"v\\\n 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf\\\n1 2 3 4\n", {4}}, // after the keyword
    {"v\\\r\n 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf\\\r\n1 2 3 4\n", {4}},
    {"v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nvt 0 0\nf 1// 2// 3//\n", {3}},
    {"v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nvt 0 0\nf 1/ 2/ 3/\n", {3}},
    {"v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nvt 0 0\nf 1/1/ 2/1/ 3/1/\n", {3}},
    {"v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nf 1 2 3\nfo 2 4 3\n", {3, 3}}, // "face outline"
    {"v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4 # a square\nf 1 2 3 #4\n", {4, 3}},
    {"v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nFine 1 2\n\xc3\xa9 1\nvp 1 2\nl 1 2\nf 1 2 3\n", {3}},
};

/// Lines after kSquare, and the error.
const std::pair<std::string, std::string> kRefused[] = {
    {"f 1 2 \\\n9 \\\n3\n", "line 5: \"9\" in a face"},
    {"f 1 2 \\\n3\nf 1 2 9\n", "line 7: \"9\""},
    {"vt 0 0\nvn 0 0 1\nf 1/// 2 3\n", "line 7: "},
    {"vt 0 0\nvn 0 0 1\nf / 2 3\n", "line 7: "},
    {"vt 0 0\nvn 0 0 1\nf // 2 3\n", "line 7: "},
    {"vt 0 0\nvn 0 0 1\nf /1 2 3\n", "line 7: "},
    {"vt 0 0\nvn 0 0 1\nf 1/1/1/1 2 3\n", "line 7: "},
    {"v -1.#IND00 0 0\n", "line 5: \"-1.#IND00\" in a \"v\""},
    // A quotation ends with a whole character.
    {"f 1 2 " + std::string(39, 'a') + "\xc3\xa4\xc3\xa4\n",
     "\"" + std::string(39, 'a') + "...\" in a face"},
    // Lines that a person would read as a face or a vertex.
    {"f 1 2 3\nF 1 2 3\n", "line 6: unknown keyword \"F\"; did you mean \"f\"?"},
    {"f 1 2 3\nf\v1 2 3\n", "line 6: unknown keyword \""},
    {"f 1 2 3\n\ff 1 2 3\n", "line 6: unknown keyword \""},
    {"f 1 2 3\n\xc2\xa0"
     "f 1 2 3\n",
     "line 6: unknown keyword \""},
    {"f 1 2 3\n\xef\xbb\xbf"
     "f 1 2 3\n",
     "line 6: unknown keyword \""},
    {"f 1 2 3\nf\xc2\xa0"
     "1 2 3\n",
     "line 6: unknown keyword \""},
    {"f 1 2 3\nV 0 0 1\n", "line 6: unknown keyword \"V\"; did you mean \"v\"?"},
    {"f 1 2 3\nVN 0 0 1\n", "line 6: unknown keyword \"VN\"; did you mean \"vn\"?"},
};

/// Files, and a part of the warning; none after "!".
const std::pair<const char*, const char*> kWarned[] = {
    {"v 0 0 0 1\nv 1 0 0 1.0\nv 0 1 0 0.5\nvt 0 0 0.5\nvn 0 0 1\nf 1 2 3\n",
     "1 of 3 vertices have a fourth number that is not 1"},
    {"v 0 0 0 0.5 1 0 0\nv 1 0 0 1 0 1 0\nv 0 1 0 1 0 0 1\nf 1 2 3\n",
     "1 of 3 vertices have a fourth number that is not 1"},
    {"v 0 0 0 1\nv 1 0 0 1\nv 0 1 0 1\nvn 0 0 1\nf 1 2 3\n", "!fourth number"},
    {"v 0 0 0 1 0 0\nv 1 0 0\nv 0 1 0 0 0 1\nf 1 2 3\n",
     "2 of 3 vertices have colours; all colours are ignored"},
};

} // namespace

TEST(ObjDialect, ReadsVariants) {
    for (const auto& [content, sizes] : kRead) {
        const ImportedMesh mesh = readMesh("read.obj", content);
        EXPECT_EQ(mesh.mesh.positions.size(), 4u) << content;
        EXPECT_EQ(mesh.mesh.faceSizes, sizes) << content;
    }
}

TEST(ObjDialect, RejectsBrokenLines) {
    for (const auto& [lines, message] : kRefused)
        expectError([&, &lines = lines] { readMesh("refused.obj", kSquare + lines); },
                    "refused.obj: " + std::string(message[0] == '"' ? "line 5: " : "") + message);
}

TEST(ObjDialect, WarnsAboutIgnoredNumbers) {
    for (const auto& [content, warning] : kWarned) {
        const test::Notices notices;
        readMesh("warned.obj", content);
        const bool isExpected = *warning != '!';
        EXPECT_EQ(notices.say(warning + !isExpected), isExpected) << notices.text();
    }
}

TEST(ObjDialect, ReplacesNaNNormalsAndTextureCoordinates) {
    for (const char* lines :
         {"vn -1.#IND00 1.#QNAN 0\nf 1//1 2//1 3//1\n", "vn nan(ind) inf 0\nf 1//1 2//1 3//1\n",
          "vt nan -1.#INF\nf 1/1 2/1 3/1\n"}) {
        const ImportedMesh mesh = readMesh("broken.obj", kSquare + lines);
        for (const osg::Vec3& normal : normalsOf(mesh)) EXPECT_EQ(normal, osg::Vec3(0, 0, 1));
        if (geometryOf(mesh).getTexCoordArray(0) == nullptr) continue;
        for (const osg::Vec2& t : texCoordsOf(mesh)) EXPECT_EQ(t, osg::Vec2());
    }
}

TEST(ObjDialect, ReadsMaterialColours) {
    const osg::Vec4 plain = diffuseBy("Ns 1\n");
    EXPECT_EQ(plain, osg::Vec4(.8f, .74f, .68f, 1)) << "as without a library, and not black";
    const std::pair<const char*, osg::Vec4> libraries[] = {
        {"Kd 0.25\n", {.25f, .25f, .25f, 1}},
        {"Kd 0.25 0.5 0.75\nd -halo 0.5\n", {.25f, .5f, .75f, 1}},
        {"kd 0.25\nD 0.5\n", {.25f, .25f, .25f, .5f}},
        {"Kd spectral file.rfl 1\n", plain},
        {"Kd nan 0 0\n", plain},
        {"Kd 0,5 0,5 0,5\n", plain},
        {"", plain},
        {"map_Kd -o 1e999 0 0 nowhere.png\n", plain}, // which is ignored
        {"newmtl n\nKd 1 0 0\n", plain},              // another material's
    };
    for (const auto& [library, colour] : libraries)
        EXPECT_EQ(diffuseBy(library), colour) << library;
}

TEST(ObjDialect, WarnsAboutTextureOffset) {
    const test::Notices notices;
    diffuseBy("map_Kd -o 0.5 0 0 -s 1 1 1 nowhere.png\n");
    EXPECT_TRUE(notices.say(
        "dialect.mtl: texture offset and scale (-o, -s) are not supported; ignored for 1"))
        << notices.text();
    const test::Notices none;
    diffuseBy("map_Kd -o 0 0 0 -s 1 1 1 -clamp on nowhere.png\n");
    EXPECT_FALSE(none.say("texture offset")) << none.text();
}

TEST(ObjDialect, LimitsMaterialLibraries) {
    std::string text;
    for (int k = 0; k < 1001; ++k) text += "mtllib nowhere" + std::to_string(k) + ".mtl\n";
    expectError([&] { readMesh("libraries.obj", text + kSquare + "f 1 2 3\n"); },
                "line 1001: more than 1000 material libraries");
}

TEST(ObjDialect, RejectsVerticesAtOnePosition) {
    expectError([] { readMesh("point.obj", "v 1 2 3\nv 1 2 3\nv 1 2 3\nf 1 2 3\n"); },
                "all vertices are at the same position");
}
