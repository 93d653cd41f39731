// SPDX-License-Identifier: MIT
// Meshes of each format, and errors and warnings of mesh files.
#include "ExpectError.h"
#include "MeshParts.h"
#include "NamedCase.h"
#include "Notices.h"
#include "Paths.h"

#include <osgSkinImport/ImportMesh>

#include <osg/Array>
#include <osg/Geometry>
#include <osg/Material>
#include <osg/MatrixTransform>
#include <osgDB/Options>
#include <osgDB/WriteFile>

#include <filesystem>
#include <fstream>
#include <ostream>
#include <string>
#include <vector>

namespace {

using Indices = std::vector<std::uint32_t>;

const osg::Vec3Array& normals(const osgSkin::MeshPart& part) {
    return dynamic_cast<const osg::Vec3Array&>(*part.geometry->getNormalArray());
}

const osg::Vec3Array& vertices(const osgSkin::MeshPart& part) {
    return dynamic_cast<const osg::Vec3Array&>(*part.geometry->getVertexArray());
}

const osg::DrawElementsUInt& triangles(const osgSkin::MeshPart& part) {
    return dynamic_cast<const osg::DrawElementsUInt&>(*part.geometry->getPrimitiveSet(0));
}

/// Invariants of every part, for every format.
void expectConsistent(const osgSkin::ImportedMesh& imported) {
    std::vector<std::size_t> trianglesOf(imported.mesh.faceSizes.size(), 0);
    for (const osgSkin::MeshPart& part : imported.parts) {
        ASSERT_EQ(part.geometry->getNumPrimitiveSets(), 1u);
        ASSERT_EQ(vertices(part).size(), part.sourceVertex.size());
        ASSERT_EQ(normals(part).size(), part.sourceVertex.size());
        EXPECT_EQ(normals(part).getBinding(), osg::Array::BIND_PER_VERTEX);
        ASSERT_EQ(triangles(part).size(), 3 * part.sourceFace.size());
        EXPECT_EQ(triangles(part).getMode(), static_cast<GLenum>(GL_TRIANGLES));
        for (std::size_t v = 0; v < part.sourceVertex.size(); ++v) {
            const glm::dvec3& p = imported.mesh.positions[part.sourceVertex[v]];
            EXPECT_EQ(vertices(part)[v], osg::Vec3(osg::Vec3d(p.x, p.y, p.z)));
            EXPECT_NEAR(normals(part)[v].length(), 1.0f, 1e-6f);
        }
        for (const std::uint32_t face : part.sourceFace) ++trianglesOf[face];
        ASSERT_NE(part.geometry->getStateSet(), nullptr);
    }
    for (std::size_t f = 0; f < trianglesOf.size(); ++f)
        EXPECT_EQ(trianglesOf[f], imported.mesh.faceSizes[f] - 2) << "face " << f;
}

TEST(ImportObj, KeepsVerticesAndPolygonsInFileOrder) {
    const osgSkin::ImportedMesh imported = osgSkin::importMesh(testData("mesh/quads.obj"));
    ASSERT_EQ(imported.mesh.positions.size(), 8u);
    EXPECT_EQ(imported.mesh.positions[6], glm::dvec3(2.5, 0.5, 0));
    EXPECT_EQ(imported.mesh.positions[7].x, 0.1234567890123); // all digits
    EXPECT_EQ(imported.mesh.faceSizes, (Indices{4, 4, 3}));
    // The last face has negative indices, relative to the end of the list.
    EXPECT_EQ(imported.mesh.faceVertices, (Indices{3, 0, 1, 2, 1, 4, 5, 2, 4, 6, 5}));
    expectConsistent(imported);
}

TEST(ImportObj, MakesOnePartForEachMaterial) {
    const osgSkin::ImportedMesh imported = osgSkin::importMesh(testData("mesh/quads.obj"));
    ASSERT_EQ(imported.parts.size(), 2u);
    EXPECT_EQ(imported.parts[0].sourceFace, (Indices{0, 0, 2}));
    EXPECT_EQ(imported.parts[1].sourceFace, (Indices{1, 1}));
    EXPECT_EQ(diffuseOf(imported), osg::Vec4(0.75f, 0.25f, 0.125f, 1.0f));
}

TEST(ImportObj, ReadsVertexColours) {
    const osgSkin::ImportedMesh imported = osgSkin::importMesh(testData("mesh/coloured.obj"));
    ASSERT_EQ(imported.parts.size(), 1u);
    const auto& colours = coloursOf(imported);
    ASSERT_EQ(colours.size(), 3u);
    EXPECT_EQ(colours[1], osg::Vec4(0.0f, 0.5f, 0.25f, 1.0f));
    EXPECT_EQ(materialOf(imported).getColorMode(), osg::Material::AMBIENT_AND_DIFFUSE);
    EXPECT_EQ(osgSkin::importMesh(testData("mesh/quads.obj")).parts[0].geometry->getColorArray(),
              nullptr);
}

TEST(ImportObj, DuplicatesVerticesWithDifferentAttributes) {
    const osgSkin::ImportedMesh imported = osgSkin::importMesh(testData("mesh/quads.obj"));
    // Corner 2/2 of the first face and 2/5 of the second are in different parts; within the first
    // part no vertex has two texture coordinates.
    EXPECT_EQ(imported.parts[0].sourceVertex.size(), 7u);
    EXPECT_EQ(imported.parts[1].sourceVertex.size(), 4u);
    ASSERT_NE(imported.parts[0].geometry->getTexCoordArray(0), nullptr);
}

TEST(ImportObj, UsesTheFilesNormals) {
    const osgSkin::ImportedMesh imported = osgSkin::importMesh(testData("mesh/with_normals.obj"));
    expectConsistent(imported);
    for (const osg::Vec3& n : normals(imported.parts[0]))
        EXPECT_LT((n - osg::Vec3(0.0f, 0.6f, 0.8f)).length(), 1e-6f);
    EXPECT_EQ(imported.parts[0].geometry->getTexCoordArray(0), nullptr);
}

TEST(ImportObj, ComputesNormalsWhereSomeAreMissing) {
    const osgSkin::ImportedMesh imported = osgSkin::importMesh(testData("mesh/some_normals.obj"));
    expectConsistent(imported);
    EXPECT_EQ(imported.parts[0].sourceVertex.size(), 4u);
    for (const osg::Vec3& n : normals(imported.parts[0]))
        EXPECT_LT((n - osg::Vec3(0, 0, 1)).length(), 1e-6f);
}

TEST(ImportObj, SharesNormalsBetweenVerticesAtOnePosition) {
    const osgSkin::ImportedMesh roof = osgSkin::importMesh(testData("mesh/split_positions.obj"));
    expectConsistent(roof);
    const osgSkin::MeshPart& part = roof.parts[0];
    std::size_t ridge = 0;
    for (std::size_t v = 0; v < part.sourceVertex.size(); ++v)
        if (vertices(part)[v].y() == 1.0f) {
            EXPECT_LT((normals(part)[v] - osg::Vec3(0, 1, 0)).length(), 1e-6f);
            ++ridge;
        }
    EXPECT_EQ(ridge, 4u);
}

TEST(ImportPly, ReadsBinary) {
    const osgSkin::ImportedMesh imported =
        osgSkin::importMesh(testData("mesh/triangle_binary.ply"));
    ASSERT_EQ(imported.mesh.positions.size(), 3u);
    EXPECT_EQ(imported.mesh.positions[1], glm::dvec3(1, 0, 0));
    EXPECT_EQ(imported.mesh.faceSizes, (Indices{3}));
}

TEST(ImportAssimp, KeepsPolygons) {
    const osgSkin::ImportedMesh imported = osgSkin::importMesh(testData("mesh/square.ply"));
    EXPECT_EQ(imported.mesh.faceSizes, (Indices{4}));
    EXPECT_EQ(imported.mesh.faceVertices, (Indices{0, 1, 2, 3}));
    EXPECT_EQ(imported.mesh.positions[2], glm::dvec3(1, 1, 0));
    expectConsistent(imported);
}

TEST(ImportOsg, TransformsTriangles) {
    osg::ref_ptr<osg::Geometry> geometry = new osg::Geometry;
    const osg::Vec3 corners[] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    geometry->setVertexArray(new osg::Vec3Array(4, corners));
    geometry->addPrimitiveSet(new osg::DrawArrays(GL_QUADS, 0, 4));
    geometry->addPrimitiveSet(new osg::DrawArrays(GL_POINTS, 0, 4));
    osg::ref_ptr<osg::MatrixTransform> moved =
        new osg::MatrixTransform(osg::Matrix::translate(0, 0, 5));
    moved->addChild(geometry);
    osg::ref_ptr<osg::MatrixTransform> mirror =
        new osg::MatrixTransform(osg::Matrix::scale(-1, 1, 1));
    mirror->addChild(moved);
    const std::string path = testing::TempDir() + "osgskin_square.osgt";
    ASSERT_TRUE(osgDB::writeNodeFile(*mirror, path));
    const osgSkin::ImportedMesh imported = osgSkin::importMesh(path);
    std::filesystem::remove(path);
    EXPECT_EQ(imported.mesh.faceSizes, (Indices{3, 3}));
    EXPECT_EQ(imported.mesh.positions[2], glm::dvec3(-1, 1, 5));
    expectConsistent(imported);
    // Mirrored, the square still faces +z.
    for (const osg::Vec3& n : normals(imported.parts[0]))
        EXPECT_LT((n - osg::Vec3(0, 0, 1)).length(), 1e-6f);
}

/// Rotated and flattened: normals stay perpendicular to the surface.
TEST(ImportOsg, TransformsNormals) {
    const osg::ref_ptr<osg::Geometry> slope = new osg::Geometry;
    const osg::Vec3 corners[] = {{0, 0, 0}, {1, 0, 1}, {0, 1, 0}};
    osg::Vec3 smooth(-0.8f, 0.2f, 1.0f); // as for a round surface, not the triangle's own
    smooth.normalize();
    const osg::Vec3 given[] = {smooth, smooth, smooth};
    slope->setVertexArray(new osg::Vec3Array(3, corners));
    slope->setNormalArray(new osg::Vec3Array(3, given), osg::Array::BIND_PER_VERTEX);
    slope->addPrimitiveSet(new osg::DrawArrays(GL_TRIANGLES, 0, 3));
    const osg::Matrix place =
        osg::Matrix::scale(1, 1, 0.5) * osg::Matrix::rotate(0.7, osg::Vec3(1, 2, 3));
    const osg::ref_ptr<osg::MatrixTransform> placed = new osg::MatrixTransform(place);
    placed->addChild(slope);
    const std::string path = testing::TempDir() + "osgskin_slope.osgt";
    ASSERT_TRUE(osgDB::writeNodeFile(*placed, path));
    const osgSkin::ImportedMesh imported = osgSkin::importMesh(path);
    std::filesystem::remove(path);
    osg::Vec3 expected = osg::Matrix::transform3x3(osg::Matrix::inverse(place), smooth);
    expected.normalize();
    for (const osg::Vec3& n : normals(imported.parts[0])) EXPECT_LT((n - expected).length(), 1e-6f);
}

struct Body {
    const char* file;
    std::size_t vertices;
    std::size_t faces;
};

void PrintTo(const Body& body, std::ostream* out) {
    *out << body.file;
}

class SharedBody : public testing::TestWithParam<Body> {};

TEST_P(SharedBody, ReadsAllVerticesAndFaces) {
    const std::string path = sharedData(GetParam().file);
    OSGSKIN_NEEDS(path);
    const osgSkin::ImportedMesh imported = osgSkin::importMesh(path);
    EXPECT_EQ(imported.mesh.positions.size(), GetParam().vertices);
    EXPECT_EQ(imported.mesh.faceSizes.size(), GetParam().faces);
    expectConsistent(imported);
}

INSTANTIATE_TEST_SUITE_P(Files, SharedBody,
                         testing::Values(Body{"makehuman/body/body4k_neutral.obj", 4000, 7996},
                                         Body{"makehuman/body/body_male.obj", 13380, 13378},
                                         Body{"human_blend/human_4282.obj", 4282, 4280}),
                         [](const auto& body) {
                             return "faces" + std::to_string(body.param.faces);
                         });

class BadMesh : public testing::TestWithParam<BadFile> {};

TEST_P(BadMesh, ErrorNamesFileAndPosition) {
    const std::string path = testData(std::string("mesh/") + GetParam().file);
    ASSERT_TRUE(std::filesystem::exists(path));
    expectError([&] { osgSkin::importMesh(path); }, path + ": " + GetParam().message);
}

INSTANTIATE_TEST_SUITE_P(
    Files, BadMesh,
    testing::Values(
        BadFile{"empty.obj", "no face, expected at least one"},
        BadFile{"no_faces.obj", "no face, expected at least one"},
        BadFile{"nan_vertex.obj", "line 2: \"nan\" in a \"v\" line, expected 3 finite numbers"},
        BadFile{"word_vertex.obj", "line 2: \"zero\" in a \"v\" line"},
        BadFile{"trailing_letters.obj", "line 2: \"0x\" in a \"v\" line"},
        BadFile{"short_vertex.obj", "line 2: nothing in a \"v\" line"},
        BadFile{"huge_vertex.obj", "line 2: \"1e999\" in a \"v\" line"},
        BadFile{"zero_index.obj", "line 4: \"0\" in a face, expected a vertex from 1 to 3"},
        BadFile{"index_too_large.obj", "line 4: \"4\" in a face, expected a vertex from 1 to 3"},
        BadFile{"index_too_negative.obj", "line 4: \"-4\" in a face"},
        BadFile{"index_beyond_integers.obj", "line 4: \"99999999999999999999\" in a face"},
        BadFile{"word_index.obj", "line 4: \"three\" in a face"},
        BadFile{"texture_index_too_large.obj", "line 5: \"3/2\" in a face"},
        BadFile{"two_corners.obj", "line 4: a face with 2 corners"},
        BadFile{"face_of_256.obj", "line 257: a face with 256 corners"},
        BadFile{"nan_vertex.ply", "mesh: vertex 2 has a coordinate that is not finite"},
        BadFile{"index_too_large.ply", "face 0 names vertex 9, expected less than 4"},
        BadFile{"too_many_elements.ply", "line 3: \"4000000000\" elements, more than fit"},
        BadFile{"list_too_long.ply", "element \"face\" 1: a list of 4294967295 entries"},
        BadFile{"list_too_long_binary.ply", "element \"face\" 0: a list of 4294967295 entries"},
        BadFile{"list_negative_big_endian.ply", "element \"face\" 0: a list of -1 entries"},
        BadFile{"list_by_float.ply", "line 8: a list's length has the type \"float\""},
        BadFile{"too_many_vertices.off", "\"353535235358\" vertices, more than fit"},
        BadFile{"too_many_faces.off", "\"99999999999\" faces, more than fit"},
        BadFile{"no_header_end.ply", "the header has no line \"end_header\""},
        BadFile{"truncated.ply", "element \"vertex\" 0: the file ends here"},
        BadFile{"broken.osgt", ""}, BadFile{"unknown.format", ""},
        BadFile{"../bvh/two_joints.bvh", "BVH files have no mesh"}),
    nameOf);

TEST(MeshErrors, MissingFileNamesTheReason) {
    for (const char* name : {"mesh/none.obj", "mesh/none.ply", "mesh/none.osgt", "mesh/none.zzz"}) {
        const std::string path = testData(name);
        expectError([&] { osgSkin::importMesh(path); }, path + ": cannot open: No such file");
    }
}

/// A cube with normals along the faces' own or against them, as an OBJ file.
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

/// The least outward component of the normals at the cube's corners.
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

TEST(MeshWarnings, RecomputesInvertedNormals) {
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
    const auto& normals = normalsOf(mesh);
    EXPECT_EQ(normals.size(), 24u) << "the file's own, a face";
    EXPECT_EQ(notices.text(), "");
}

TEST(MeshWarnings, ReportsMissingTexturesInOneLine) {
    std::ofstream materials(testing::TempDir() + "textured.mtl");
    for (int m = 0; m < 6; ++m) materials << "newmtl m" << m << "\nmap_Kd nowhere" << m << ".png\n";
    materials.close();
    const test::Notices notices;
    osgSkin::importMesh(cube("textured.obj", 1.0, "textured.mtl"));
    EXPECT_EQ(notices.lines(), 1u) << notices.text();
    EXPECT_TRUE(notices.say("6 textures, \"nowhere0.png\" among them, cannot be read"))
        << notices.text();
}

TEST(MeshWarnings, ReportsMissingMaterialsInOneLine) {
    const test::Notices notices;
    osgSkin::importMesh(cube("unmade.obj", 1.0, "no_such.mtl"));
    EXPECT_EQ(notices.lines(), 1u) << notices.text();
}

TEST(MeshWarnings, MaterialNamesMayHaveBlanks) {
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
        const osgSkin::ImportedMesh mesh = osgSkin::importMesh(folder + "mesh.obj");
        EXPECT_EQ(notices.text(), "");
        ASSERT_EQ(mesh.parts.size(), 3u) << library;
        EXPECT_EQ(diffuseOf(mesh, 0), osg::Vec4(1, 0, 0, 1));
        EXPECT_EQ(diffuseOf(mesh, 1), osg::Vec4(0, 1, 0, 1));
        EXPECT_EQ(diffuseOf(mesh, 2), osg::Vec4(0, 0, 1, 1));
    }
}

/// Three bytes per vertex, and each is bound.
TEST(MeshWarnings, LimitsVerticesByFileSize) {
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

TEST(MeshWarnings, WarnsAboutFaceColours) {
    const test::Notices notices;
    EXPECT_EQ(readMesh("faces.ply", "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\n"
                                    "property float y\nproperty float z\nelement face 1\n"
                                    "property list uchar int vertex_indices\nproperty uchar red\n"
                                    "property uchar green\nproperty uchar blue\nend_header\n"
                                    "0 0 0\n1 0 0\n0 1 0\n3 0 1 2 255 0 0\n")
                  .mesh.faceSizes.size(),
              1u);
    EXPECT_TRUE(notices.say("faces.ply: colours of faces are left out")) << notices.text();
    EXPECT_EQ(readMesh("faces.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2 255 0 0\n")
                  .mesh.faceSizes.size(),
              1u);
    EXPECT_TRUE(notices.say("1 of 1 faces have colours, which are left out")) << notices.text();
}
