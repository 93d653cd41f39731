// SPDX-License-Identifier: MIT
// osgskinbake's output looks like the character: materials, textures, vertex colours.
#include "Command.h"
#include "ExpectContains.h"
#include "GlbFile.h"

#include <osgSkinImport/ImportMesh>

#include <osg/AlphaFunc>
#include <osg/Geode>
#include <osg/Material>
#include <osg/Texture2D>
#include <osgDB/ReadFile>
#include <osgDB/Registry>
#include <osgDB/WriteFile>

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <fstream>
#include <sstream>
#include <thread>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace {

using test::Glb;

/// Four columns and two rows of colours that differ.
osg::ref_ptr<osg::Image> smallImage() {
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(4, 2, 1, GL_RGB, GL_UNSIGNED_BYTE);
    for (int t = 0; t < 2; ++t)
        for (int s = 0; s < 4; ++s)
            image->setColor({float(s) / 3.0f, float(t), 0.2f, 1.0f}, unsigned(s), unsigned(t));
    return image;
}

void expectSamePixels(const osg::Image& a, const osg::Image& b) {
    ASSERT_EQ(a.s(), b.s());
    ASSERT_EQ(a.t(), b.t());
    for (unsigned t = 0; t < unsigned(a.t()); ++t)
        for (unsigned s = 0; s < unsigned(a.s()); ++s)
            EXPECT_EQ(a.getColor(s, t), b.getColor(s, t)) << s << ", " << t;
}

const osg::Texture2D* textureOf(const osgSkin::MeshPart& part) {
    return dynamic_cast<const osg::Texture2D*>(
        part.geometry->getStateSet()->getTextureAttribute(0, osg::StateAttribute::TEXTURE));
}

const osg::Material& materialOf(const osgSkin::MeshPart& part) {
    return dynamic_cast<const osg::Material&>(
        *part.geometry->getStateSet()->getAttribute(osg::StateAttribute::MATERIAL));
}

void expectNear(const osg::Vec4& a, const osg::Vec4& b, float tolerance) {
    for (unsigned k = 0; k < 4; ++k) EXPECT_NEAR(a[k], b[k], tolerance) << k;
}

/// Adds floats to a glTF description, in a separate file. Returns the accessor's index.
std::size_t addFloats(nlohmann::json& gltf, const std::string& folder, const std::string& name,
                      const std::vector<float>& floats, const char* type, std::size_t components) {
    std::ofstream(folder + "/" + name, std::ios::binary)
        .write(reinterpret_cast<const char*>(floats.data()),
               static_cast<std::streamsize>(floats.size() * sizeof(float)));
    const std::size_t bytes = floats.size() * sizeof(float);
    gltf["bufferViews"].push_back(
        {{"buffer", gltf["buffers"].size()}, {"byteOffset", 0}, {"byteLength", bytes}});
    gltf["buffers"].push_back({{"uri", name}, {"byteLength", bytes}});
    gltf["accessors"].push_back({{"bufferView", gltf["bufferViews"].size() - 1},
                                 {"componentType", 5126},
                                 {"count", floats.size() / components},
                                 {"type", type}});
    return gltf["accessors"].size() - 1;
}

constexpr std::size_t kTubeVertices = 36;

std::vector<float> tubeTexCoords() {
    std::vector<float> texCoords;
    for (std::size_t v = 0; v < kTubeVertices; ++v) {
        const std::size_t ring = v / 6;
        texCoords.push_back(float(v % 6) / 4.0f);
        texCoords.push_back(float(ring) / 8.0f);
    }
    return texCoords;
}

/// The tube with a texture with alpha cut-out, on its second texture coordinates.
std::string texturedRig(const std::string& folder) {
    nlohmann::json gltf = test::readJson(OSGSKIN_TEST_DATA "/rig/tube.gltf");
    osgDB::writeImageFile(*smallImage(), folder + "/skin.png");
    gltf["images"] = {{{"uri", "skin.png"}}};
    gltf["samplers"] = {{{"wrapS", 33071}, {"wrapT", 33648}}};
    gltf["textures"] = {{{"source", 0}, {"sampler", 0}}};
    gltf["materials"][0] = {{"alphaMode", "MASK"},
                            {"alphaCutoff", 0.25},
                            {"emissiveFactor", {0.0, 0.1, 0.0}},
                            {"pbrMetallicRoughness",
                             {{"baseColorFactor", {0.5, 0.25, 1.0, 1.0}},
                              {"baseColorTexture", {{"index", 0}, {"texCoord", 1}}},
                              {"metallicFactor", 0.0},
                              {"roughnessFactor", 0.7}}}};
    nlohmann::json& attributes = gltf["meshes"][0]["primitives"][0]["attributes"];
    attributes["TEXCOORD_0"] = addFloats(gltf, folder, "other.bin",
                                         std::vector<float>(2 * kTubeVertices, 0.5f), "VEC2", 2);
    attributes["TEXCOORD_1"] = addFloats(gltf, folder, "uv.bin", tubeTexCoords(), "VEC2", 2);
    std::ofstream(folder + "/rig.gltf") << gltf;
    return folder + "/rig.gltf";
}

/// The tube of tests/data/character as a `.skin` file, with its `v` lines changed, texture
/// coordinates added, and another material above y = 2.
std::string texturedCharacter(const std::string& folder, bool coloured) {
    std::ifstream in(OSGSKIN_TEST_DATA "/character/body.obj");
    std::ofstream out(folder + "/body.obj");
    out << "mtllib body.mtl\n";
    std::vector<double> heights;
    std::size_t vertices = 0;
    std::string used;
    for (std::string line; std::getline(in, line);) {
        std::istringstream words(line);
        std::string key;
        words >> key;
        if (key == "v") {
            double x = 0, y = 0, z = 0;
            words >> x >> y >> z;
            out << line;
            if (coloured) out << " 0.25 " << y / 4.0 << " 0.75";
            out << "\nvt " << double(vertices) / 64.0 << " " << y / 4.0 << "\n";
            heights.push_back(y);
            ++vertices;
        } else if (key == "f") {
            bool high = true;
            std::string face = "f";
            for (std::size_t v = 0; words >> v;) {
                high = high && heights.at(v - 1) > 2.0;
                face += " " + std::to_string(v) + "/" + std::to_string(v);
            }
            const std::string material = high ? "glass" : "cloth";
            if (material != used) out << "usemtl " << material << "\n";
            used = material;
            out << face << "\n";
        }
    }
    std::ofstream(folder + "/body.mtl") << "newmtl cloth\nKd 0.8 0.6 0.4\nmap_Kd cloth.bmp\n"
                                           "newmtl glass\nKd 0.2 0.4 0.6\nKs 0.5 0.5 0.5\nNs 30\n"
                                           "d 0.5\n";
    osgDB::writeImageFile(*smallImage(), folder + "/cloth.bmp");
    const std::string data = OSGSKIN_TEST_DATA "/character/";
    const nlohmann::json skin{{"osgskin", 1},
                              {"mesh", "body.obj"},
                              {"skeleton", data + "rig.bvh"},
                              {"motions", {{{"file", data + "move.bvh"}, {"name", "move"}}}}};
    std::ofstream(folder + "/body.skin") << skin;
    return folder + "/body.skin";
}

void bake(const std::string& arguments, const std::string& folder) {
    const test::CommandResult result = test::runBake(arguments, folder);
    ASSERT_EQ(result.status, 0) << result.err;
}

void expectValid(const std::string& glb) {
    std::string why;
    if (!test::hasGlbValidator(why)) return; // BakeFormats reports it
    EXPECT_EQ(test::glbComplaints(glb), "");
}

} // namespace

TEST(BakeMaterials, ReportsMapsThatAreLeftOut) {
    const std::string folder = test::makeTestFolder();
    const std::string rig = texturedRig(folder);
    nlohmann::json gltf = test::readJson(rig);
    for (const char* map : {"normalTexture", "emissiveTexture"})
        gltf["materials"][0][map] = {{"index", 0}, {"texCoord", 1}};
    std::ofstream(rig) << gltf;
    const test::CommandResult result =
        test::runBake("'" + rig + ".skin' --frames 0 --out baked.glb", folder);
    EXPECT_EQ(result.status, 0);
    test::expectContains(result.err, "normal, occlusion and emission maps left out");
    const Glb glb(folder + "/baked.glb");
    const nlohmann::json& material = glb.json["materials"].at(0);
    EXPECT_EQ(material.count("normalTexture"), 0u);
    // Without its texture, the colour would make the whole surface glow.
    EXPECT_EQ(material.count("emissiveFactor"), 0u);
    EXPECT_EQ(material["pbrMetallicRoughness"].count("baseColorTexture"), 1u);
}

TEST(BakeMaterials, KeepsMaterialAndTextureOfRiggedModel) {
    const std::string folder = test::makeTestFolder();
    const std::string rig = texturedRig(folder);
    bake("'" + rig + ".skin' --rate 10 --out baked.glb", folder);
    const Glb glb(folder + "/baked.glb");
    const nlohmann::json& json = glb.json;
    ASSERT_EQ(json["materials"].size(), 1u);
    const nlohmann::json& material = json["materials"][0];
    EXPECT_EQ(material["alphaMode"], "MASK");
    EXPECT_EQ(material["alphaCutoff"], 0.25);
    EXPECT_EQ(material.count("doubleSided"), 0u);
    EXPECT_NEAR(material["emissiveFactor"][1], 0.1, 1e-4);
    const nlohmann::json& surface = material["pbrMetallicRoughness"];
    const double base[4] = {0.5, 0.25, 1.0, 1.0};
    for (std::size_t k = 0; k < 4; ++k) EXPECT_NEAR(surface["baseColorFactor"][k], base[k], 1e-4);
    EXPECT_EQ(surface["metallicFactor"], 0.0);
    EXPECT_NEAR(surface["roughnessFactor"], 0.7, 1e-4);

    const nlohmann::json& texture =
        json["textures"].at(std::size_t(surface["baseColorTexture"]["index"]));
    const nlohmann::json& sampler = json["samplers"].at(std::size_t(texture["sampler"]));
    EXPECT_EQ(sampler["wrapS"], 33071);
    EXPECT_EQ(sampler["wrapT"], 33648);
    const nlohmann::json& image = json["images"].at(std::size_t(texture["source"]));
    EXPECT_EQ(image["mimeType"], "image/png");
    EXPECT_EQ(glb.view(image["bufferView"]), test::readBytes(folder + "/skin.png"))
        << "the file's own bytes";

    const nlohmann::json& primitive = json["meshes"][0]["primitives"][0];
    const std::vector<float> found = glb.floats(primitive["attributes"]["TEXCOORD_0"]);
    const std::vector<float> expected = tubeTexCoords();
    ASSERT_EQ(found.size(), expected.size());
    for (std::size_t k = 0; k < found.size(); ++k) EXPECT_NEAR(found[k], expected[k], 1e-6f);
    expectValid(folder + "/baked.glb");
}

TEST(BakeMaterials, SamplesClipOfRiggedModel) {
    const std::string folder = test::makeTestFolder();
    bake("'" OSGSKIN_TEST_DATA "/rig/tube.gltf' --rate 10 --out baked.glb --pose pose.json",
         folder);
    const Glb glb(folder + "/baked.glb");
    EXPECT_EQ(glb.json["animations"][0]["name"], "wave");
    const nlohmann::json& primitive = glb.json["meshes"][0]["primitives"][0];
    ASSERT_EQ(primitive["targets"].size(), 10u); // 1 second
    EXPECT_EQ(test::readJson(folder + "/pose.json").size(), 11u);
    const auto base = glb.vectors(primitive["attributes"]["POSITION"]);
    const auto moved = glb.vectors(primitive["targets"][4]["POSITION"]);
    double least = 0.0;
    for (std::size_t v = 0; v < base.size(); ++v) least = std::min(least, base[v].x + moved[v].x);
    const double angle = 70.0 * 3.14159265358979 / 180.0; // half a second into the clip
    EXPECT_NEAR(least, -std::sin(angle) - 0.25 * std::cos(angle), 1e-5);
    const auto last = test::runBake(
        "'" OSGSKIN_TEST_DATA "/rig/tube.gltf.skin' --motion dance --frames 0 --out a.glb", folder);
    EXPECT_EQ(last.status, 2);
    test::expectContains(last.err, "expected one of \"wave\", \"move\"");
    bake("'" OSGSKIN_TEST_DATA "/rig/tube.gltf.skin' --rest rest.obj --binding b.json", folder);
    EXPECT_EQ(osgSkin::importMesh(folder + "/rest.obj").mesh.positions.size(), kTubeVertices);
}

TEST(BakeMaterials, RejectsRateForRetargetedMotions) {
    const auto result = test::runBake("'" OSGSKIN_DATA "/thrower.skin' --rate 10 --frames 0",
                                      test::makeTestFolder());
    EXPECT_EQ(result.status, 2);
    test::expectContains(result.err, "--rate");
}

TEST(BakeMaterials, KeepsEachMaterialOfACharacter) {
    const std::string folder = test::makeTestFolder();
    bake("'" + texturedCharacter(folder, false) + "' --out baked.glb", folder);
    const Glb glb(folder + "/baked.glb");
    const nlohmann::json& json = glb.json;
    ASSERT_EQ(json["materials"].size(), 2u);
    ASSERT_EQ(json["meshes"][0]["primitives"].size(), 2u);
    for (const nlohmann::json& primitive : json["meshes"][0]["primitives"])
        EXPECT_EQ(primitive["targets"].size(), 3u);
    EXPECT_EQ(json["materials"][1]["alphaMode"], "BLEND");
    EXPECT_EQ(json["materials"][1]["pbrMetallicRoughness"]["baseColorFactor"][3], 0.5);
    EXPECT_EQ(json["images"][0]["mimeType"], "image/png") << "a format that glTF does not have";
    expectValid(folder + "/baked.glb");

    // Our own importer reads back the same as from the original.
    const osgSkin::ImportedMesh before = osgSkin::importMesh(folder + "/body.obj");
    const osgSkin::ImportedMesh after = osgSkin::importMesh(folder + "/baked.glb");
    ASSERT_EQ(before.parts.size(), 2u);
    ASSERT_EQ(after.parts.size(), 2u);
    for (std::size_t p = 0; p < 2; ++p) {
        const osg::Material &a = materialOf(before.parts[p]), &b = materialOf(after.parts[p]);
        expectNear(b.getDiffuse(osg::Material::FRONT), a.getDiffuse(osg::Material::FRONT), 1e-5f);
        EXPECT_NEAR(b.getShininess(osg::Material::FRONT), p == 0 ? 0.0f : 30.0f, 1e-3f);
        EXPECT_EQ(before.parts[p].sourceFace.size(), after.parts[p].sourceFace.size());
    }
    ASSERT_NE(textureOf(after.parts[0]), nullptr);
    EXPECT_EQ(textureOf(after.parts[1]), nullptr);
    expectSamePixels(*textureOf(after.parts[0])->getImage(), *smallImage());
    EXPECT_EQ(after.parts[1].geometry->getStateSet()->getMode(GL_BLEND),
              GLenum(osg::StateAttribute::ON));
}

TEST(BakeMaterials, ObjSequenceRefersToTextures) {
    const std::string folder = test::makeTestFolder();
    bake("'" + texturedCharacter(folder, false) + "' --frames 0:1 --out frame_%03d.obj", folder);
    const osgSkin::ImportedMesh before = osgSkin::importMesh(folder + "/body.obj");
    const osgSkin::ImportedMesh after = osgSkin::importMesh(folder + "/frame_001.obj");
    EXPECT_EQ(after.mesh.faceSizes, before.mesh.faceSizes);
    EXPECT_EQ(after.mesh.faceVertices, before.mesh.faceVertices);
    ASSERT_EQ(after.parts.size(), 2u);
    for (std::size_t p = 0; p < 2; ++p) {
        EXPECT_EQ(materialOf(after.parts[p]).getDiffuse(osg::Material::FRONT),
                  materialOf(before.parts[p]).getDiffuse(osg::Material::FRONT));
        const auto& a =
            dynamic_cast<const osg::Vec2Array&>(*before.parts[p].geometry->getTexCoordArray(0));
        const auto& b =
            dynamic_cast<const osg::Vec2Array&>(*after.parts[p].geometry->getTexCoordArray(0));
        EXPECT_EQ(std::vector<osg::Vec2>(a.begin(), a.end()),
                  std::vector<osg::Vec2>(b.begin(), b.end()));
    }
    ASSERT_NE(textureOf(after.parts[0]), nullptr);
    expectSamePixels(*textureOf(after.parts[0])->getImage(), *smallImage());
}

/// glTF's opacity counts if the material is blended.
TEST(BakeMaterials, ObjHasOpacityOnlyOfBlendedMaterials) {
    const std::string folder = test::makeTestFolder();
    for (const bool blends : {false, true}) {
        nlohmann::json gltf = test::readJson(OSGSKIN_TEST_DATA "/rig/tube.gltf");
        gltf["materials"][0] = {{"pbrMetallicRoughness", {{"baseColorFactor", {1, 1, 1, 0.25}}}}};
        if (blends) gltf["materials"][0]["alphaMode"] = "BLEND";
        std::ofstream(folder + "/clear.gltf") << gltf;
        bake("clear.gltf --rest rest.obj", folder);
        const osgSkin::ImportedMesh mesh = osgSkin::importMesh(folder + "/rest.obj");
        EXPECT_EQ(materialOf(mesh.parts.at(0)).getDiffuse(osg::Material::FRONT).a(),
                  blends ? 0.25f : 1.0f);
    }
}

TEST(BakeMaterials, KeepsVertexColours) {
    const std::string folder = test::makeTestFolder();
    const std::string skin = texturedCharacter(folder, true);
    bake("'" + skin + "' --frames 0 --out baked.ply", folder);
    bake("'" + skin + "' --frames 0 --out baked.glb", folder);
    bake("'" + skin + "' --frames 0 --out again.obj", folder);
    expectValid(folder + "/baked.glb");
    for (const char* name : {"/baked.ply", "/baked.glb", "/again.obj"}) {
        SCOPED_TRACE(name);
        for (const osgSkin::MeshPart& part : osgSkin::importMesh(folder + name).parts) {
            EXPECT_EQ(materialOf(part).getColorMode(), osg::Material::AMBIENT_AND_DIFFUSE);
            const auto* colours =
                dynamic_cast<const osg::Vec4Array*>(part.geometry->getColorArray());
            const auto& places =
                dynamic_cast<const osg::Vec3Array&>(*part.geometry->getVertexArray());
            ASSERT_NE(colours, nullptr);
            // The first frame is the rest pose: the colour encodes the height.
            for (std::size_t v = 0; v < places.size(); ++v)
                expectNear((*colours)[v], {0.25f, places[v].y() / 4.0f, 0.75f, 1.0f}, 0.0025f);
        }
    }
}

/// An image of a scene may have the name of a pipe beside the file.
TEST(BakeMaterials, OpensOnlyRegularFilesForTextures) {
    const std::string folder = test::makeTestFolder();
    texturedCharacter(folder, false);
    const osgSkin::ImportedMesh body = osgSkin::importMesh(folder + "/body.obj");
    const osg::ref_ptr<osg::Geode> scene = new osg::Geode;
    for (const osgSkin::MeshPart& part : body.parts) scene->addDrawable(part.geometry);
    auto& texture =
        dynamic_cast<osg::Texture2D&>(*body.parts[0].geometry->getStateSet()->getTextureAttribute(
            0, osg::StateAttribute::TEXTURE));
    texture.getImage()->setFileName("pipe.png");
    const osg::ref_ptr<osgDB::Options> inlined = new osgDB::Options("WriteImageHint=IncludeData");
    ASSERT_TRUE(osgDB::writeNodeFile(*scene, folder + "/body.osgt", inlined));
    nlohmann::json skin = test::readJson(folder + "/body.skin");
    skin["mesh"] = "body.osgt";
    std::ofstream(folder + "/body.skin") << skin;

    const std::string pipe = folder + "/pipe.png";
    ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
    std::atomic<bool> baked{false}, wasOpened{false};
    std::thread other([&] { // waits for a reader of the pipe, which would wait for it
        const int end = ::open(pipe.c_str(), O_WRONLY);
        wasOpened = !baked;
        ::close(end);
    });
    bake("body.skin --formats all --frames 0 --out baked.glb", folder);
    baked = true;
    const int end = ::open(pipe.c_str(), O_RDONLY | O_NONBLOCK);
    other.join();
    ::close(end);
    EXPECT_FALSE(wasOpened);
    const osgSkin::ImportedMesh after = osgSkin::importMesh(folder + "/baked.glb");
    ASSERT_NE(textureOf(after.parts.at(0)), nullptr);
    expectSamePixels(*textureOf(after.parts[0])->getImage(), *smallImage());
}
