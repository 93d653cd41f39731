// SPDX-License-Identifier: MIT
//
// OBJ, PLY and OFF meshes as other programs write them, and files that only resemble them.
//
// Polygons with concave corners, and with any number of corners.
#include "ExpectError.h"
#include "Notices.h"
#include "Paths.h"

#include <osgSkinImport/ImportMesh>
#include <osgSkinRig/SkinMesh>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <gtest/gtest.h>
#include <osg/Array>
#include <osg/Geometry>
#include <osg/Material>

#include <cmath>
#include <ctime>
#include <fstream>
#include <numeric>
#include <random>

namespace {

using namespace std::string_literals;
using osgSkin::ImportedMesh;

ImportedMesh readMesh(const std::string& name, const std::string& content) {
    const std::string path = testing::TempDir() + name;
    std::ofstream(path, std::ios::binary) << content;
    return osgSkin::importMesh(path);
}

const std::string kSquare = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

osg::Vec4 diffuseOf(const ImportedMesh& mesh) {
    return dynamic_cast<const osg::Material&>(
               *mesh.parts.at(0).geometry->getStateSet()->getAttribute(
                   osg::StateAttribute::MATERIAL))
        .getDiffuse(osg::Material::FRONT);
}

/// The diffuse colour of a square with the library's material "m".
osg::Vec4 diffuseBy(const std::string& library) {
    std::ofstream(testing::TempDir() + "dialect.mtl") << "newmtl m\n" << library;
    return diffuseOf(
        readMesh("dialect.obj", "mtllib dialect.mtl\n" + kSquare + "usemtl m\nf 1 2 3 4\n"));
}

const std::string kThreeVertices = "element vertex 3\nproperty float x\nproperty float y\n"
                                   "property float z\n",
                  kFaces = "element face 1\nproperty list uchar int vertex_indices\n",
                  kThreePlaces = "0 0 0\n1 0 0\n0 1 0\n";

std::string ply(const std::string& header, const std::string& body) {
    return "ply\nformat ascii 1.0\n" + header + "end_header\n" + body;
}

std::string replacedOnce(std::string text, const std::string& from, const std::string& to) {
    return text.replace(text.find(from), from.size(), to);
}

const std::string kCorners = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n";

} // namespace

TEST(ObjDialects, LinesGoOnBehindBackslashes) {
    for (const std::string end : {"\n", "\r\n"}) {
        const ImportedMesh mesh = readMesh(
            "lines.obj", "# C:\\folder\\" + end + "v 0 0 \\" + end + "0\nv 1 0 0\nv 1 1 0\n" +
                             "v 0 1 0\nf 1 2\\" + end + "3 \\" + end + "4\n");
        EXPECT_EQ(mesh.mesh.positions.size(), 4u);
        EXPECT_EQ(mesh.mesh.faceSizes, std::vector<std::uint32_t>{4});
    }
    // Directly after the keyword, too.
    for (const std::string end : {"\n", "\r\n"}) {
        const ImportedMesh mesh =
            readMesh("words.obj", "v\\" + end + " 0 0 0\nv 1 0 0\nv 1 1 0\nv " + "0 1 0\nf\\" +
                                      end + "1 2 3 4\n");
        EXPECT_EQ(mesh.mesh.positions.size(), 4u);
        EXPECT_EQ(mesh.mesh.faceSizes, std::vector<std::uint32_t>{4});
    }
    expectError([] { readMesh("end.obj", kSquare + "f 1 2 \\\n9 \\\n3\n"); },
                "end.obj: line 5: \"9\" in a face");
    expectError([] { readMesh("last.obj", kSquare + "f 1 2 \\\n3\nf 1 2 9\n"); }, "line 7: \"9\"");
}

TEST(ObjDialects, CornersMayEndWithSlashes) {
    for (const char* face : {"f 1// 2// 3//", "f 1/ 2/ 3/", "f 1/1/ 2/1/ 3/1/"})
        EXPECT_EQ(readMesh("slash.obj", kSquare + "vt 0 0\n" + face + "\n").mesh.faceSizes.size(),
                  1u);
    for (const char* face : {"f 1/// 2 3", "f / 2 3", "f // 2 3", "f /1 2 3", "f 1/1/1/1 2 3"})
        expectError([&] { readMesh("slash.obj", kSquare + "vt 0 0\nvn 0 0 1\n" + face + "\n"); },
                    "line 7: ");
}

TEST(ObjDialects, NormalsAndTextureCoordinatesMayBeNoNumbers) {
    for (const char* lines :
         {"vn -1.#IND00 1.#QNAN 0\nf 1//1 2//1 3//1\n", "vn nan(ind) inf 0\nf 1//1 2//1 3//1\n",
          "vt nan -1.#INF\nf 1/1 2/1 3/1\n"}) {
        const ImportedMesh mesh = readMesh("broken.obj", kSquare + lines);
        const osg::Geometry& drawn = *mesh.parts.at(0).geometry;
        for (const osg::Vec3& normal : dynamic_cast<const osg::Vec3Array&>(*drawn.getNormalArray()))
            EXPECT_EQ(normal, osg::Vec3(0, 0, 1));
        if (drawn.getTexCoordArray(0) == nullptr) continue;
        for (const osg::Vec2& t : dynamic_cast<const osg::Vec2Array&>(*drawn.getTexCoordArray(0)))
            EXPECT_EQ(t, osg::Vec2());
    }
    expectError([] { readMesh("broken.obj", "v -1.#IND00 0 0\n"); },
                "line 1: \"-1.#IND00\" in a \"v\"");
}

TEST(ObjDialects, FourthNumbersOfVerticesAreToldOf) {
    const test::Notices notices;
    readMesh("weighted.obj",
             "v 0 0 0 1\nv 1 0 0 1.0\nv 0 1 0 0.5\nvt 0 0 0.5\nvn 0 0 1\nf 1 2 3\n");
    EXPECT_TRUE(notices.say("1 of 3 vertices have a fourth number that is not 1"))
        << notices.text();
    const test::Notices none;
    readMesh("unit.obj", "v 0 0 0 1\nv 1 0 0 1\nv 0 1 0 1\nvn 0 0 1\nf 1 2 3\n");
    EXPECT_FALSE(none.say("fourth number")) << none.text();
    const test::Notices before;
    readMesh("both.obj", "v 0 0 0 0.5 1 0 0\nv 1 0 0 1 0 1 0\nv 0 1 0 1 0 0 1\nf 1 2 3\n");
    EXPECT_TRUE(before.say("1 of 3 vertices have a fourth number that is not 1")) << before.text();
}

/// Lines that a person would read as a face or a vertex are not ignored.
TEST(ObjDialects, KeywordsToTheEyeAloneAreRefused) {
    for (const std::string line : {"F 1 2 3", "f\v1 2 3", "\ff 1 2 3",
                                   "\xc2\xa0"
                                   "f 1 2 3",
                                   "\xef\xbb\xbf"
                                   "f 1 2 3",
                                   "f\xc2\xa0"
                                   "1 2 3",
                                   "V 0 0 1", "VN 0 0 1"})
        expectError([&] { readMesh("eye.obj", kSquare + "f 1 2 3\n" + line + "\n"); },
                    "eye.obj: line 6: \"");
    // Other lines are ignored, as always.
    EXPECT_EQ(readMesh("else.obj", kSquare + "Fine 1 2\n\xc3\xa9 1\nvp 1 2\nl 1 2\nf 1 2 3\n")
                  .mesh.triangles()
                  .size(),
              3u);
}

/// "fo", face outline, is the format's old keyword for a face.
TEST(ObjDialects, FacesMayHaveTheirOldName) {
    const ImportedMesh mesh =
        readMesh("old.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nf 1 2 3\nfo 2 4 3\n");
    EXPECT_EQ(mesh.mesh.triangles().size(), 6u);
}

TEST(ObjDialects, SomeVerticesWithColoursAreToldOf) {
    const test::Notices notices;
    readMesh("coloured.obj", "v 0 0 0 1 0 0\nv 1 0 0\nv 0 1 0 0 0 1\nf 1 2 3\n");
    EXPECT_TRUE(notices.say("2 of 3 vertices have colours, which are left out")) << notices.text();
}

TEST(ObjDialects, MaterialsMayHaveOneNumberOrNone) {
    EXPECT_EQ(diffuseBy("Kd 0.25\n"), osg::Vec4(.25f, .25f, .25f, 1));
    EXPECT_EQ(diffuseBy("Kd 0.25 0.5 0.75\nd -halo 0.5\n"), osg::Vec4(.25f, .5f, .75f, 1));
    const osg::Vec4 plain = diffuseBy("Ns 1\n");
    EXPECT_EQ(diffuseBy("Kd spectral file.rfl 1\n"), plain);
    EXPECT_EQ(diffuseBy("Kd nan 0 0\n"), plain);
    EXPECT_EQ(diffuseBy("Kd 0,5 0,5 0,5\n"), plain);
    EXPECT_EQ(diffuseBy(""), plain);
    EXPECT_EQ(diffuseBy("map_Kd -o 1e999 0 0 nowhere.png\n"), plain); // which is ignored
    EXPECT_EQ(diffuseBy("newmtl n\nKd 1 0 0\n"), plain);              // another material's
    EXPECT_EQ(plain, osg::Vec4(.8f, .74f, .68f, 1)) << "as without a library, and not black";
    EXPECT_EQ(diffuseBy("kd 0.25\nD 0.5\n"), osg::Vec4(.25f, .25f, .25f, .5f));
}

TEST(ObjDialects, TexturesThatAreMovedAreToldOf) {
    const test::Notices notices;
    diffuseBy("map_Kd -o 0.5 0 0 -s 1 1 1 nowhere.png\n");
    EXPECT_TRUE(notices.say("dialect.mtl: moved or scaled textures (-o, -s): 1")) << notices.text();
    const test::Notices none;
    diffuseBy("map_Kd -o 0 0 0 -s 1 1 1 -clamp on nowhere.png\n");
    EXPECT_FALSE(none.say("textures (-o")) << none.text();
}

TEST(ObjDialects, CommentsMayFollowFaces) {
    EXPECT_EQ(readMesh("commented.obj", kSquare + "f 1 2 3 4 # a square\nf 1 2 3 #4\n")
                  .mesh.faceVertices.size(),
              7u);
}

TEST(ObjDialects, WhatIsQuotedEndsWithAWholeLetter) {
    const std::string letters(39, 'a');
    expectError([&] { readMesh("word.obj", kSquare + "f 1 2 " + letters + "\xc3\xa4\xc3\xa4\n"); },
                "\"" + letters + "...\" in a face");
}

TEST(ObjDialects, LibrariesAreNoThousands) {
    std::string text;
    for (int k = 0; k < 1001; ++k) text += "mtllib nowhere" + std::to_string(k) + ".mtl\n";
    expectError([&] { readMesh("libraries.obj", text + kSquare + "f 1 2 3\n"); },
                "line 1001: one more material library, expected at most 1000");
}

TEST(ObjDialects, VerticesAtOnePlaceAreNoBody) {
    expectError([] { readMesh("point.obj", "v 1 2 3\nv 1 2 3\nv 1 2 3\nf 1 2 3\n"); },
                "all vertices are at one place, expected a surface");
}

TEST(PlyDialects, WhatIsNoWholeNumberCountsNothing) {
    const std::string floats = replacedOnce(kFaces, "int", "float");
    expectError(
        [&] { readMesh("half.ply", ply(kThreeVertices + floats, kThreePlaces + "3 0 1.5 2\n")); },
        "half.ply: face 0 names vertex 1.5");
    EXPECT_EQ(readMesh("whole.ply", ply(kThreeVertices + floats, kThreePlaces + "3 0 1 2\n"))
                  .mesh.faceSizes.size(),
              1u);
    expectError(
        [&] {
            readMesh("c.ply", ply(replacedOnce(kThreeVertices, "3", "3.7") + kFaces,
                                  kThreePlaces + "3 0 1 2\n"));
        },
        "c.ply: line 3: \"3.7\" elements, expected a whole number");
}

TEST(PlyDialects, BlanksMayEndTheFirstLine) {
    const std::string text = ply(kThreeVertices + kFaces, kThreePlaces + "3 0 1 2\n");
    EXPECT_EQ(readMesh("blank.ply", replacedOnce(text, "ply\n", "ply \t\n")).mesh.faceSizes.size(),
              1u);
    expectError([&] { readMesh("type.ply", replacedOnce(text, "float x", "Float x")); },
                "line 4: \"Float\" is no type of a property, expected one of ");
}

TEST(PlyDialects, WordsBehindTheLastElementAreRefused) {
    // Rows of four numbers, of which the header declares three.
    const std::string longer = "0 0 0 3\n0 1 2 3\n1 0 0 3\n";
    expectError([&] { readMesh("rows.ply", ply(kThreeVertices + kFaces, longer)); },
                "rows.ply: words behind the last element");
    for (const char* end : {"", "\n \r\n", "\n\x1a", "\n\x1a\n"})
        EXPECT_EQ(readMesh("end.ply", ply(kThreeVertices + kFaces, kThreePlaces + "3 0 1 2" + end))
                      .mesh.faceSizes.size(),
                  1u);
    const test::Notices notices;
    readMesh("bytes.ply",
             "ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty uchar x\n"
             "property uchar y\nproperty uchar z\nelement face 1\n"
             "property list uchar uchar vertex_indices\nend_header\n" +
                 "\0\0\0\1\0\0\0\1\0\3\0\1\2\n\n"s);
    EXPECT_TRUE(notices.say("bytes behind the last element, skipped")) << notices.text();
}

TEST(PlyDialects, ALineFeedMayBeTheBodysFirstByte) {
    for (const std::string end : {"\r", "\n", "\r\n"}) {
        std::string text;
        for (const char* line :
             {"ply", "format binary_little_endian 1.0", "element vertex 3", "property uchar x",
              "property uchar y", "property uchar z", "element face 1",
              "property list uchar uchar vertex_indices", "end_header"})
            text += line + end;
        const ImportedMesh mesh = readMesh("feed.ply", text + "\n\0\0\1\0\0\0\1\0\3\0\1\2"s);
        EXPECT_EQ(mesh.mesh.positions.at(0), glm::dvec3(10, 0, 0));
    }
}

TEST(OffDialects, CommentsAndBlankLinesStandAnywhere) {
    const ImportedMesh mesh = readMesh(
        "comments.off", "# made by hand\nOFF # text\n\n4 1 0 # counts\n# places\n \t\n" +
                            replacedOnce(kCorners, "1 1 0\n", "# one more\n1 1 0 # up\n\r\n") +
                            "\n4 0 1 2 3 255 0 0 # red\n");
    EXPECT_EQ(mesh.mesh.positions.size(), 4u);
    EXPECT_EQ(mesh.mesh.faceVertices, (std::vector<std::uint32_t>{0, 1, 2, 3}));
    EXPECT_EQ(diffuseOf(mesh), osg::Vec4(.6f, .6f, .6f, 1));
}

TEST(OffDialects, FacesHaveAnyNumberOfCorners) {
    std::string text = "OFF\n300 3 0\n", face = "300";
    for (int k = 0; k < 300; ++k) {
        const double angle = 2.0 * std::acos(-1.0) * k / 300.0;
        text += std::to_string(std::cos(angle)) + " " + std::to_string(std::sin(angle)) + " 0\n";
        face += " " + std::to_string(k);
    }
    // Points and lines are not faces.
    const ImportedMesh mesh = readMesh("wheel.off", text + "1 0\n" + face + "\n2 0 1\n");
    EXPECT_EQ(mesh.mesh.faceSizes, std::vector<std::uint32_t>{300});
    for (const char* broken :
         {"0", "4 0 1 2", "-3 0 1 2", "3 0 1 4", "3 0 1 1.5", "3.5 0 1 2", "x"})
        expectError([&] { readMesh("broken.off", "OFF\n4 1 0\n" + kCorners + broken + "\n"); },
                    "broken.off: face 0: expected a line with a number of corners and so many");
}

TEST(OffDialects, PartsOfTheKeywordStandInAnyOrder) {
    for (const char* keyword : {"STCNOFF", "NCSTOFF", "CSTNOFF"}) {
        std::string text = std::string(keyword) + "\n3 1 0\n";
        for (const char* at : {"0 0 0", "1 0 0", "0 1 0"})
            text += at + std::string(" 0 0 1 255 0 0 255 .25 .5\n");
        const ImportedMesh mesh = readMesh("ordered.off", text + "3 0 1 2\n");
        const auto* places =
            dynamic_cast<const osg::Vec2Array*>(mesh.parts.at(0).geometry->getTexCoordArray(0));
        ASSERT_NE(places, nullptr) << keyword;
        EXPECT_EQ(places->at(0), osg::Vec2(.25f, .5f)) << keyword;
    }
    expectError([] { readMesh("twice.off", "CCOFF\n3 1 0\n"); }, "\"CCOFF\", expected OFF");
}

TEST(OffDialects, ColoursMayHaveNoAlpha) {
    const auto colourOf = [](const std::string& keyword, const std::string& more) {
        std::string text;
        for (const char* place : {"0 0 0 ", "1 0 0 ", "0 1 0 "}) text += place + more + "\n";
        const ImportedMesh mesh =
            readMesh("colours.off", keyword + "\n3 1 0\n" + text + "3 0 1 2\n");
        return dynamic_cast<const osg::Vec4Array&>(*mesh.parts.at(0).geometry->getColorArray())
            .at(0);
    };
    EXPECT_EQ(colourOf("COFF", "255 0 51"), osg::Vec4(1, 0, .2f, 1));
    EXPECT_EQ(colourOf("COFF", "1 0.5 0"), osg::Vec4(1, .5f, 0, 1));
    EXPECT_EQ(colourOf("COFF", "255 0 51 0"), osg::Vec4(1, 0, .2f, 0));
    EXPECT_EQ(colourOf("STCOFF", "1 0.5 0 0.25 0.75"), osg::Vec4(1, .5f, 0, 1));
}

TEST(OffDialects, NormalsAndTheDivisorAreTheFiles) {
    const ImportedMesh mesh = readMesh("normals.off", "N4OFF\n3 1 0\n0 0 0 2 0 1 1\n2 0 0 2 0 1 1\n"
                                                      "0 2 0 2 0 1 1\n3 0 1 2\n");
    EXPECT_EQ(mesh.mesh.positions.at(1), glm::dvec3(1, 0, 0));
    const auto& normals =
        dynamic_cast<const osg::Vec3Array&>(*mesh.parts.at(0).geometry->getNormalArray());
    EXPECT_NEAR(normals.at(0).y(), std::sqrt(0.5), 1e-6);
}

namespace {

using osgSkin::SkinMesh;

SkinMesh polygon(const std::vector<glm::dvec3>& corners) {
    SkinMesh mesh;
    mesh.positions = corners;
    mesh.faceSizes = {static_cast<std::uint32_t>(corners.size())};
    mesh.faceVertices.resize(corners.size());
    std::iota(mesh.faceVertices.begin(), mesh.faceVertices.end(), 0u);
    return mesh;
}

/// The sum of all areas, and that of triangles that face away from the polygon's side.
struct Areas {
    double all = 0.0, back = 0.0;
};

Areas areasOf(const SkinMesh& mesh) {
    const std::vector<std::uint32_t> triangles = mesh.triangles();
    std::vector<glm::dvec3> normals;
    glm::dvec3 sum(0.0);
    for (std::size_t i = 0; i < triangles.size(); i += 3) {
        const glm::dvec3 &a = mesh.positions[triangles[i]], &b = mesh.positions[triangles[i + 1]],
                         &c = mesh.positions[triangles[i + 2]];
        normals.push_back(0.5 * glm::cross(b - a, c - a));
        sum += normals.back();
    }
    Areas areas;
    for (const glm::dvec3& normal : normals) {
        areas.all += glm::length(normal);
        if (glm::dot(normal, sum) < 0.0) areas.back += glm::length(normal);
    }
    return areas;
}

/// A comb with this many teeth, one wide and two high with gaps of one, on a bar of height one.
std::vector<glm::dvec3> comb(int teeth) {
    std::vector<glm::dvec3> corners{{0, 0, 0}, {2 * teeth - 1, 0, 0}};
    for (int t = teeth - 1; t >= 0; --t) {
        const double right = 2 * t + 1, left = 2 * t;
        if (t < teeth - 1) corners.push_back({right, 1, 0});
        corners.push_back({right, 3, 0});
        corners.push_back({left, 3, 0});
        if (t > 0) corners.push_back({left, 1, 0});
    }
    return corners;
}

} // namespace

TEST(Polygons, ConcaveOnesAreCutWithinTheirOutline) {
    const std::vector<std::pair<std::vector<glm::dvec3>, double>> outlines{
        {{{0, 0, 0}, {4, 0, 0}, {1, 1, 0}, {0, 4, 0}}, 4.0},
        {{{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1, 1, 0}, {1, 2, 0}, {0, 2, 0}}, 3.0},
        {comb(2), 7.0},
        {comb(40), 159.0}};
    for (const auto& [outline, area] : outlines)
        for (std::size_t first = 0; first < outline.size(); ++first)
            for (const bool turned : {false, true}) {
                std::vector<glm::dvec3> corners(outline.begin() + std::ptrdiff_t(first),
                                                outline.end());
                corners.insert(corners.end(), outline.begin(),
                               outline.begin() + std::ptrdiff_t(first));
                if (turned) // in another plane, far from the origin
                    for (glm::dvec3& c : corners) c = glm::dvec3(1e3 - c.y, 1e3, c.x);
                const SkinMesh mesh = polygon(corners);
                EXPECT_EQ(mesh.triangles().size(), 3 * (outline.size() - 2));
                const Areas areas = areasOf(mesh);
                EXPECT_NEAR(areas.all, area, 1e-6) << outline.size() << " from " << first;
                EXPECT_LT(areas.back, 1e-6) << outline.size() << " from " << first;
            }
}

TEST(Polygons, ConvexOnesAreFans) {
    const SkinMesh mesh = polygon({{0, 0, 0}, {2, 0, 0}, {2, 1, 0.1}, {1, 2, 0}, {0, 1, 0}});
    EXPECT_EQ(mesh.triangles(), (std::vector<std::uint32_t>{0, 1, 2, 0, 2, 3, 0, 3, 4}));
}

/// A bent polygon has no plane in which everyone would find the same concave corners.
TEST(Polygons, BentOnesAreCutAlikeHoweverTheyStand) {
    std::mt19937 random(12);
    std::uniform_real_distribution<double> number(-1.0, 1.0);
    int cut = 0;
    for (int i = 0; i < 200; ++i) {
        std::vector<glm::dvec3> corners, turned;
        for (int k = 0; k < 4 + i % 4; ++k)
            corners.emplace_back(number(random), number(random), 0.7 * number(random));
        const glm::dquat turn = glm::normalize(
            glm::dquat(number(random), number(random), number(random), number(random)));
        for (const glm::dvec3& corner : corners) turned.push_back(turn * corner);
        const std::vector<std::uint32_t> as = polygon(corners).triangles();
        EXPECT_EQ(as, polygon(turned).triangles()) << i;
        cut += as[3] != 0; // not a fan
    }
    EXPECT_GT(cut, 40);
}

TEST(Polygons, WithoutAreaOrInnerAreCutSomehow) {
    for (const std::vector<glm::dvec3>& corners :
         {std::vector<glm::dvec3>(5, {1, 1, 1}),
          std::vector<glm::dvec3>{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {1, 0, 0}},
          std::vector<glm::dvec3>{{0, 0, 0}, {1, 1, 0}, {1, 0, 0}, {0, 1, 0}},
          std::vector<glm::dvec3>{
              {-1e18, 0, 0}, {1e18, 0, 0}, {0, 1e-300, 0}, {0, 1e18, 0}, {1, 1, 1}}})
        EXPECT_EQ(polygon(corners).triangles().size(), 3 * (corners.size() - 2));
}

/// A zigzag that winds back, whose ears are blocked by the corners between.
TEST(Polygons, TakeNoMinutes) {
    const std::clock_t begin = std::clock();
    std::vector<glm::dvec3> corners;
    const int turns = 20'000;
    corners.reserve(2 * std::size_t(turns));
    for (int k = 0; k < turns; ++k) corners.push_back({k, k % 2 == 0 ? 0.0 : 1000.0, 0});
    for (int k = turns; k-- > 0;) corners.push_back({k, k % 2 == 0 ? 0.5 : 1000.5, 0});
    EXPECT_EQ(polygon(corners).triangles().size(), 3 * (corners.size() - 2));
    EXPECT_LT(double(std::clock() - begin) / CLOCKS_PER_SEC, 8.0);
}

TEST(Polygons, AreDrawnAsTheyAreBound) {
    const std::string path = testing::TempDir() + "concave.obj";
    std::ofstream(path) << "v 0 0 0\nv 4 0 0\nv 1 1 0\nv 0 4 0\nvt 0 0\nvt 1 0\nvt 2 0\nvt 3 0\n"
                           "f 2/2 3/3 4/4 1/1\n";
    const osgSkin::ImportedMesh mesh = osgSkin::importMesh(path);
    ASSERT_EQ(mesh.parts.size(), 1u);
    const osg::Geometry& geometry = *mesh.parts[0].geometry;
    const auto& texCoords = dynamic_cast<const osg::Vec2Array&>(*geometry.getTexCoordArray(0));
    const osg::PrimitiveSet& drawn = *geometry.getPrimitiveSet(0);
    const std::vector<std::uint32_t> bound = mesh.mesh.triangles();
    ASSERT_EQ(drawn.getNumIndices(), bound.size());
    for (unsigned int k = 0; k < drawn.getNumIndices(); ++k) {
        EXPECT_EQ(mesh.parts[0].sourceVertex[drawn.index(k)], bound[k]);
        EXPECT_EQ(texCoords[drawn.index(k)].x(), float(bound[k]));
    }
    EXPECT_NEAR(areasOf(mesh.mesh).all, 4.0, 1e-9);
}
