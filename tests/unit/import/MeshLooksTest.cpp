// SPDX-License-Identifier: MIT
//
// Material features of mesh files: colours in either range, several textures; and the warnings.
//
// Images of meshes: their formats, their sizes, and broken ones.
//
// Pictures that are named, or stored, more often than there are files.
#include "ExpectError.h"
#include "GltfBuilder.h"
#include "Notices.h"
#include "PictureFiles.h"

#include <osgSkin/Error>
#include <osgSkinImport/ImportMesh>
#include <osgSkinImport/ReadLimits>
#include <osgSkinImport/ReadScene>
#include <osgSkinImport/ShareImages>

#include <osg/Group>
#include <osg/Image>
#include <osg/Material>
#include <osg/Texture2D>
#include <osgDB/WriteFile>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

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

/// The grey value of a part's texture; -1 if it has none.
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
    // Brighter than white is allowed, in either range.
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

/// Integer colours range up to the maximum of their type, but up to 255 if no number is larger.
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
    EXPECT_TRUE(notices.say("textures left out: map_d (1)")) << notices.text();
    const auto& material = dynamic_cast<const osg::Material&>(
        *mesh.parts.at(0).geometry->getStateSet()->getAttribute(osg::StateAttribute::MATERIAL));
    EXPECT_EQ(material.getDiffuse(osg::Material::FRONT), osg::Vec4(1.0f, 0.2f, 0.0f, 1.0f));
    EXPECT_EQ(material.getSpecular(osg::Material::FRONT), osg::Vec4(1.0f, 0.0f, 0.5f, 1.0f));
}

TEST(MeshLooks, AnEmissionTextureThatIsMissingDoesNotGlow) {
    const std::string path = testing::TempDir() + "glow.obj";
    std::ofstream(path) << "mtllib glow.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl m\nf 1 2 3\n"
                           "usemtl n\nf 3 2 1\n";
    std::ofstream(testing::TempDir() + "glow.mtl")
        << "newmtl m\nmap_Ke eyes.png\nKd 1 0 0\nKe 1 1 1\nnewmtl n\nKd 1 0 0\nKe 0 1 0\n";
    const test::Notices notices;
    const osgSkin::ImportedMesh mesh = osgSkin::importMesh(path);
    EXPECT_TRUE(notices.say("texture \"eyes.png\" cannot be read; drawn without"))
        << notices.text();
    const auto emission = [&](std::size_t part) {
        return dynamic_cast<const osg::Material&>(
                   *mesh.parts.at(part).geometry->getStateSet()->getAttribute(
                       osg::StateAttribute::MATERIAL))
            .getEmission(osg::Material::FRONT);
    };
    EXPECT_EQ(emission(0), osg::Vec4(0, 0, 0, 1));
    EXPECT_EQ(emission(1), osg::Vec4(0, 1, 0, 1));
}

namespace {

using std::string_literals::operator""s;
using test::big;
using test::Drawn;
using test::drawnWith;
using test::expectRefused;
using test::little;
using test::savePicture;
using test::with;
using test::written;

/// A TGA picture of 5 x 3 pixels.
/// \param kind 1: palette of two colours, 2: true colour; plus 8: compressed
/// \param pixels data
std::string tga(int kind, const std::string& pixels) {
    const bool mapped = (kind & 7) == 1;
    return little(0, 1) + little(mapped ? 1 : 0, 1) + little(std::uint32_t(kind), 1) +
           little(0, 2) + little(mapped ? 2 : 0, 2) + little(mapped ? 24 : 0, 1) + little(0, 4) +
           little(5, 2) + little(3, 2) + little(mapped ? 8 : 24, 1) + little(0, 1) +
           (mapped ? "\x01\x02\x03\x04\x05\x06" : "") + pixels;
}

} // namespace

TEST(Pictures, OfEachFormatAreDrawn) {
    for (const char* extension :
         {"png", "jpg", "jpeg", "bmp", "tga", "rgb", "ppm", "tif", "tiff", "dds"}) {
        const std::string content = written(extension);
        if (content.empty()) continue; // no such writer
        const std::string name = std::string("whole.") + extension;
        savePicture(name, content);
        const Drawn drawn = drawnWith(name);
        ASSERT_TRUE(drawn.image.valid()) << drawn.notices;
        EXPECT_EQ(drawn.image->s(), 5) << extension;
        EXPECT_EQ(drawn.image->t(), 3) << extension;
    }
    const std::string row = "\x84"
                            "abc";
    const std::pair<const char*, std::string> others[] = {
        {"plain.tga", tga(2, std::string(45, 'c'))},
        {"packed.tga", tga(10, row + row + row)},
        {"mapped.tga", tga(1, std::string(15, '\1'))}};
    for (const auto& [name, content] : others) {
        savePicture(name, content);
        const Drawn drawn = drawnWith(name);
        ASSERT_TRUE(drawn.image.valid()) << drawn.notices;
        EXPECT_EQ(drawn.image->s(), 5) << name;
    }
}

TEST(Pictures, AreWhatOpenSceneGraphReads) {
    for (const char* extension : {"png", "bmp", "tga", "jpg"}) {
        SCOPED_TRACE(extension);
        const std::string content = written(extension);
        if (content.empty()) continue; // no such writer
        const std::string name = std::string("same.") + extension;
        savePicture(name, content);
        const Drawn drawn = drawnWith(name);
        ASSERT_TRUE(drawn.image.valid()) << drawn.notices;
        const osg::ref_ptr<osg::Image> theirs = osgDB::readRefImageFile(testing::TempDir() + name);
        ASSERT_TRUE(theirs.valid());
        const osg::Vec4::value_type most = // JPEG decoders may round differently
            extension == std::string("jpg") ? 6.0f / 255.0f : 0.0f;
        for (unsigned y = 0; y < 3; ++y)
            for (unsigned x = 0; x < 5; ++x) {
                const osg::Vec4 ours = drawn.image->getColor(x, y), other = theirs->getColor(x, y);
                for (int k = 0; k < 4; ++k) EXPECT_NEAR(ours[k], other[k], most) << x << ' ' << y;
            }
    }
}

TEST(Pictures, AreAsLargeAsTheirFilesAreWorth) {
    const std::string png = with(written("png"), 16, big(15000, 4) + big(15000, 4));
    expectRefused("large.png", png, "a picture of 15000 x 15000 pixels, expected at most 1677");
    expectRefused("wide.png", with(png, 16, big(70000, 4) + big(1, 4)),
                  "of 70000 x 1 pixels, expected 1 to 65536");
    expectRefused("none.png", with(png, 16, big(0, 4)), "cannot be decoded as a picture");
    const std::string jpg = written("jpg");
    const std::size_t frame = jpg.find("\xff\xc0");
    ASSERT_NE(frame, std::string::npos);
    expectRefused("large.jpg", with(jpg, frame + 5, big(60000, 2) + big(60000, 2)),
                  "60000 x 60000 pixels, expected at most");
    expectRefused("large.tga", with(tga(2, {}), 12, little(60000, 2) + little(60000, 2)),
                  "60000 x 60000 pixels, expected at most");
    savePicture("small.png", written("png"));
    EXPECT_TRUE(drawnWith("small.png", "maxPixels=1").image.valid());
    expectRefused("option.png", with(written("png"), 16, big(300, 4) + big(300, 4)),
                  "(option maxPixels)", "maxPixels=100");
}

TEST(Pictures, ThatAreBrokenAreLeftOut) {
    const std::string png = written("png"), reason = "cannot be decoded as a picture";
    const std::size_t pixels = png.find("IDAT"), end = png.find("IEND");
    ASSERT_LT(end, png.size());
    expectRefused("text.png", "a text", reason);
    expectRefused("empty.png", "", reason);
    expectRefused("short.png", png.substr(0, 8), reason);
    expectRefused("cut.png", png.substr(0, pixels + 9), reason);
    expectRefused("hollow.png", png.substr(0, pixels - 4) + png.substr(end - 4), reason);
    expectRefused("short.jpg", "\xff\xd8\xff\xd9", reason);
    expectRefused("short.bmp", "BM", reason);
    const std::string jpg = written("jpg");
    const std::size_t table = jpg.find("\xff\xc4");
    ASSERT_NE(table, std::string::npos);
    expectRefused("table.jpg", with(jpg, table + 5, std::string(16, '\x7f')),
                  "a Huffman table of more than 256 entries");
    // The decoder is chosen by content, not by name; there is none for GIF.
    savePicture("named.png", written("jpg"));
    EXPECT_TRUE(drawnWith("named.png").image.valid());
    expectRefused("gif.png", "GIF89a" + little(5, 2) + little(3, 2) + "\0\0\0;"s, reason);
}

TEST(Pictures, OfAModelCountTogether) {
    // More pixels than its file's size allows.
    const int side = 200;
    const std::string small = written("png", side, side);
    ASSERT_LT(16 * small.size(), std::size_t(side) * side);
    std::string materials, text = "mtllib picture_many.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\n";
    for (const std::string name : {"first", "second", "third"}) {
        savePicture("picture_" + name + ".png", small);
        materials += "newmtl " + name + "\nmap_Kd picture_" + name + ".png\n";
        text += "usemtl " + name + "\nf 1/1 2/1 3/1\n";
    }
    savePicture("picture_many.mtl", materials);
    savePicture("picture_many.obj", text);
    const auto drawn = [&](std::size_t pixels) {
        const osg::ref_ptr<osgDB::Options> words =
            new osgDB::Options("maxPixels=" + std::to_string(pixels));
        std::size_t count = 0;
        for (const osgSkin::MeshPart& part :
             osgSkin::importMesh(testing::TempDir() + "picture_many.obj", words).parts)
            if (part.geometry->getStateSet()->getTextureAttribute(0, osg::StateAttribute::TEXTURE))
                ++count;
        return count;
    };
    const std::size_t each = std::size_t(side) * side - 16 * small.size();
    EXPECT_EQ(drawn(3 * each), 3u);
    const test::Notices notices;
    EXPECT_EQ(drawn(2 * each), 2u);
    EXPECT_TRUE(notices.say("of four bytes beside those before it (option maxPixels)"))
        << notices.text();
}

/// OpenSceneGraph reads them, from trusted files.
TEST(Pictures, OfOtherFormatsAreReadWhereFormatsAllowThem) {
    const std::string content = written("rgb");
    ASSERT_FALSE(content.empty());
    savePicture("other.rgb", content);
    for (const char* words : {"", "formats=obj,rgb", "formats=all", "formats=obj images=rgb"})
        EXPECT_TRUE(drawnWith("other.rgb", words).image.valid()) << words;
    expectRefused("other.rgb", content, "the format \"rgb\" is not allowed", "formats=obj");
    savePicture("ours.png", written("png"));
    EXPECT_TRUE(drawnWith("ours.png", "formats=obj").image.valid());
}

TEST(Pictures, AreLookedAtWithinGltf) {
    for (const bool large : {false, true}) {
        std::string png = written("png");
        if (large) png = with(png, 16, big(15000, 4) + big(15000, 4));
        test::GltfColumn column;
        std::vector<double> bytes;
        for (const char byte : png) bytes.push_back(double(static_cast<unsigned char>(byte)));
        column.accessor("SCALAR", bytes, 5121);
        column.json["images"] = {
            {{"bufferView", column.json["bufferViews"].size() - 1}, {"mimeType", "image/png"}}};
        column.json["textures"] = {{{"source", 0}}};
        column.json["materials"] = {
            {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}};
        column.json["meshes"][0]["primitives"][0]["material"] = 0;
        const test::Notices notices;
        const osgSkin::ImportedMesh mesh =
            osgSkin::importMesh(column.save(large ? "picture_large.gltf" : "picture_whole.gltf"));
        const osg::StateSet& states = *mesh.parts.at(0).geometry->getStateSet();
        EXPECT_EQ(states.getTextureAttribute(0, osg::StateAttribute::TEXTURE) != nullptr, !large)
            << notices.text();
        EXPECT_EQ(notices.say("a picture of 15000 x 15000 pixels"), large) << notices.text();
    }
}

namespace {

using test::savePicture;
using test::written;

constexpr int kSide = 200;

/// The value of maxPixels that allows exactly this many pictures by written("png", kSide, kSide).
std::string optionFor(std::size_t pictures) {
    const std::size_t each = std::size_t(kSide) * kSide - 16 * written("png", kSide, kSide).size();
    return "maxPixels=" + std::to_string(pictures * each);
}

/// Writes a mesh whose materials name pictures; returns its path.
std::string saveMesh(const std::string& name, const std::vector<std::string>& pictures) {
    std::string materials, text = "mtllib " + name + ".mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\n";
    for (std::size_t i = 0; i < pictures.size(); ++i) {
        materials += "newmtl m" + std::to_string(i) + "\nmap_Kd " + pictures[i] + "\n";
        text += "usemtl m" + std::to_string(i) + "\nf 1/1 2/1 3/1\n";
    }
    savePicture(name + ".mtl", materials);
    savePicture(name + ".obj", text);
    return testing::TempDir() + name + ".obj";
}

struct Images {
    std::size_t drawn = 0; ///< parts of the mesh that have one
    std::set<const osg::Image*> all;
};

Images imagesOf(const std::string& path, const osgDB::Options* options) {
    Images result;
    for (const osgSkin::MeshPart& part : osgSkin::importMesh(path, options).parts) {
        const auto* texture = dynamic_cast<const osg::Texture2D*>(
            part.geometry->getStateSet()->getTextureAttribute(0, osg::StateAttribute::TEXTURE));
        if (texture == nullptr) continue;
        ++result.drawn;
        result.all.insert(texture->getImage());
    }
    return result;
}

/// A column with an image per view.
/// \param bytes of the buffer
/// \param views offset and length of each image in `bytes`
test::GltfColumn columnWith(const std::string& bytes,
                            const std::vector<std::pair<std::size_t, std::size_t>>& views) {
    test::GltfColumn column;
    std::vector<double> numbers;
    for (const char byte : bytes) numbers.push_back(double(static_cast<unsigned char>(byte)));
    column.accessor("SCALAR", numbers, 5121);
    const nlohmann::json whole = column.json["bufferViews"].back();
    for (const auto& [begin, length] : views) {
        nlohmann::json view = whole;
        view["byteOffset"] = whole["byteOffset"].get<std::size_t>() + begin;
        view["byteLength"] = length;
        column.json["bufferViews"].push_back(view);
        column.json["images"].push_back(
            {{"bufferView", column.json["bufferViews"].size() - 1}, {"mimeType", "image/png"}});
    }
    return column;
}

/// Shows each image of a file on a separate part.
void showImages(nlohmann::json& file) {
    const nlohmann::json primitive = file["meshes"][0]["primitives"][0];
    file["meshes"][0]["primitives"].clear();
    for (std::size_t i = 0; i < file["images"].size(); ++i) {
        file["textures"].push_back({{"source", i}});
        file["materials"].push_back(
            {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", i}}}}}});
        file["meshes"][0]["primitives"].push_back(primitive);
        file["meshes"][0]["primitives"].back()["material"] = i;
    }
}

} // namespace

TEST(Pictures, SpelledInSeveralWaysAreReadOnce) {
    savePicture("picture_spelled.png", written("png", kSide, kSide));
    const std::vector<std::string> names = {"picture_spelled.png", "./picture_spelled.png",
                                            ".//././picture_spelled.png",
                                            testing::TempDir() + "picture_spelled.png"};
    const osg::ref_ptr<osgDB::Options> words = new osgDB::Options(optionFor(1));
    const Images images = imagesOf(saveMesh("picture_spelled", names), words);
    EXPECT_EQ(images.drawn, names.size());
    EXPECT_EQ(images.all.size(), 1u);

    test::GltfColumn column;
    for (const std::string& name : {names[0], names[1], names[2]})
        column.json["images"].push_back({{"uri", name}});
    showImages(column.json);
    const Images within = imagesOf(column.save("picture_spelled.gltf"), words);
    EXPECT_EQ(within.drawn, 3u);
    EXPECT_EQ(within.all.size(), 1u);
}

TEST(Pictures, OfASavedSceneAreReadOnce) {
    savePicture("picture_saved.png", written("png", kSide, kSide));
    const osg::ref_ptr<osg::Group> scene = new osg::Group;
    for (const char* name : {"picture_saved.png", "./picture_saved.png", ".//picture_saved.png"}) {
        const osg::ref_ptr<osg::Image> image = new osg::Image;
        image->allocateImage(1, 1, 1, GL_RGB, GL_UNSIGNED_BYTE);
        image->setFileName(name);
        image->setWriteHint(osg::Image::EXTERNAL_FILE);
        const osg::ref_ptr<osg::Geometry> quad =
            osg::createTexturedQuadGeometry({}, {1, 0, 0}, {0, 1, 0});
        quad->getOrCreateStateSet()->setTextureAttribute(0, new osg::Texture2D(image));
        scene->addChild(quad);
    }
    const std::string path = testing::TempDir() + "picture_saved.osgt";
    const osg::ref_ptr<osgDB::Options> external = new osgDB::Options("WriteImageHint=UseExternal");
    ASSERT_TRUE(osgDB::writeNodeFile(*scene, path, external));
    const osg::ref_ptr<osgDB::Options> words = new osgDB::Options(optionFor(1));
    const osg::ref_ptr<osg::Node> read = osgSkin::readScene(path, words);
    std::set<const osg::Image*> images;
    for (unsigned i = 0; i < 3; ++i) {
        const auto* texture = dynamic_cast<const osg::Texture2D*>(
            read->asGroup()->getChild(i)->getStateSet()->getTextureAttribute(
                0, osg::StateAttribute::TEXTURE));
        ASSERT_NE(texture, nullptr);
        images.insert(texture->getImage());
    }
    EXPECT_EQ(images.size(), 1u);
    EXPECT_EQ(images.count(nullptr), 0u);
}

TEST(Pictures, ThatStandInTheSameBytesAreReadOnce) {
    const std::string png = written("png", kSide, kSide);
    const osg::ref_ptr<osgDB::Options> words = new osgDB::Options(optionFor(1));
    test::GltfColumn column = columnWith(png, {5, {0, png.size()}});
    column.json["images"].push_back(column.json["images"].back()); // the view, too
    showImages(column.json);
    const Images images = imagesOf(column.save("picture_same.gltf"), words);
    EXPECT_EQ(images.drawn, 6u);
    EXPECT_EQ(images.all.size(), 1u);
}

/// Each is copied before anything checks it.
TEST(Pictures, OfAGltfFileHaveItsBytesTogether) {
    const std::string bytes(50000, 'x');
    std::vector<std::pair<std::size_t, std::size_t>> views;
    for (std::size_t i = 0; i < 100; ++i) views.emplace_back(i, bytes.size() - 100);
    test::GltfColumn column = columnWith(bytes, views);
    showImages(column.json);
    expectError([&] { osgSkin::importMesh(column.save("picture_views.gltf")); },
                "expected images of at most");
    const test::Notices notices;
    test::GltfColumn halves = columnWith(bytes, {{0, 25000}, {25000, 25000}});
    showImages(halves.json);
    EXPECT_EQ(osgSkin::importMesh(halves.save("picture_halves.gltf")).parts.size(), 2u);
}

TEST(Pictures, OfMeshesThatAreReadTogetherCountTogether) {
    const std::string png = written("png", kSide, kSide);
    for (const char* name : {"picture_ours.png", "picture_theirs.png"}) savePicture(name, png);
    const std::string first = saveMesh("picture_first", {"picture_ours.png"}),
                      second = saveMesh("picture_second", {"./picture_ours.png"}),
                      third = saveMesh("picture_third", {"picture_theirs.png"});
    const osg::ref_ptr<osgDB::Options> words = new osgDB::Options(optionFor(1));
    const osg::ref_ptr<osgDB::Options> together = osgSkin::shareImages(words);
    EXPECT_EQ(osgSkin::shareImages(nullptr)->getOptionString(), "");
    const Images before = imagesOf(first, together), again = imagesOf(second, together);
    EXPECT_EQ(before.drawn, 1u);
    EXPECT_EQ(before.all, again.all);
    const test::Notices notices;
    EXPECT_EQ(imagesOf(third, osgSkin::shareImages(together)).drawn, 0u);
    EXPECT_TRUE(notices.say("beside those before it (option maxPixels)")) << notices.text();
    // The caller's data are not used.
    EXPECT_EQ(words->getUserDataContainer(), nullptr);
    EXPECT_EQ(imagesOf(third, words).drawn, 1u);
}

TEST(Pictures, ThatAreBrokenAreToldOfByEachMesh) {
    savePicture("picture_broken.png", "no picture");
    const osg::ref_ptr<osgDB::Options> together = osgSkin::shareImages(nullptr);
    for (const char* name : {"picture_one", "picture_other"}) {
        const std::string path = saveMesh(name, {"picture_broken.png"});
        const test::Notices notices;
        EXPECT_EQ(imagesOf(path, together).drawn, 0u);
        EXPECT_TRUE(notices.say("drawn without")) << notices.text();
        EXPECT_TRUE(notices.say("cannot be decoded as a picture")) << notices.text();
    }
}
