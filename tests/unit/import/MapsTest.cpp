// SPDX-License-Identifier: MIT
// Normal, occlusion and emission maps: tangents, texture units, and what is left out.
#include "ColouredMap.h"
#include "GltfBuilder.h"
#include "MeshParts.h"
#include "Notices.h"
#include "Paths.h"
#include "TextFile.h"

#include <osgSkinImport/ImportMesh>
#include <osgSkinImport/ReadScene>

#include <osg/Array>
#include <osg/Material>
#include <osg/Program>
#include <osg/Texture2D>
#include <osgDB/WriteFile>

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <set>
#include <string>
#include <vector>

namespace {

using nlohmann::json;
using osgSkin::ImportedMesh;
using osgSkin::MeshPart;

const double kPi = std::acos(-1.0);

/// A file name that no other test writes: tests run in parallel.
std::string named(const std::string& ending) {
    return testing::UnitTest::GetInstance()->current_test_info()->name() + ending;
}

/// Half a tube of radius 1 about y, open to -z, whose v grows along y.
struct HalfTube : test::GltfBuilder {
    static constexpr int kColumns = 13; // from -90 to 90 degrees
    std::vector<double> tangents;       // analytic where u grows with the angle

    /// \param u by the angle about y, from z to x
    explicit HalfTube(double (*u)(double angle)) {
        std::vector<double> positions, normals, texCoords, corners;
        for (int column = 0; column < kColumns; ++column)
            for (int row = 0; row < 2; ++row) {
                const double angle = kPi * (column / double(kColumns - 1) - 0.5);
                positions.insert(positions.end(), {std::sin(angle), double(row), std::cos(angle)});
                normals.insert(normals.end(), {std::sin(angle), 0.0, std::cos(angle)});
                tangents.insert(tangents.end(), {std::cos(angle), 0.0, -std::sin(angle), 1.0});
                texCoords.insert(texCoords.end(), {u(angle), 1.0 - row}); // v down
            }
        for (int column = 0; column + 1 < kColumns; ++column)
            for (const int corner : {0, 2, 1, 1, 2, 3}) corners.push_back(2 * column + corner);
        json["meshes"].push_back({{"primitives",
                                   {{{"attributes",
                                      {{"POSITION", accessor("VEC3", positions)},
                                       {"NORMAL", accessor("VEC3", normals)},
                                       {"TEXCOORD_0", accessor("VEC2", texCoords)}}},
                                     {"indices", accessor("SCALAR", corners, 5123)},
                                     {"material", 0}}}}});
        json["scenes"][0]["nodes"] = {node({{"mesh", 0}})};
        const std::string map = named(".bmp");
        test::writeMap(map, {});
        json["images"] = {{{"uri", map}}};
        json["textures"] = {{{"source", 0}}};
        json["materials"] = {{{"normalTexture", {{"index", 0}}}}};
    }

    nlohmann::json& material() { return json["materials"][0]; }
    nlohmann::json& attributes() { return json["meshes"][0]["primitives"][0]["attributes"]; }
    ImportedMesh read() { return osgSkin::importMesh(save(named(".gltf"))); }
};

double along(double angle) {
    return angle / kPi;
}
double against(double angle) {
    return -angle / kPi;
}
/// Both halves have the same part of the texture, as on most characters.
double mirrored(double angle) {
    return std::abs(angle) / kPi;
}

const osg::Vec4Array* tangentsOf(const ImportedMesh& mesh) {
    return dynamic_cast<const osg::Vec4Array*>(
        mesh.parts.at(0).geometry->getVertexAttribArray(MeshPart::kTangentAttribute));
}

/// Expects tangents of unit length around y, to `sign` of the growing angle at positive angles and
/// to `signBelow` at negative ones.
/// \return the number of vertices
std::size_t expectAround(const ImportedMesh& mesh, float sign, float signBelow) {
    const osg::Vec4Array* tangents = tangentsOf(mesh);
    if (tangents == nullptr) {
        ADD_FAILURE() << "no tangents";
        return 0;
    }
    EXPECT_EQ(tangents->getBinding(), osg::Array::BIND_PER_VERTEX);
    const osg::Geometry& geometry = *mesh.parts[0].geometry;
    const auto& positions = dynamic_cast<const osg::Vec3Array&>(*geometry.getVertexArray());
    EXPECT_EQ(tangents->size(), positions.size());
    std::size_t middle = 0;
    for (std::size_t v = 0; v < positions.size(); ++v) {
        const osg::Vec3& p = positions[v];
        const osg::Vec4& t = (*tangents)[v];
        const bool isMiddle = std::abs(p.x()) < 1e-6f;
        middle += isMiddle;
        const float expected = isMiddle ? t.w() : p.x() > 0.0f ? sign : signBelow;
        EXPECT_EQ(t.w(), expected) << v;
        const osg::Vec4 analytic(p.z() * expected, 0.0f, -p.x() * expected, expected);
        EXPECT_LT((t - analytic).length(), 2e-6f) << v;
    }
    EXPECT_EQ(middle, sign == signBelow ? 2u : 4u);
    return positions.size();
}

template <typename Attribute>
const Attribute* attributeOf(const ImportedMesh& mesh, osg::StateAttribute::Type type) {
    return dynamic_cast<const Attribute*>(
        mesh.parts.at(0).geometry->getStateSet()->getAttribute(type));
}

bool hasTexture(const ImportedMesh& mesh, unsigned unit) {
    return imageOf(mesh.parts.at(0), unit) != nullptr;
}

} // namespace

TEST(Maps, ComputesTangentsFromTextureCoordinates) {
    EXPECT_EQ(expectAround(HalfTube(along).read(), 1.0f, 1.0f), 26u);
    EXPECT_EQ(expectAround(HalfTube(against).read(), -1.0f, -1.0f), 26u);
    // Only vertices between both halves are duplicated.
    EXPECT_EQ(expectAround(HalfTube(mirrored).read(), 1.0f, -1.0f), 28u);
}

TEST(Maps, UsesTangentsOfTheFile) {
    for (const bool isMirrored : {false, true}) {
        HalfTube tube(against);
        // Of coordinates that grow with the angle; not those of the texture.
        tube.attributes()["TANGENT"] = tube.accessor("VEC4", tube.tangents);
        if (isMirrored) tube.json["nodes"][0]["scale"] = {-1, 1, 1};
        const float sign = isMirrored ? -1.0f : 1.0f;
        EXPECT_EQ(expectAround(tube.read(), sign, sign), 26u);
    }
    // A rotated texture needs others.
    HalfTube tube(along);
    tube.attributes()["TANGENT"] = tube.accessor("VEC4", tube.tangents);
    tube.material()["normalTexture"]["extensions"] = {
        {"KHR_texture_transform", {{"rotation", kPi}}}};
    const ImportedMesh mesh = tube.read();
    ASSERT_NE(tangentsOf(mesh), nullptr);
    for (const osg::Vec4& t : *tangentsOf(mesh)) EXPECT_LT(t.x(), 1e-6f);
}

TEST(Maps, RecomputesInvalidTangents) {
    for (const double wrong : {0.0, std::nan("")}) {
        HalfTube tube(along);
        std::vector<double> tangents = tube.tangents;
        for (int i = 0; i < 3; ++i) tangents[std::size_t(i)] = wrong;
        tube.attributes()["TANGENT"] = tube.accessor("VEC4", tangents);
        expectAround(tube.read(), 1.0f, 1.0f);
    }
    // Texture coordinates that are all the same give no direction.
    const ImportedMesh mesh = HalfTube([](double) { return 0.5; }).read();
    ASSERT_NE(tangentsOf(mesh), nullptr);
    const auto& normals = normalsOf(mesh);
    for (std::size_t v = 0; v < normals.size(); ++v) {
        const osg::Vec4& t = tangentsOf(mesh)->at(v);
        const osg::Vec3 direction(t.x(), t.y(), t.z());
        EXPECT_NEAR(direction.length(), 1.0f, 1e-5f);
        EXPECT_NEAR(direction * normals[v], 0.0f, 1e-5f);
    }
}

TEST(Maps, MaterialsWithoutMapsUseTheFixedPipeline) {
    HalfTube tube(mirrored);
    tube.attributes()["TANGENT"] = tube.accessor("VEC4", tube.tangents);
    tube.material() = {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}};
    const test::Notices notices;
    const ImportedMesh mesh = tube.read();
    EXPECT_EQ(tangentsOf(mesh), nullptr);
    EXPECT_EQ(attributeOf<osg::Program>(mesh, osg::StateAttribute::PROGRAM), nullptr);
    EXPECT_TRUE(mesh.parts[0].geometry->getStateSet()->getUniformList().empty());
    EXPECT_EQ(mesh.parts[0].sourceVertex.size(), 26u);
    EXPECT_EQ(notices.text(), "");
}

TEST(Maps, EachHasItsTextureUnit) {
    HalfTube tube(along);
    const json texture = {{"index", 0}};
    tube.material() = {{"pbrMetallicRoughness", {{"baseColorTexture", texture}}},
                       {"normalTexture", {{"index", 0}, {"scale", 0.5}}},
                       {"occlusionTexture", {{"index", 0}, {"strength", 0.25}}},
                       {"emissiveTexture", texture},
                       {"emissiveFactor", {1, 0, 0}}};
    const test::Notices notices;
    const ImportedMesh mesh = tube.read();
    const osg::StateSet& state = *mesh.parts.at(0).geometry->getStateSet();
    EXPECT_NE(attributeOf<osg::Program>(mesh, osg::StateAttribute::PROGRAM), nullptr);
    for (unsigned unit = 0; unit < 4; ++unit) {
        EXPECT_TRUE(hasTexture(mesh, unit)) << unit;
        // Without the program, the fixed pipeline draws the first one alone.
        EXPECT_EQ(state.getTextureMode(unit, GL_TEXTURE_2D),
                  unit == 0 ? osg::StateAttribute::ON : osg::StateAttribute::INHERIT);
    }
    const auto number = [&](const char* name) {
        float value = -1.0f;
        state.getUniform(name)->get(value);
        return value;
    };
    EXPECT_EQ(number("osgSkinNormalScale"), 0.5f);
    EXPECT_EQ(number("osgSkinOcclusionStrength"), 0.25f);
    osg::Vec3 glow;
    state.getUniform("osgSkinEmission")->get(glow);
    EXPECT_LT((glow - osg::Vec3(1, 0, 0)).length(), 1e-6f);
    EXPECT_EQ(emissionOf(mesh), osg::Vec4(0, 0, 0, 1));
    EXPECT_EQ(notices.text(), "");
}

TEST(Maps, ReportsUnusedTexturesOnce) {
    HalfTube tube(along);
    const json texture = {{"index", 0}}, other = {{"index", 0}, {"texCoord", 1}};
    const json rough = {{"baseColorTexture", texture}, {"metallicRoughnessTexture", texture}};
    tube.material() = {
        {"pbrMetallicRoughness", rough},
        {"normalTexture", texture},
        {"occlusionTexture", other}, // needs coordinates of its own
        {"emissiveTexture", other},
        {"emissiveFactor", {1, 1, 1}},
        {"extras", {{"someTexture", texture}}},
        {"extensions", {{"KHR_materials_clearcoat", {{"clearcoatNormalTexture", texture}}}}}};
    json second = {{"pbrMetallicRoughness", rough}, {"emissiveTexture", texture}}; // times 0
    tube.json["materials"].push_back(second);
    // Only the diffuse texture counts in an unlit material.
    second["extensions"]["KHR_materials_unlit"] = json::object();
    tube.json["materials"].push_back(second);
    const test::Notices notices;
    const ImportedMesh mesh = tube.read();
    EXPECT_TRUE(notices.say("textures left out: clearcoatNormalTexture (1), emissiveTexture (1), "
                            "metallicRoughnessTexture (2), occlusionTexture (1)\n"))
        << notices.text();
    EXPECT_EQ(notices.lines(), 1u) << notices.text();
    for (unsigned unit = 0; unit < 4; ++unit) EXPECT_EQ(hasTexture(mesh, unit), unit < 2) << unit;
    // Without its texture, the colour would make the whole surface glow.
    EXPECT_EQ(emissionOf(mesh), osg::Vec4(0, 0, 0, 1));
}

TEST(Maps, MissingEmissionTextureDoesNotGlow) {
    HalfTube tube(along);
    tube.json["images"].push_back({{"uri", "missing.png"}});
    tube.json["textures"].push_back({{"source", 1}});
    tube.material() = {{"emissiveTexture", {{"index", 1}}}, {"emissiveFactor", {1, 1, 1}}};
    const test::Notices notices;
    const ImportedMesh mesh = tube.read();
    EXPECT_TRUE(notices.say("missing.png\" cannot be read; drawn without")) << notices.text();
    EXPECT_EQ(emissionOf(mesh), osg::Vec4(0, 0, 0, 1));
    EXPECT_EQ(attributeOf<osg::Program>(mesh, osg::StateAttribute::PROGRAM), nullptr);
}

TEST(Maps, ReadsObjMaps) {
    const std::string folder = testing::TempDir(), path = folder + named(".obj");
    const std::string map = named(".bmp");
    test::writeMap(map, {});
    std::ofstream(path) << "mtllib " << named(".mtl")
                        << "\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nusemtl m\n"
                           "f 1/1 2/2 3/3\n";
    std::ofstream(folder + named(".mtl"))
        << "newmtl m\nmap_Kd " << map << "\nnorm " << map << "\nmap_Ke " << map << "\nmap_Bump "
        << map << "\nmap_Ks " << map << "\nmap_Ka " << map << "\n";
    const test::Notices notices;
    const ImportedMesh mesh = osgSkin::importMesh(path);
    for (unsigned unit = 0; unit < 4; ++unit) EXPECT_EQ(hasTexture(mesh, unit), unit != 2) << unit;
    ASSERT_NE(tangentsOf(mesh), nullptr);
    for (const osg::Vec4& tangent : *tangentsOf(mesh)) EXPECT_EQ(tangent, osg::Vec4(1, 0, 0, 1));
    EXPECT_TRUE(notices.say("textures left out: map_Bump (1), map_Ks (1)\n")) << notices.text();
    EXPECT_EQ(notices.lines(), 1u) << notices.text();
}

TEST(Maps, ReadsColladaMaps) {
    const std::string map = named(".bmp");
    test::writeMap(map, {});
    std::string text = test::fileText(testData("mesh/maps.dae"));
    const std::string name = "IMAGE_FILE";
    text.replace(text.find(name), name.size(), map);
    const std::string path = test::saveText(named(".dae"), text);
    const test::Notices notices;
    const ImportedMesh mesh = osgSkin::importMesh(path);
    for (unsigned unit = 0; unit < 4; ++unit) EXPECT_EQ(hasTexture(mesh, unit), unit < 2) << unit;
    ASSERT_NE(tangentsOf(mesh), nullptr);
    // Mirrored: u grows along y.
    for (const osg::Vec4& tangent : *tangentsOf(mesh)) EXPECT_EQ(tangent, osg::Vec4(0, 1, 0, -1));
    EXPECT_TRUE(notices.say("textures left out: Specular (1)\n")) << notices.text();
    EXPECT_EQ(notices.lines(), 1u) << notices.text();
}

/// Tangents of saved scenes are not read as a mesh; they are computed.
TEST(Maps, RecomputesTangentsOfSavedScenes) {
    const ImportedMesh mesh = HalfTube(along).read();
    for (const char* ending : {".osgt", ".osgb", ".osgx"}) {
        const std::string path = testing::TempDir() + named(ending);
        ASSERT_TRUE(osgDB::writeNodeFile(*mesh.parts[0].geometry, path));
        const ImportedMesh again = osgSkin::importMesh(path);
        expectAround(again, 1.0f, 1.0f);
        EXPECT_NE(attributeOf<osg::Program>(again, osg::StateAttribute::PROGRAM), nullptr);
    }
}
