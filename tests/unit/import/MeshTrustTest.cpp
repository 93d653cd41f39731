// SPDX-License-Identifier: MIT
// What a mesh file says wrongly, and how much is said about it.
#include "ExpectError.h"
#include "Notices.h"
#include "Paths.h"

#include <osgSkinImport/ImportMesh>

#include <osg/Array>
#include <osg/Material>
#include <osgDB/Options>

#include <filesystem>
#include <fstream>
#include <vector>

namespace {

/// A cube, its normals along the faces' own or against them, as an OBJ file.
std::string cube(const std::string& name, double side, const std::string& materials = "") {
    std::string path = testing::TempDir() + name;
    std::ofstream out(path);
    if (!materials.empty()) out << "mtllib " << materials << "\n";
    for (int v = 0; v < 8; ++v)
        out << "v " << (v & 1) << " " << (v >> 1 & 1) << " " << (v >> 2) << "\n";
    const int faces[6][4] = {{1, 3, 4, 2}, {5, 6, 8, 7}, {1, 2, 6, 5},
                             {3, 7, 8, 4}, {1, 5, 7, 3}, {2, 4, 8, 6}};
    const int normals[6][3] = {{0, 0, -1}, {0, 0, 1}, {0, -1, 0}, {0, 1, 0}, {-1, 0, 0}, {1, 0, 0}};
    for (const auto& n : normals)
        out << "vn " << side * n[0] << " " << side * n[1] << " " << side * n[2] << "\n";
    for (int f = 0; f < 6; ++f) {
        if (!materials.empty()) out << "usemtl m" << f << "\n";
        out << "f";
        for (const int v : faces[f]) out << " " << v << "//" << f + 1;
        out << "\n";
    }
    return path;
}

/// How far the normals point outwards at the cube's corners, at least.
double outwards(const osgSkin::ImportedMesh& mesh) {
    double least = 1.0;
    for (const osgSkin::MeshPart& part : mesh.parts) {
        const auto& normals = dynamic_cast<const osg::Vec3Array&>(*part.geometry->getNormalArray());
        const auto& places = dynamic_cast<const osg::Vec3Array&>(*part.geometry->getVertexArray());
        for (std::size_t v = 0; v < normals.size(); ++v)
            least = std::min(least, double(normals[v] * (places[v] - osg::Vec3(0.5f, 0.5f, 0.5f))));
    }
    return least;
}

} // namespace

TEST(MeshTrust, NormalsThatContradictTheirFacesAreComputedAnew) {
    {
        const test::Notices notices;
        const osgSkin::ImportedMesh mesh = osgSkin::importMesh(cube("inward.obj", -1.0));
        EXPECT_GT(outwards(mesh), 0.4);
        EXPECT_EQ(notices.lines(), 1u) << notices.text();
        EXPECT_TRUE(notices.say("normals of 6 of 6 faces")) << notices.text();
    }
    const test::Notices notices;
    const osgSkin::ImportedMesh mesh = osgSkin::importMesh(cube("outward.obj", 1.0));
    EXPECT_GT(outwards(mesh), 0.4);
    const auto& normals =
        dynamic_cast<const osg::Vec3Array&>(*mesh.parts[0].geometry->getNormalArray());
    EXPECT_EQ(normals.size(), 24u) << "the file's own, a face";
    EXPECT_EQ(notices.text(), "");
}

TEST(MeshTrust, MissingTexturesAreOneLine) {
    std::ofstream materials(testing::TempDir() + "textured.mtl");
    for (int m = 0; m < 6; ++m) materials << "newmtl m" << m << "\nmap_Kd nowhere" << m << ".png\n";
    materials.close();
    const test::Notices notices;
    osgSkin::importMesh(cube("textured.obj", 1.0, "textured.mtl"));
    EXPECT_EQ(notices.lines(), 1u) << notices.text();
    EXPECT_TRUE(notices.say("6 textures, \"nowhere0.png\" among them, cannot be read"))
        << notices.text();
}

TEST(MeshTrust, MissingMaterialsAreOneLine) {
    const test::Notices notices;
    osgSkin::importMesh(cube("unmade.obj", 1.0, "no_such.mtl"));
    EXPECT_EQ(notices.lines(), 1u) << notices.text();
}

/// The colours of an OBJ mesh's parts, red, green and blue, in the order of its faces.
static std::vector<osg::Vec4> coloursOf(const osgSkin::ImportedMesh& mesh) {
    std::vector<osg::Vec4> result;
    for (const osgSkin::MeshPart& part : mesh.parts)
        result.push_back(
            dynamic_cast<const osg::Material&>(
                *part.geometry->getStateSet()->getAttribute(osg::StateAttribute::MATERIAL))
                .getDiffuse(osg::Material::FRONT));
    return result;
}

TEST(MeshTrust, NamesOfMaterialsAndLibrariesMayHaveBlanks) {
    const std::string folder = testing::TempDir() + "blanks/";
    std::filesystem::create_directories(folder + "a b");
    std::ofstream(folder + "a b/my looks.mtl")
        << "newmtl skin\nKd 0 0 1\nnewmtl skin of the face\nKd 1 0 0\r\n"
           "newmtl  skin of the hands \nKd 0 1 0\n";
    for (const char* library :
         {"a b/my looks.mtl", "a b\\my looks.mtl", " .\\a b\\my looks.mtl "}) {
        std::ofstream(folder + "mesh.obj")
            << "mtllib " << library
            << "\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl skin of the face\nf 1 2 3\n"
               "usemtl skin of the hands\t\nf 1 2 3\nusemtl skin\nf 1 2 3\n";
        const test::Notices notices;
        const std::vector<osg::Vec4> colours = coloursOf(osgSkin::importMesh(folder + "mesh.obj"));
        EXPECT_EQ(notices.text(), "");
        ASSERT_EQ(colours.size(), 3u) << library;
        EXPECT_EQ(colours[0], osg::Vec4(1, 0, 0, 1));
        EXPECT_EQ(colours[1], osg::Vec4(0, 1, 0, 1));
        EXPECT_EQ(colours[2], osg::Vec4(0, 0, 1, 1));
    }
}

/// Three bytes a vertex: each is bound.
TEST(MeshTrust, VerticesAreInProportion) {
    const std::string path = testing::TempDir() + "bytes.ply";
    const std::size_t vertices = 200'000;
    std::ofstream out(path, std::ios::binary);
    out << "ply\nformat binary_little_endian 1.0\nelement vertex " << vertices
        << "\nproperty uchar x\nproperty uchar y\nproperty uchar z\nelement face 1\n"
           "property list uchar int vertex_indices\nend_header\n";
    for (std::size_t v = 0; v < vertices; ++v)
        out << char(v % 256) << char(v / 256 % 256) << char(v / 65536);
    out.write("\x03\0\0\0\0\x01\0\0\0\0\x01\0\0", 13);
    out.close();
    expectError([&] { osgSkin::importMesh(path); }, "200000 vertices, expected at most ");
    const osg::ref_ptr<osgDB::Options> more = new osgDB::Options("maxSamples=2000000");
    EXPECT_EQ(osgSkin::importMesh(path, more).mesh.positions.size(), vertices);
}

TEST(MeshTrust, ColoursOfFacesAreToldOf) {
    const std::string ply = testing::TempDir() + "faces.ply",
                      off = testing::TempDir() + "faces.off";
    std::ofstream(ply) << "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\n"
                          "property float y\nproperty float z\nelement face 1\n"
                          "property list uchar int vertex_indices\nproperty uchar red\n"
                          "property uchar green\nproperty uchar blue\nend_header\n"
                          "0 0 0\n1 0 0\n0 1 0\n3 0 1 2 255 0 0\n";
    std::ofstream(off) << "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2 255 0 0\n";
    const test::Notices notices;
    EXPECT_EQ(osgSkin::importMesh(ply).mesh.faceSizes.size(), 1u);
    EXPECT_TRUE(notices.say("faces.ply: colours of faces are left out")) << notices.text();
    EXPECT_EQ(osgSkin::importMesh(off).mesh.faceSizes.size(), 1u);
    EXPECT_TRUE(notices.say("1 of 1 faces have colours, which are left out")) << notices.text();
}
