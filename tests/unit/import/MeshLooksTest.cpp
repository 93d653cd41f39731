// SPDX-License-Identifier: MIT
// What mesh files say of looks: colours in either range, several textures; and what is told of
// them.
#include "ExpectError.h"
#include "Notices.h"

#include <osgSkin/Error>
#include <osgSkinImport/ImportMesh>
#include <osgSkinImport/ReadLimits>

#include <osg/Image>
#include <osg/Material>
#include <osg/Texture2D>
#include <osgDB/WriteFile>

#include <algorithm>
#include <fstream>
#include <map>

namespace {

std::string saveLooks(const std::string& name, const std::string& text) {
    std::string path = testing::TempDir() + "osgskin_looks_" + name;
    std::ofstream(path, std::ios::binary) << text;
    return path;
}

/// A triangle whose vertices have colours.
std::string coloured(const char* red, const char* mixed) {
    return std::string("v 0 0 0 ") + red + "\nv 1 0 0 " + mixed + "\nv 0 1 0 0 0 0\nf 1 2 3\n";
}

osg::Vec4 colourOf(const std::string& path, std::size_t vertex) {
    const osgSkin::ImportedMesh mesh = osgSkin::importMesh(path);
    return dynamic_cast<const osg::Vec4Array&>(*mesh.parts[0].geometry->getColorArray())[vertex];
}

void saveImage(const std::string& name, unsigned char grey) {
    const osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(2, 2, 1, GL_RGB, GL_UNSIGNED_BYTE);
    std::fill(image->data(), image->data() + image->getTotalSizeInBytes(), grey);
    ASSERT_TRUE(osgDB::writeImageFile(*image, testing::TempDir() + name));
}

/// The grey of a part's texture; -1: it has none.
int greyOf(const osgSkin::MeshPart& part) {
    const auto* texture = dynamic_cast<const osg::Texture2D*>(
        part.geometry->getStateSet()->getTextureAttribute(0, osg::StateAttribute::TEXTURE));
    return texture ? int(*texture->getImage()->data()) : -1;
}

} // namespace

TEST(MeshLooks, ColoursFollowTheWeightWhereThereIsOne) {
    EXPECT_EQ(colourOf(saveLooks("seven.obj", "v 0 0 0 1 0.25 0.5 0.75\nv 1 0 0 1 0 0.5 1\n"
                                              "v 0 1 0 1 0 0 0\nf 1 2 3\n"),
                       0),
              osg::Vec4(0.25f, 0.5f, 0.75f, 1.0f));
}

TEST(MeshLooks, ColoursCountTo1OrTo255) {
    const osg::Vec4 red(1, 0, 0, 1), mixed(0, 0.5f, 1, 1);
    const std::string ones = saveLooks("ones.obj", coloured("1 0 0", "0 0.5 1"));
    EXPECT_EQ(colourOf(ones, 0), red);
    EXPECT_EQ(colourOf(ones, 1), mixed);
    const std::string bytes = saveLooks("bytes.obj", coloured("255 0 0", "0 51 102"));
    EXPECT_EQ(colourOf(bytes, 0), red);
    EXPECT_EQ(colourOf(bytes, 1), osg::Vec4(0.0f, 51.0f / 255.0f, 102.0f / 255.0f, 1.0f));
    // Brighter than white it may be, in either range.
    EXPECT_EQ(colourOf(saveLooks("bright.obj", coloured("2.5 0 0", "0 0.5 1")), 1), mixed);
    EXPECT_EQ(colourOf(saveLooks("brighter.obj", coloured("300 0 0", "0 1 1")), 0), red);
    const std::string floats = saveLooks(
        "floats.ply", "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float "
                      "y\nproperty float z\nproperty float red\nproperty float green\nproperty "
                      "float blue\nproperty float alpha\nelement face 1\nproperty list uchar int "
                      "vertex_indices\nend_header\n0 0 0 255 0 0 255\n1 0 0 0 51 0 51\n0 1 0 0 0 0 "
                      "0\n3 0 1 2\n");
    EXPECT_EQ(colourOf(floats, 0), red);
    EXPECT_EQ(colourOf(floats, 1), osg::Vec4(0.0f, 51.0f / 255.0f, 0.0f, 51.0f / 255.0f));
}

/// Colours of whole types count as far as their numbers do; what is as bright as no light counts to
/// 255, too.
TEST(MeshLooks, PlyColoursCountAsTheirNumbersDo) {
    const auto second = [](const std::string& type, const char* first, const char* next) {
        std::string header = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\n"
                             "property float y\nproperty float z\n";
        for (const char* part : {"red", "green", "blue"})
            header += "property " + type + ' ' + part + '\n';
        return colourOf(saveLooks(type + ".ply", header +
                                                     "element face 1\nproperty list uchar int "
                                                     "vertex_indices\nend_header\n0 0 0 " +
                                                     first + "\n1 0 0 " + next +
                                                     "\n0 1 0 0 0 0\n3 0 1 2\n"),
                        1);
    };
    const osg::Vec4 expected(0, 51.0f / 255.0f, 1, 1);
    for (const char* type : {"uchar", "short", "ushort", "int", "uint"})
        EXPECT_EQ(second(type, "255 0 0", "0 51 255"), expected) << type;
    EXPECT_EQ(second("ushort", "65535 0 0", "0 13107 65535"), expected);
    EXPECT_EQ(second("uint", "4294967295 0 0", "0 858993459 4294967295"), expected);
    EXPECT_EQ(second("float", "127.5 0 0", "0 51 255"), expected);
    EXPECT_EQ(second("double", "0.5 0 0", "0 0.2 1"), osg::Vec4(0, .2f, 1, 1));
}

TEST(MeshLooks, PlyFacesHaveTheTexturesThatTheyName) {
    saveImage("osgskin_looks_dark.png", 40);
    saveImage("osgskin_looks_light.png", 200);
    const std::string path = saveLooks(
        "textures.ply",
        "ply\nformat ascii 1.0\ncomment TextureFile osgskin_looks_dark.png\ncomment TextureFile "
        "osgskin_looks_light.png\nelement vertex 3\nproperty float x\nproperty float y\nproperty "
        "float z\nelement face 5\nproperty list uchar int vertex_indices\nproperty list uchar "
        "float texcoord\nproperty int texnumber\nend_header\n0 0 0\n1 0 0\n0 1 0\n"
        "3 0 1 2 6 0 0 1 0 0 1 1\n3 0 1 2 6 0 0 1 0 0 1 0\n3 0 1 2 6 0 0 1 0 0 1 -1\n"
        "3 0 1 2 6 0 0 1 0 0 1 7\n3 0 1 2 6 0 0 1 0 0 1 1\n");
    const osgSkin::ImportedMesh mesh = osgSkin::importMesh(path);
    std::map<int, std::vector<std::uint32_t>> faces;
    for (const osgSkin::MeshPart& part : mesh.parts) faces[greyOf(part)] = part.sourceFace;
    EXPECT_EQ(faces[40], (std::vector<std::uint32_t>{1}));
    EXPECT_EQ(faces[200], (std::vector<std::uint32_t>{0, 4}));
    EXPECT_EQ(faces[-1], (std::vector<std::uint32_t>{2, 3}));
}

TEST(MeshLooks, APlyTextureWithoutANameIsNone) {
    const std::string path = saveLooks(
        "nameless.ply",
        "ply\nformat ascii 1.0\ncomment TextureFile\nelement vertex 3\nproperty float x\nproperty "
        "float y\nproperty float z\nelement face 1\nproperty list uchar int vertex_indices\n"
        "property list uchar float texcoord\nend_header\n0 0 0\n1 0 0\n0 1 0\n"
        "3 0 1 2 6 0 0 1 0 0 1\n");
    const test::Notices notices;
    EXPECT_EQ(greyOf(osgSkin::importMesh(path).parts.at(0)), -1);
    EXPECT_EQ(notices.text(), "");
}

TEST(MeshLooks, NothingThatIsToldReachesTheTerminal) {
    const std::string evil = "no\x1b]0;title\x07where\xc2\x9b.png";
    saveLooks("evil.mtl", "newmtl m\nmap_Kd " + evil + "\n");
    const std::string path =
        saveLooks("evil.obj", "mtllib osgskin_looks_evil.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\n"
                              "usemtl m\nf 1 2 3\n");
    const test::Notices notices;
    osgSkin::importMesh(path);
    EXPECT_TRUE(notices.say("where")) << notices.text();
    for (const char* control : {"\x1b", "\x07", "\x9b"})
        EXPECT_FALSE(notices.say(control)) << notices.text();
    EXPECT_EQ(notices.lines(), 1u);
    EXPECT_EQ(osgSkin::onOneLine("caf\xc3\xa9 \xe2\x82\xac\r\n"), "caf\xc3\xa9 \xe2\x82\xac");
    EXPECT_STREQ(osgSkin::Error("joint \"a\x1b[2Jb\nc\x7f\"\n").what(), "joint \"a [2Jb c \"");
}

TEST(MeshLooks, QuotedValuesAreNoOptionsOfTheirOwn) {
    const auto limitsOf = [](const char* words) {
        const osg::ref_ptr<osgDB::Options> options = new osgDB::Options(words);
        return osgSkin::ReadLimits::of(options);
    };
    const osgSkin::ReadLimits limits =
        limitsOf("motion=\"run maxJoints=none formats=bvh\" maxDepth=\"7\"\tmaxUses=3\nnoise");
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

TEST(MeshLooks, ColoursOfMaterialsAreOnes) {
    const std::string path = testing::TempDir() + "bright.obj";
    std::ofstream(path) << "mtllib bright.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl m\nf 1 2 3\n";
    std::ofstream(testing::TempDir() + "bright.mtl")
        << "newmtl m\nKd 255 51 0\nKs 1.5 -1 0.5\nd -5\nmap_d hair.png\n";
    const test::Notices notices;
    const osgSkin::ImportedMesh mesh = osgSkin::importMesh(path);
    EXPECT_TRUE(notices.say("textures of opacity (map_d): 1, left out")) << notices.text();
    const auto& material = dynamic_cast<const osg::Material&>(
        *mesh.parts.at(0).geometry->getStateSet()->getAttribute(osg::StateAttribute::MATERIAL));
    EXPECT_EQ(material.getDiffuse(osg::Material::FRONT), osg::Vec4(1.0f, 0.2f, 0.0f, 1.0f));
    EXPECT_EQ(material.getSpecular(osg::Material::FRONT), osg::Vec4(1.0f, 0.0f, 0.5f, 1.0f));
}

TEST(MeshLooks, TexturesOfEmissionAreToldOf) {
    const std::string path = testing::TempDir() + "glow.obj";
    std::ofstream(path) << "mtllib glow.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl m\nf 1 2 3\n"
                           "usemtl n\nf 3 2 1\n";
    std::ofstream(testing::TempDir() + "glow.mtl")
        << "newmtl m\nmap_Ke eyes.png\nKd 1 0 0\nKe 1 1 1\nnewmtl n\nKd 1 0 0\nKe 0 1 0\n";
    const test::Notices notices;
    const osgSkin::ImportedMesh mesh = osgSkin::importMesh(path);
    EXPECT_TRUE(notices.say("textures of emission (map_Ke): 1, left out")) << notices.text();
    const auto emission = [&](std::size_t part) {
        return dynamic_cast<const osg::Material&>(
                   *mesh.parts.at(part).geometry->getStateSet()->getAttribute(
                       osg::StateAttribute::MATERIAL))
            .getEmission(osg::Material::FRONT);
    };
    EXPECT_EQ(emission(0), osg::Vec4(0, 0, 0, 1));
    EXPECT_EQ(emission(1), osg::Vec4(0, 1, 0, 1));
}
