// SPDX-License-Identifier: MIT
// Images of meshes: their formats, their sizes, broken ones, and those that are named more than
// once.
#include "ExpectError.h"
#include "GltfBuilder.h"
#include "ImageFiles.h"
#include "MeshParts.h"
#include "Notices.h"

#include <osgSkinImport/ImportMesh>
#include <osgSkinImport/ReadScene>
#include <osgSkinImport/ShareImages>

#include <osg/Group>
#include <osg/Image>
#include <osg/Material>
#include <osg/Texture2D>
#include <osgDB/WriteFile>

#include <set>
#include <string>
#include <utility>
#include <vector>

namespace {

using std::string_literals::operator""s;
using test::big;
using test::Drawn;
using test::drawnWith;
using test::expectRefused;
using test::little;
using test::saveText;
using test::with;
using test::written;

/// A TGA image of 5 x 3 pixels.
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

TEST(Images, ReadsEachFormat) {
    for (const char* extension :
         {"png", "jpg", "jpeg", "bmp", "tga", "rgb", "ppm", "tif", "tiff", "dds"}) {
        const std::string content = written(extension);
        if (content.empty()) continue; // no such writer
        const std::string name = std::string("whole.") + extension;
        saveText(name, content);
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
        saveText(name, content);
        const Drawn drawn = drawnWith(name);
        ASSERT_TRUE(drawn.image.valid()) << drawn.notices;
        EXPECT_EQ(drawn.image->s(), 5) << name;
    }
}

TEST(Images, MatchOpenSceneGraph) {
    for (const char* extension : {"png", "bmp", "tga", "jpg"}) {
        SCOPED_TRACE(extension);
        const std::string content = written(extension);
        if (content.empty()) continue; // no such writer
        const std::string name = std::string("same.") + extension;
        saveText(name, content);
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

TEST(Images, LimitsPixelsByFileSize) {
    const std::string png = with(written("png"), 16, big(15000, 4) + big(15000, 4));
    expectRefused("large.png", png, "an image of 15000 x 15000 pixels, expected at most 1677");
    expectRefused("wide.png", with(png, 16, big(70000, 4) + big(1, 4)),
                  "of 70000 x 1 pixels, expected 1 to 65536");
    expectRefused("none.png", with(png, 16, big(0, 4)), "cannot be decoded as an image");
    const std::string jpg = written("jpg");
    const std::size_t frame = jpg.find("\xff\xc0");
    ASSERT_NE(frame, std::string::npos);
    expectRefused("large.jpg", with(jpg, frame + 5, big(60000, 2) + big(60000, 2)),
                  "60000 x 60000 pixels, expected at most");
    expectRefused("large.tga", with(tga(2, {}), 12, little(60000, 2) + little(60000, 2)),
                  "60000 x 60000 pixels, expected at most");
    saveText("small.png", written("png"));
    EXPECT_TRUE(drawnWith("small.png", "maxPixels=1").image.valid());
    expectRefused("option.png", with(written("png"), 16, big(300, 4) + big(300, 4)),
                  "(option maxPixels)", "maxPixels=100");
}

TEST(Images, RejectsBrokenFiles) {
    const std::string png = written("png"), reason = "cannot be decoded as an image";
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
    saveText("named.png", written("jpg"));
    EXPECT_TRUE(drawnWith("named.png").image.valid());
    expectRefused("gif.png", "GIF89a" + little(5, 2) + little(3, 2) + "\0\0\0;"s, reason);
}

TEST(Images, CountPixelsPerModel) {
    // More pixels than its file's size allows.
    const int side = 200;
    const std::string small = written("png", side, side);
    ASSERT_LT(16 * small.size(), std::size_t(side) * side);
    std::string materials, text = "mtllib image_many.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\n";
    for (const std::string name : {"first", "second", "third"}) {
        saveText("image_" + name + ".png", small);
        materials += "newmtl " + name + "\nmap_Kd image_" + name + ".png\n";
        text += "usemtl " + name + "\nf 1/1 2/1 3/1\n";
    }
    saveText("image_many.mtl", materials);
    saveText("image_many.obj", text);
    const auto drawn = [&](std::size_t pixels) {
        const osg::ref_ptr<osgDB::Options> words =
            new osgDB::Options("maxPixels=" + std::to_string(pixels));
        std::size_t count = 0;
        for (const osgSkin::MeshPart& part :
             osgSkin::importMesh(testing::TempDir() + "image_many.obj", words).parts)
            count += imageOf(part) != nullptr;
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
TEST(Images, ReadsOtherFormatsIfAllowed) {
    const std::string content = written("rgb");
    ASSERT_FALSE(content.empty());
    saveText("other.rgb", content);
    for (const char* words : {"", "formats=obj,rgb", "formats=all", "formats=obj images=rgb"})
        EXPECT_TRUE(drawnWith("other.rgb", words).image.valid()) << words;
    expectRefused("other.rgb", content, "the format \"rgb\" is not allowed", "formats=obj");
    saveText("ours.png", written("png"));
    EXPECT_TRUE(drawnWith("ours.png", "formats=obj").image.valid());
}

TEST(Images, ChecksEmbeddedGltfImages) {
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
            osgSkin::importMesh(column.save(large ? "image_large.gltf" : "image_whole.gltf"));
        EXPECT_EQ(imageOf(mesh.parts.at(0)) != nullptr, !large) << notices.text();
        EXPECT_EQ(notices.say("an image of 15000 x 15000 pixels"), large) << notices.text();
    }
}

namespace {

using test::saveText;
using test::written;

constexpr int kSide = 200;

/// The value of maxPixels that allows exactly this many images by written("png", kSide, kSide).
std::string optionFor(std::size_t images) {
    const std::size_t each = std::size_t(kSide) * kSide - 16 * written("png", kSide, kSide).size();
    return "maxPixels=" + std::to_string(images * each);
}

/// Writes a mesh whose materials name images; returns its path.
std::string saveMesh(const std::string& name, const std::vector<std::string>& images) {
    std::string materials, text = "mtllib " + name + ".mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\n";
    for (std::size_t i = 0; i < images.size(); ++i) {
        materials += "newmtl m" + std::to_string(i) + "\nmap_Kd " + images[i] + "\n";
        text += "usemtl m" + std::to_string(i) + "\nf 1/1 2/1 3/1\n";
    }
    saveText(name + ".mtl", materials);
    saveText(name + ".obj", text);
    return testing::TempDir() + name + ".obj";
}

struct Images {
    std::size_t drawn = 0; ///< parts of the mesh that have one
    std::set<const osg::Image*> all;
};

Images imagesOf(const std::string& path, const osgDB::Options* options) {
    Images result;
    for (const osgSkin::MeshPart& part : osgSkin::importMesh(path, options).parts) {
        if (imageOf(part) == nullptr) continue;
        ++result.drawn;
        result.all.insert(imageOf(part));
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

TEST(Images, ReadsFileOnceWhateverItsSpelling) {
    saveText("image_spelled.png", written("png", kSide, kSide));
    const std::vector<std::string> names = {"image_spelled.png", "./image_spelled.png",
                                            ".//././image_spelled.png",
                                            testing::TempDir() + "image_spelled.png"};
    const osg::ref_ptr<osgDB::Options> words = new osgDB::Options(optionFor(1));
    const Images images = imagesOf(saveMesh("image_spelled", names), words);
    EXPECT_EQ(images.drawn, names.size());
    EXPECT_EQ(images.all.size(), 1u);

    test::GltfColumn column;
    for (const std::string& name : {names[0], names[1], names[2]})
        column.json["images"].push_back({{"uri", name}});
    showImages(column.json);
    const Images within = imagesOf(column.save("image_spelled.gltf"), words);
    EXPECT_EQ(within.drawn, 3u);
    EXPECT_EQ(within.all.size(), 1u);
}

TEST(Images, ReadsImagesOfSavedSceneOnce) {
    saveText("image_saved.png", written("png", kSide, kSide));
    const osg::ref_ptr<osg::Group> scene = new osg::Group;
    for (const char* name : {"image_saved.png", "./image_saved.png", ".//image_saved.png"}) {
        const osg::ref_ptr<osg::Image> image = new osg::Image;
        image->allocateImage(1, 1, 1, GL_RGB, GL_UNSIGNED_BYTE);
        image->setFileName(name);
        image->setWriteHint(osg::Image::EXTERNAL_FILE);
        const osg::ref_ptr<osg::Geometry> quad =
            osg::createTexturedQuadGeometry({}, {1, 0, 0}, {0, 1, 0});
        quad->getOrCreateStateSet()->setTextureAttribute(0, new osg::Texture2D(image));
        scene->addChild(quad);
    }
    const std::string path = testing::TempDir() + "image_saved.osgt";
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

TEST(Images, ReadsSharedBytesOnce) {
    const std::string png = written("png", kSide, kSide);
    const osg::ref_ptr<osgDB::Options> words = new osgDB::Options(optionFor(1));
    test::GltfColumn column = columnWith(png, {5, {0, png.size()}});
    column.json["images"].push_back(column.json["images"].back()); // the view, too
    showImages(column.json);
    const Images images = imagesOf(column.save("image_same.gltf"), words);
    EXPECT_EQ(images.drawn, 6u);
    EXPECT_EQ(images.all.size(), 1u);
}

/// Each is copied before anything checks it.
TEST(Images, LimitsBytesOfGltfImages) {
    const std::string bytes(50000, 'x');
    std::vector<std::pair<std::size_t, std::size_t>> views;
    for (std::size_t i = 0; i < 100; ++i) views.emplace_back(i, bytes.size() - 100);
    test::GltfColumn column = columnWith(bytes, views);
    showImages(column.json);
    expectError([&] { osgSkin::importMesh(column.save("image_views.gltf")); },
                "expected images of at most");
    const test::Notices notices;
    test::GltfColumn halves = columnWith(bytes, {{0, 25000}, {25000, 25000}});
    showImages(halves.json);
    EXPECT_EQ(osgSkin::importMesh(halves.save("image_halves.gltf")).parts.size(), 2u);
}

TEST(Images, SharesImagesBetweenMeshes) {
    const std::string png = written("png", kSide, kSide);
    for (const char* name : {"image_ours.png", "image_theirs.png"}) saveText(name, png);
    const std::string first = saveMesh("image_first", {"image_ours.png"}),
                      second = saveMesh("image_second", {"./image_ours.png"}),
                      third = saveMesh("image_third", {"image_theirs.png"});
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

TEST(Images, WarnsOnceForEachMesh) {
    saveText("image_broken.png", "no image");
    const osg::ref_ptr<osgDB::Options> together = osgSkin::shareImages(nullptr);
    for (const char* name : {"image_one", "image_other"}) {
        const std::string path = saveMesh(name, {"image_broken.png"});
        const test::Notices notices;
        EXPECT_EQ(imagesOf(path, together).drawn, 0u);
        EXPECT_TRUE(notices.say("drawn without")) << notices.text();
        EXPECT_TRUE(notices.say("cannot be decoded as an image")) << notices.text();
    }
}
