// SPDX-License-Identifier: MIT
// Images of meshes: their formats, their sizes, and broken ones.
#include "GltfBuilder.h"
#include "PictureFiles.h"

#include <cstdlib>

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
/// \param kind 1: by a table of two colours, 2: by colours; 8 more: packed
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
    // What the content says, and not the name, chooses among decoders; there is none for GIF.
    savePicture("named.png", written("jpg"));
    EXPECT_TRUE(drawnWith("named.png").image.valid());
    expectRefused("gif.png", "GIF89a" + little(5, 2) + little(3, 2) + "\0\0\0;"s, reason);
}

TEST(Pictures, OfAModelCountTogether) {
    // Larger than its file is worth.
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
    for (const char* words : {"", "formats=obj,rgb", "formats=all", "formats=obj pictures=rgb"})
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
