// SPDX-License-Identifier: MIT
// Colours and textures of mesh files, and the warnings about them.
#include "MeshParts.h"
#include "Notices.h"

#include <osgSkin/Error>
#include <osgSkinImport/ReadLimits>

#include <gtest/gtest.h>
#include <osg/Image>
#include <osg/Material>
#include <osgDB/WriteFile>

#include <algorithm>
#include <fstream>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace {

using osgSkin::ImportedMesh;

const std::string kTriangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";

/// A PLY triangle with more properties of vertices and faces.
std::string ply(const std::string& comments, const std::string& vertex, const std::string& faces,
                const std::string& body) {
    return "ply\nformat ascii 1.0\n" + comments +
           "element vertex 3\nproperty float x\nproperty float y\nproperty float z\n" + vertex +
           "element face " + faces + "end_header\n" + body;
}

void saveImage(const std::string& name, unsigned char grey) {
    const osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(2, 2, 1, GL_RGB, GL_UNSIGNED_BYTE);
    std::fill(image->data(), image->data() + image->getTotalSizeInBytes(), grey);
    ASSERT_TRUE(osgDB::writeImageFile(*image, testing::TempDir() + name));
}

} // namespace

TEST(MeshMaterials, ReadsObjColours) {
    const osg::Vec4 red(1, 0, 0, 1), mixed(0, 0.5f, 1, 1), dark(0, 51.0f / 255.0f, 0.4f, 1);
    const struct {
        const char *first, *second;
        osg::Vec4 expected[2];
    } cases[] = {
        {"1 0 0", "0 0.5 1", {red, mixed}},
        {"255 0 0", "0 51 102", {red, dark}},
        {"1 0.25 0.5 0.75", "1 0 0.5 1", {{0.25f, 0.5f, 0.75f, 1}, mixed}}, // after a weight
        // Brighter than white is allowed, in either range.
        {"2.5 0 0", "0 0.5 1", {red, mixed}},
        {"300 0 0", "0 1 1", {red, {0, 1, 1, 1}}},
    };
    for (const auto& c : cases) {
        const std::string weight = std::string(c.first).size() > 10 ? "1 " : "";
        const ImportedMesh mesh =
            readMesh("coloured.obj", std::string("v 0 0 0 ") + c.first + "\nv 1 0 0 " + c.second +
                                         "\nv 0 1 0 " + weight + "0 0 0\nf 1 2 3\n");
        for (std::size_t v = 0; v < 2; ++v)
            EXPECT_LT((coloursOf(mesh)[v] - c.expected[v]).length(), 1e-6f) << c.first << v;
    }
}

/// Integer colours range up to the maximum of their type, but up to 255 if no number is larger.
TEST(MeshMaterials, PlyColoursRangeByType) {
    const osg::Vec4 mixed(0, 51.0f / 255.0f, 1, 1);
    const struct {
        const char *type, *first, *second;
        osg::Vec4 expected;
    } cases[] = {{"uchar", "255 0 0", "0 51 255", mixed},
                 {"short", "255 0 0", "0 51 255", mixed},
                 {"ushort", "255 0 0", "0 51 255", mixed},
                 {"int", "255 0 0", "0 51 255", mixed},
                 {"uint", "255 0 0", "0 51 255", mixed},
                 {"ushort", "65535 0 0", "0 13107 65535", mixed},
                 {"uint", "4294967295 0 0", "0 858993459 4294967295", mixed},
                 {"float", "127.5 0 0", "0 51 255", mixed},
                 {"double", "0.5 0 0", "0 0.2 1", {0, .2f, 1, 1}}};
    for (const auto& c : cases) {
        std::string properties;
        for (const char* part : {"red", "green", "blue"})
            properties += std::string("property ") + c.type + ' ' + part + '\n';
        const ImportedMesh mesh = readMesh(
            "colours.ply", ply("", properties, "1\nproperty list uchar int vertex_indices\n",
                               std::string("0 0 0 ") + c.first + "\n1 0 0 " + c.second +
                                   "\n0 1 0 0 0 0\n3 0 1 2\n"));
        EXPECT_EQ(coloursOf(mesh).at(1), c.expected) << c.type << ' ' << c.first;
    }
    const ImportedMesh floats =
        readMesh("floats.ply", ply("",
                                   "property float red\nproperty float green\nproperty float blue\n"
                                   "property float alpha\n",
                                   "1\nproperty list uchar int vertex_indices\n",
                                   "0 0 0 255 0 0 255\n1 0 0 0 51 0 51\n0 1 0 0 0 0 0\n3 0 1 2\n"));
    EXPECT_EQ(coloursOf(floats).at(0), osg::Vec4(1, 0, 0, 1));
    EXPECT_EQ(coloursOf(floats).at(1), osg::Vec4(0, 51.0f / 255.0f, 0, 51.0f / 255.0f));
}

TEST(MeshMaterials, PlyFacesNameTheirTextures) {
    saveImage("dark.png", 40);
    saveImage("light.png", 200);
    const ImportedMesh mesh = readMesh(
        "textures.ply",
        ply("comment TextureFile dark.png\ncomment TextureFile light.png\n", "",
            "5\nproperty list uchar int vertex_indices\nproperty list uchar float texcoord\n"
            "property int texnumber\n",
            "0 0 0\n1 0 0\n0 1 0\n3 0 1 2 6 0 0 1 0 0 1 1\n3 0 1 2 6 0 0 1 0 0 1 0\n"
            "3 0 1 2 6 0 0 1 0 0 1 -1\n3 0 1 2 6 0 0 1 0 0 1 7\n3 0 1 2 6 0 0 1 0 0 1 1\n"));
    std::map<int, std::vector<std::uint32_t>> faces; // by grey value; -1: no texture
    for (const osgSkin::MeshPart& part : mesh.parts)
        faces[imageOf(part) ? int(*imageOf(part)->data()) : -1] = part.sourceFace;
    EXPECT_EQ(faces[40], (std::vector<std::uint32_t>{1}));
    EXPECT_EQ(faces[200], (std::vector<std::uint32_t>{0, 4}));
    EXPECT_EQ(faces[-1], (std::vector<std::uint32_t>{2, 3}));
}

TEST(MeshMaterials, IgnoresPlyTextureWithoutName) {
    const test::Notices notices;
    const ImportedMesh mesh = readMesh(
        "nameless.ply",
        ply("comment TextureFile\n", "",
            "1\nproperty list uchar int vertex_indices\nproperty list uchar float texcoord\n",
            "0 0 0\n1 0 0\n0 1 0\n3 0 1 2 6 0 0 1 0 0 1\n"));
    EXPECT_EQ(imageOf(mesh.parts.at(0)), nullptr);
    EXPECT_EQ(notices.text(), "");
}

TEST(MeshMaterials, WarningsContainNoControlCharacters) {
    test::saveText("evil.mtl", "newmtl m\nmap_Kd no\x1b]0;title\x07where\xc2\x9b.png\n");
    const test::Notices notices;
    readMesh("evil.obj", "mtllib evil.mtl\n" + kTriangle + "usemtl m\nf 1 2 3\n");
    EXPECT_TRUE(notices.say("where")) << notices.text();
    for (const char* control : {"\x1b", "\x07", "\x9b"})
        EXPECT_FALSE(notices.say(control)) << notices.text();
    EXPECT_EQ(notices.lines(), 1u);
    EXPECT_EQ(osgSkin::onOneLine("caf\xc3\xa9 \xe2\x82\xac\r\n"), "caf\xc3\xa9 \xe2\x82\xac");
    EXPECT_STREQ(osgSkin::Error("joint \"a\x1b[2Jb\nc\x7f\"\n").what(), "joint \"a [2Jb c \"");
}

TEST(MeshMaterials, ClampsMaterialColours) {
    test::saveText("bright.mtl", "newmtl m\nKd 255 51 0\nKs 1.5 -1 0.5\nd -5\nmap_d hair.png\n");
    const test::Notices notices;
    const ImportedMesh mesh =
        readMesh("bright.obj", "mtllib bright.mtl\n" + kTriangle + "usemtl m\nf 1 2 3\n");
    EXPECT_TRUE(notices.say("textures left out: map_d (1)")) << notices.text();
    EXPECT_EQ(diffuseOf(mesh), osg::Vec4(1.0f, 0.2f, 0.0f, 1.0f));
    EXPECT_EQ(materialOf(mesh).getSpecular(osg::Material::FRONT),
              osg::Vec4(1.0f, 0.0f, 0.5f, 1.0f));
}

TEST(MeshMaterials, MissingEmissionTextureDoesNotGlow) {
    test::saveText("glow.mtl", "newmtl m\nmap_Ke eyes.png\nKd 1 0 0\nKe 1 1 1\nnewmtl n\n"
                               "Kd 1 0 0\nKe 0 1 0\n");
    const test::Notices notices;
    const ImportedMesh mesh = readMesh("glow.obj", "mtllib glow.mtl\n" + kTriangle +
                                                       "usemtl m\nf 1 2 3\nusemtl n\nf 3 2 1\n");
    EXPECT_TRUE(notices.say("texture \"eyes.png\" cannot be read; drawn without"))
        << notices.text();
    EXPECT_EQ(emissionOf(mesh, 0), osg::Vec4(0, 0, 0, 1));
    EXPECT_EQ(emissionOf(mesh, 1), osg::Vec4(0, 1, 0, 1));
}

TEST(ReadLimits, ParsesQuotedOptionValues) {
    const osg::ref_ptr<osgDB::Options> options = new osgDB::Options(
        "motion=\"run maxJoints=none formats=bvh\" maxDepth=\"7\"\tmaxUses=3\nnoise");
    const osgSkin::ReadLimits limits = osgSkin::ReadLimits::of(options);
    EXPECT_EQ(limits.joints, osgSkin::ReadLimits().joints);
    EXPECT_TRUE(limits.formats.empty());
    EXPECT_EQ(limits.depth, 7u);
    EXPECT_EQ(limits.uses, 3u);
    using Words = std::vector<std::pair<std::string, std::string>>;
    EXPECT_EQ(osgSkin::optionValues(" a b= c=\"d e\"f g=\"h"),
              (Words{{"a", ""}, {"b", ""}, {"c", "d e"}, {"f", ""}, {"g", "h"}}));
    EXPECT_EQ(osgSkin::optionValues("a=\"").size(), 1u);
    EXPECT_TRUE(osgSkin::optionValues(" \n").empty());
}

/// Three quads: two materials that differ in their colour alone, and one that shines.
TEST(MeshMaterials, MergesColours) {
    const std::string folder = testing::TempDir();
    std::ofstream(folder + "merged.mtl") << "newmtl red\nKd 1 0 0\nnewmtl blue\nKd 0 0 1\nnewmtl "
                                            "bright\nKd 0 1 0\nKs 1 1 1\nNs 90\n";
    std::ofstream(folder + "merged.obj")
        << "mtllib merged.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nv 2 0 0\nusemtl red\nf 1 2 3\n"
           "usemtl blue\nf 2 4 3\nusemtl bright\nf 2 5 4\n";
    EXPECT_EQ(osgSkin::importMesh(folder + "merged.obj").parts.size(), 3u);
    const osg::ref_ptr<osgDB::Options> options = new osgDB::Options("colours=merged");
    const ImportedMesh mesh = osgSkin::importMesh(folder + "merged.obj", options);
    ASSERT_EQ(mesh.parts.size(), 2u);
    const osg::Geometry& merged = *mesh.parts[0].geometry;
    const auto& colours = static_cast<const osg::Vec4Array&>(*merged.getColorArray());
    const auto count = [&](const osg::Vec4& colour) {
        return std::count(colours.begin(), colours.end(), colour);
    };
    EXPECT_EQ(count({1, 0, 0, 1}), 3);
    EXPECT_EQ(count({0, 0, 1, 1}), 3);
    const auto* material = static_cast<const osg::Material*>(
        merged.getStateSet()->getAttribute(osg::StateAttribute::MATERIAL));
    EXPECT_EQ(material->getColorMode(), osg::Material::AMBIENT_AND_DIFFUSE);
    // The faces and vertices of the mesh stay.
    EXPECT_EQ(mesh.parts[0].sourceFace, (std::vector<std::uint32_t>{0, 1}));
    EXPECT_EQ(mesh.mesh.positions.size(), 5u);
    EXPECT_THROW(osgSkin::importMesh(folder + "merged.obj", new osgDB::Options("colours=some")),
                 osgSkin::Error);
}
