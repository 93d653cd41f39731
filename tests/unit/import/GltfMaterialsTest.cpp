// SPDX-License-Identifier: MIT
// glTF material features that Assimp ignores.
#include "GltfBuilder.h"
#include "MeshParts.h"
#include "Notices.h"
#include "Paths.h"

#include <osgSkin/Error>
#include <osgSkinImport/ImportMesh>
#include <osgSkinImport/ImportRig>

#include <osg/Array>
#include <osg/Image>
#include <osg/Material>
#include <osg/Texture2D>
#include <osgDB/WriteFile>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <set>
#include <string>
#include <vector>

namespace {

using nlohmann::json;
using osgSkin::ImportedMesh;
using test::GltfColumn;

/// Gives the column a material.
void paint(GltfColumn& column, const json& material) {
    column.json["materials"] = {material};
    column.json["meshes"][0]["primitives"][0]["material"] = 0;
}

/// Gives the column a texture of 2 by 2 texels.
void addTexture(GltfColumn& column) {
    const osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(2, 2, 1, GL_RGB, GL_UNSIGNED_BYTE);
    std::fill(image->data(), image->data() + image->getTotalSizeInBytes(), 200);
    // A unique name: tests run in parallel.
    const std::string name =
        std::string(testing::UnitTest::GetInstance()->current_test_info()->name()) + ".bmp";
    ASSERT_TRUE(osgDB::writeImageFile(*image, testing::TempDir() + name));
    column.json["images"] = {{{"uri", name}}};
    column.json["textures"] = {{{"source", 0}}};
}

} // namespace

TEST(GltfMaterials, AppliesTextureTransforms) {
    GltfColumn column;
    addTexture(column);
    std::vector<double> texCoords; // in 12 bits, as compressors store them
    for (int v = 0; v < 24; ++v) texCoords.insert(texCoords.end(), {v % 2 ? 4095.0 : 0.0, 1365.0});
    column.attributes()["TEXCOORD_0"] =
        column.accessor("VEC2", std::vector<double>(48, 7.0)); // another texture's
    column.attributes()["TEXCOORD_1"] = column.accessor("VEC2", texCoords, 5123);
    const json transform = {{"offset", {0.25, 0.5}},
                            {"rotation", std::acos(0.0)},
                            {"scale", {1.0 / 4095.0, 1.5 / 4095.0}},
                            {"texCoord", 1}};
    paint(column, {{"pbrMetallicRoughness",
                    {{"baseColorTexture",
                      {{"index", 0}, {"extensions", {{"KHR_texture_transform", transform}}}}}}}});
    const ImportedMesh mesh = osgSkin::importMesh(column.save("moved.gltf"));
    ASSERT_EQ(mesh.parts.size(), 1u);
    const auto& found = texCoordsOf(mesh);
    std::set<int> columns;
    for (const osg::Vec2& texCoord : found) {
        EXPECT_NEAR(texCoord.x(), 0.25 + 0.5, 1e-6);
        // A quarter turn; v points up from here on.
        const double up = 1.0 - texCoord.y();
        EXPECT_NEAR(up, up < 0.0 ? 0.5 - 1.0 : 0.5, 1e-6);
        columns.insert(up < 0.0 ? 1 : 0);
    }
    EXPECT_EQ(columns.size(), 2u);
}

/// With an emissive texture, of glowing eyes for example, the colour alone would make the whole
/// figure glow.
TEST(GltfMaterials, EmissionTextureReplacesEmissionColour) {
    const auto read = [](const json& pbr, bool hasTexture) {
        GltfColumn column;
        addTexture(column);
        column.attributes()["TEXCOORD_0"] = column.accessor("VEC2", std::vector<double>(48, 0.5));
        json material = {{"emissiveFactor", {1, 1, 1}}, {"pbrMetallicRoughness", pbr}};
        if (hasTexture) material["emissiveTexture"] = {{"index", 0}};
        paint(column, material);
        return osgSkin::importMesh(column.save("glows.gltf"));
    };
    const auto emission = [](const ImportedMesh& mesh) { return emissionOf(mesh); };
    const json grey = {{"baseColorFactor", {0.5, 0.5, 0.5, 1.0}}};
    const json black = {{"baseColorFactor", {0.0, 0.0, 0.0, 1.0}}};
    const test::Notices notices;
    EXPECT_GT(emission(read(grey, false)).r(), 0.99f);
    EXPECT_EQ(notices.text(), "");
    EXPECT_EQ(emission(read(grey, true)), osg::Vec4(0, 0, 0, 1));
    EXPECT_EQ(emission(read(json::object(), true)), osg::Vec4(0, 0, 0, 1));
    EXPECT_EQ(notices.text(), "");
    // If the rest is black, the emissive texture is the picture.
    const test::Notices none;
    const ImportedMesh lamp = read(black, true);
    EXPECT_EQ(none.text(), "");
    EXPECT_NE(imageOf(lamp.parts.at(0)), nullptr);
    EXPECT_GT(diffuseOf(lamp).r(), 0.9f);
}

TEST(GltfMaterials, RgbColoursAreOpaque) {
    for (const int component : {5126, 5121}) {
        GltfColumn column;
        std::vector<double> colours;
        for (int v = 0; v < 24; ++v) colours.insert(colours.end(), {1.0, 0.0, 0.0});
        column.attributes()["COLOR_0"] =
            column.accessor("VEC3", colours, component, component != 5126);
        paint(column, {{"alphaMode", "BLEND"}});
        const ImportedMesh mesh = osgSkin::importMesh(column.save("opaque.gltf"));
        ASSERT_EQ(mesh.parts.size(), 1u);
        for (const osg::Vec4& colour : coloursOf(mesh)) {
            EXPECT_NEAR(colour.r(), 1.0, 1e-5);
            EXPECT_NEAR(colour.g(), 0.0, 1e-5);
            EXPECT_EQ(colour.a(), 1.0f);
        }
    }
}

/// The file's numbers are linear, ours sRGB: 0.52252 is 0.75, and 0.21404 is 0.5.
TEST(GltfMaterials, MultipliesVertexAndMaterialColours) {
    GltfColumn column;
    std::vector<double> colours;
    for (int v = 0; v < 24; ++v) colours.insert(colours.end(), {0.52252, 1.0, 0.0});
    column.attributes()["COLOR_0"] = column.accessor("VEC3", colours, 5126, false);
    paint(column, {{"alphaMode", "BLEND"},
                   {"pbrMetallicRoughness", {{"baseColorFactor", {0.21404, 0.52252, 1.0, 0.5}}}}});
    const ImportedMesh mesh = osgSkin::importMesh(column.save("times.gltf"));
    ASSERT_EQ(mesh.parts.size(), 1u);
    const auto& all = coloursOf(mesh);
    ASSERT_FALSE(all.empty());
    for (const osg::Vec4& colour : all)
        EXPECT_LT((colour - osg::Vec4(0.375f, 0.75f, 0.0f, 0.5f)).length(), 1e-4f);
}

TEST(GltfMaterials, ReadsSpecularGlossiness) {
    GltfColumn column;
    addTexture(column);
    const json glossy = {{"diffuseFactor", {1.0, 0.0, 0.0, 0.5}},
                         {"glossinessFactor", 0.0},
                         {"diffuseTexture", {{"index", 0}}}};
    paint(column, {{"alphaMode", "BLEND"},
                   {"extensions", {{"KHR_materials_pbrSpecularGlossiness", glossy}}}});
    const ImportedMesh mesh = osgSkin::importMesh(column.save("glossy.gltf"));
    ASSERT_EQ(mesh.parts.size(), 1u);
    const auto& material = materialOf(mesh);
    const osg::Vec4 red(1.0f, 0.0f, 0.0f, 0.5f);
    EXPECT_LT((material.getDiffuse(osg::Material::FRONT) - red).length(), 1e-5f);
    EXPECT_NE(imageOf(mesh.parts.at(0)), nullptr);
}

/// A column three units tall, and a triangle beside its joints.
TEST(GltfMaterials, LeavesOutScenery) {
    const auto vertices = [](double size, double x) {
        test::GltfColumn column;
        column.json["meshes"].push_back(
            {{"primitives",
              {{{"attributes",
                 {{"POSITION",
                   column.accessor("VEC3", {x, 0, 0, x, size, 0, x + 0.1, 0, 0})}}}}}}});
        column.json["scenes"][0]["nodes"].push_back(column.node({{"mesh", 1}}));
        return osgSkin::importRig(column.save("beside.gltf")).body.mesh.positions.size();
    };
    EXPECT_EQ(vertices(1.0, 0.0), 27u);
    EXPECT_EQ(vertices(3.1, 0.0), 27u);
    EXPECT_EQ(vertices(4.0, 0.0), 24u) << "a thing that sticks out is part of the figure";
    EXPECT_EQ(vertices(5.0, 0.0), 24u) << "a thing larger than the figure is part of it";
    EXPECT_EQ(vertices(1.0, 2.0), 24u) << "a thing that stands apart is part of it";
}

/// The figure consists of all parts of its skin, not only the first.
TEST(GltfMaterials, KeepsObjectsBetweenSkinnedParts) {
    test::GltfColumn column;
    std::vector<double> aside = column.places;
    for (std::size_t i = 0; i < aside.size(); i += 3) aside[i] += 2.0;
    json& primitives = column.json["meshes"][0]["primitives"];
    primitives.push_back(primitives[0]);
    primitives[1]["attributes"]["POSITION"] = column.accessor("VEC3", aside);
    column.json["meshes"].push_back(
        {{"primitives",
          {{{"attributes",
             {{"POSITION", column.accessor("VEC3", {2, 0, 0, 2, 1, 0, 2.1, 0, 0})}}}}}}});
    column.json["scenes"][0]["nodes"].push_back(column.node({{"mesh", 1}}));
    EXPECT_EQ(osgSkin::importRig(column.save("parts.gltf")).body.mesh.positions.size(), 51u);
}

TEST(GltfMaterials, ReadsSharedTextureOnce) {
    GltfColumn column;
    addTexture(column);
    json& primitives = column.json["meshes"][0]["primitives"];
    const json texture = {{"baseColorTexture", {{"index", 0}}}};
    column.json["materials"] = {{{"pbrMetallicRoughness", texture}},
                                {{"pbrMetallicRoughness", texture}}};
    primitives.push_back(primitives[0]);
    for (std::size_t p = 0; p < 2; ++p) primitives[p]["material"] = p;
    const ImportedMesh mesh = osgSkin::importMesh(column.save("shared.gltf"));
    ASSERT_EQ(mesh.parts.size(), 2u);
    std::set<const osg::Image*> images;
    for (const osgSkin::MeshPart& part : mesh.parts) images.insert(imageOf(part));
    EXPECT_EQ(images.size(), 1u);
    EXPECT_EQ(images.count(nullptr), 0u);
}

/// These textures exist only in an extension's format, without a fallback.
TEST(GltfMaterials, ReadsTextureFormatExtensions) {
    for (const char* extension : {"MSFT_texture_dds", "EXT_texture_webp"}) {
        GltfColumn column;
        addTexture(column);
        const bool isKnown = std::string(extension) == "MSFT_texture_dds";
        if (!isKnown) column.json["images"][0] = {{"uri", "picture.webp"}};
        column.json["textures"] = {{{"extensions", {{extension, {{"source", 0}}}}}}};
        paint(column, {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}});
        const test::Notices notices;
        const ImportedMesh mesh = osgSkin::importMesh(column.save("texture_of_extension.gltf"));
        EXPECT_EQ(imageOf(mesh.parts.at(0)) != nullptr, isKnown);
        EXPECT_EQ(notices.say("cannot be read; drawn without"), !isKnown) << notices.text();
    }
}

TEST(GltfMaterials, NamesUnsupportedImageFormats) {
    // "RIFF....WEBP" and the first bytes of KTX 2, in base 64
    for (const auto& [bytes, format] :
         {std::pair("UklGRgAAAABXRUJQ", "webp"), std::pair("q0tUWCAyMLsNChoK", "ktx2")}) {
        GltfColumn column;
        addTexture(column);
        column.json["images"][0] = {
            {"uri", std::string("data:application/octet-stream;base64,") + bytes}};
        paint(column, {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}});
        const test::Notices notices;
        osgSkin::importMesh(column.save("formats.gltf"));
        EXPECT_TRUE(notices.say("in the format \"" + std::string(format) + "\", expected PNG"))
            << notices.text();
    }
}

TEST(GltfMaterials, WarnsAboutInstancing) {
    for (const bool isRequired : {false, true}) {
        GltfColumn column;
        column.json["extensionsUsed"] = {"KHR_materials_unlit", "EXT_mesh_gpu_instancing"};
        if (isRequired) column.json["extensionsRequired"] = {"EXT_mesh_gpu_instancing"};
        const test::Notices notices;
        osgSkin::importMesh(column.save("uses_extensions.gltf"));
        EXPECT_TRUE(notices.say(isRequired ? "requires the extension \"EXT_mesh_gpu_instancing\""
                                           : "uses the extension \"EXT_mesh_gpu_instancing\""));
        EXPECT_EQ(notices.lines(), 1u) << notices.text();
    }
}

/// Two triangles with four vertices, as draco::Encoder writes them.
TEST(GltfMaterials, DecodesDraco) {
    try {
        const ImportedMesh mesh = osgSkin::importMesh(testData("mesh/draco.gltf"));
        ASSERT_EQ(mesh.mesh.faceSizes.size(), 2u);
        double furthest = 0.0;
        for (const glm::dvec3& place : mesh.mesh.positions)
            furthest = std::max(furthest, place.x + place.y + place.z);
        EXPECT_NEAR(furthest, 1.0, 1e-3);
        // Morph targets are beside the compressed data, in its order of vertices.
        ASSERT_EQ(mesh.parts.at(0).morphs.size(), 1u);
        const osgSkin::MorphTarget& target = mesh.parts[0].morphs[0];
        ASSERT_EQ(target.vertices.size(), 3u) << "the first vertex stays";
        for (std::size_t i = 0; i < 3; ++i)
            EXPECT_EQ(target.positions[i],
                      glm::vec3(0, 0, mesh.parts[0].sourceVertex[target.vertices[i]]));
    } catch (const osgSkin::Error& error) {
        const std::string why = error.what();
        ASSERT_NE(why.find("raco"), std::string::npos) << why;
        GTEST_SKIP() << "this build has no Draco";
    }
}

TEST(GltfMaterials, OneMeshMayHaveColours) {
    GltfColumn column;
    json& primitives = column.json["meshes"][0]["primitives"];
    json red = primitives[0];
    std::vector<double> colours;
    for (int v = 0; v < 24; ++v) colours.insert(colours.end(), {1.0, 0.0, 0.0});
    red["attributes"]["COLOR_0"] = column.accessor("VEC3", colours);
    primitives.push_back(red);
    const ImportedMesh mesh = osgSkin::importMesh(column.save("one_is_red.gltf"));
    std::size_t found = 0;
    for (const osgSkin::MeshPart& part : mesh.parts)
        if (const auto* drawn = dynamic_cast<const osg::Vec4Array*>(part.geometry->getColorArray()))
            for (const osg::Vec4& colour : *drawn)
                if ((colour - osg::Vec4(1, 0, 0, 1)).length() < 1e-5f) ++found;
    EXPECT_EQ(found, 24u);
}

TEST(GltfMaterials, DetectsImageFormatByContent) {
    GltfColumn plain;
    addTexture(plain);
    std::ifstream file(testing::TempDir() + plain.json["images"][0]["uri"].get<std::string>(),
                       std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(file), {}};
    ASSERT_EQ(bytes.substr(0, 2), "BM");
    std::string escaped;
    for (const char byte : bytes) {
        static const char* const digits = "0123456789abcdef";
        const auto value = static_cast<unsigned char>(byte);
        escaped += {'%', digits[value >> 4], digits[value & 15]};
    }
    // Missing, another format's, upper case, and a meaningless one.
    for (const char* mime : {"", "image/jpeg", "image/BMP", "application/octet-stream"})
        for (const bool isInText : {false, true}) {
            GltfColumn column;
            std::vector<double> numbers;
            for (const char byte : bytes)
                numbers.push_back(double(static_cast<unsigned char>(byte)));
            column.accessor("SCALAR", numbers, 5121);
            json image = {{"bufferView", column.json["bufferViews"].size() - 1}};
            if (*mime != '\0') image["mimeType"] = mime;
            if (isInText) image = {{"uri", std::string("DATA:") + mime + "," + escaped}};
            column.json["images"] = {image};
            column.json["textures"] = {{{"source", 0}}};
            paint(column, {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}});
            const test::Notices notices;
            const ImportedMesh mesh = osgSkin::importMesh(column.save("kinds.gltf"));
            const auto* texture = imageOf(mesh.parts.at(0));
            EXPECT_NE(texture, nullptr) << mime << isInText << notices.text();
        }
}

TEST(GltfMaterials, EscapesZeroBytesInImageNames) {
    using namespace std::string_literals;
    for (const std::string& behind : {"%00.bmp"s, "\0.bmp"s}) {
        GltfColumn column;
        addTexture(column);
        json& name = column.json["images"][0]["uri"];
        name = name.get<std::string>() + behind;
        paint(column, {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}});
        const test::Notices notices;
        const ImportedMesh mesh = osgSkin::importMesh(column.save("zero.gltf"));
        EXPECT_EQ(imageOf(mesh.parts.at(0)), nullptr);
        EXPECT_TRUE(notices.say("%00.bmp\" cannot be read; drawn without")) << notices.text();
    }
}
