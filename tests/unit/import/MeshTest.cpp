// SPDX-License-Identifier: MIT
#include "Paths.h"

#include <osgSkinImport/ImportMesh>

#include <osg/Group>
#include <osg/Material>
#include <osg/MatrixTransform>
#include <osgDB/WriteFile>

#include <glm/geometric.hpp>

#include <ostream>
#include <set>

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

/// What every part must be, whatever it was read from.
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
    // The last face counts from the end of the list.
    EXPECT_EQ(imported.mesh.faceVertices, (Indices{3, 0, 1, 2, 1, 4, 5, 2, 4, 6, 5}));
    expectConsistent(imported);
}

TEST(ImportObj, MakesOnePartForEachMaterial) {
    const osgSkin::ImportedMesh imported = osgSkin::importMesh(testData("mesh/quads.obj"));
    ASSERT_EQ(imported.parts.size(), 2u);
    EXPECT_EQ(imported.parts[0].sourceFace, (Indices{0, 0, 2}));
    EXPECT_EQ(imported.parts[1].sourceFace, (Indices{1, 1}));
    const auto* red = dynamic_cast<const osg::Material*>(
        imported.parts[0].geometry->getStateSet()->getAttribute(osg::StateAttribute::MATERIAL));
    ASSERT_NE(red, nullptr);
    EXPECT_EQ(red->getDiffuse(osg::Material::FRONT), osg::Vec4(0.75f, 0.25f, 0.125f, 1.0f));
}

TEST(ImportObj, ReadsVertexColours) {
    const osgSkin::ImportedMesh imported = osgSkin::importMesh(testData("mesh/coloured.obj"));
    ASSERT_EQ(imported.parts.size(), 1u);
    const auto& colours =
        dynamic_cast<const osg::Vec4Array&>(*imported.parts[0].geometry->getColorArray());
    ASSERT_EQ(colours.size(), 3u);
    EXPECT_EQ(colours[1], osg::Vec4(0.0f, 0.5f, 0.25f, 1.0f));
    const auto* material = dynamic_cast<const osg::Material*>(
        imported.parts[0].geometry->getStateSet()->getAttribute(osg::StateAttribute::MATERIAL));
    ASSERT_NE(material, nullptr);
    EXPECT_EQ(material->getColorMode(), osg::Material::AMBIENT_AND_DIFFUSE);
    EXPECT_EQ(osgSkin::importMesh(testData("mesh/quads.obj")).parts[0].geometry->getColorArray(),
              nullptr);
}

TEST(ImportObj, CopiesAVertexOnlyWhereItsAttributesDiffer) {
    const osgSkin::ImportedMesh imported = osgSkin::importMesh(testData("mesh/quads.obj"));
    // Corner 2/2 of the first face and 2/5 of the second lie in different parts; within the first
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

TEST(ImportObj, ShadesSmoothlyAcrossVerticesOfOnePosition) {
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

TEST(ImportPly, ReadsBytesToo) {
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

TEST(ImportOsg, ReadsTrianglesWhereTheyStand) {
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
    // Mirrored, the square still shows its outside to +z.
    for (const osg::Vec3& n : normals(imported.parts[0]))
        EXPECT_LT((n - osg::Vec3(0, 0, 1)).length(), 1e-6f);
}

/// Turned, and flatter: normals stay upright on what they stood on.
TEST(ImportOsg, TurnsNormalsWithTheSurface) {
    const osg::ref_ptr<osg::Geometry> slope = new osg::Geometry;
    const osg::Vec3 corners[] = {{0, 0, 0}, {1, 0, 1}, {0, 1, 0}};
    osg::Vec3 smooth(-0.8f, 0.2f, 1.0f); // as of a round surface, not the triangle's own
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

TEST_P(SharedBody, IsReadWhole) {
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

} // namespace
