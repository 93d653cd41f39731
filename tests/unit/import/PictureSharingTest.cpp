// SPDX-License-Identifier: MIT
// Pictures that are named, or stored, more often than there are files of them.
#include "GltfBuilder.h"
#include "PictureFiles.h"

#include <osgSkinImport/ReadScene>
#include <osgSkinImport/ShareImages>

#include <osg/Group>

#include <set>
#include <string>
#include <utility>
#include <vector>

namespace {

using test::savePicture;
using test::written;

constexpr int kSide = 200;

/// The value of maxPixels at which so many pictures as written by written("png", kSide, kSide), and
/// no more, are drawn.
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

/// A column for each image, which each stands in a view of its own.
/// \param views where an image begins and how long it is, within `bytes`
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

/// Shows each image of a file on a part of its own.
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

/// Each is copied before anything looks at it.
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
    // What the caller has counts nothing.
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
