// SPDX-License-Identifier: MIT
// Polygons with concave corners, and with any number of corners.
#include <osgSkinImport/ImportMesh>
#include <osgSkinRig/SkinMesh>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <gtest/gtest.h>
#include <osg/Array>
#include <osg/Geometry>

#include <ctime>
#include <fstream>
#include <numeric>
#include <random>

namespace {

using osgSkin::SkinMesh;

SkinMesh polygon(const std::vector<glm::dvec3>& corners) {
    SkinMesh mesh;
    mesh.positions = corners;
    mesh.faceSizes = {static_cast<std::uint32_t>(corners.size())};
    mesh.faceVertices.resize(corners.size());
    std::iota(mesh.faceVertices.begin(), mesh.faceVertices.end(), 0u);
    return mesh;
}

/// The sum of all areas, and that of triangles that face away from the polygon's side.
struct Areas {
    double all = 0.0, back = 0.0;
};

Areas areasOf(const SkinMesh& mesh) {
    const std::vector<std::uint32_t> triangles = mesh.triangles();
    std::vector<glm::dvec3> normals;
    glm::dvec3 sum(0.0);
    for (std::size_t i = 0; i < triangles.size(); i += 3) {
        const glm::dvec3 &a = mesh.positions[triangles[i]], &b = mesh.positions[triangles[i + 1]],
                         &c = mesh.positions[triangles[i + 2]];
        normals.push_back(0.5 * glm::cross(b - a, c - a));
        sum += normals.back();
    }
    Areas areas;
    for (const glm::dvec3& normal : normals) {
        areas.all += glm::length(normal);
        if (glm::dot(normal, sum) < 0.0) areas.back += glm::length(normal);
    }
    return areas;
}

/// A comb with this many teeth, one wide and two high with gaps of one, on a bar of height one.
std::vector<glm::dvec3> comb(int teeth) {
    std::vector<glm::dvec3> corners{{0, 0, 0}, {2 * teeth - 1, 0, 0}};
    for (int t = teeth - 1; t >= 0; --t) {
        const double right = 2 * t + 1, left = 2 * t;
        if (t < teeth - 1) corners.push_back({right, 1, 0});
        corners.push_back({right, 3, 0});
        corners.push_back({left, 3, 0});
        if (t > 0) corners.push_back({left, 1, 0});
    }
    return corners;
}

} // namespace

TEST(Polygons, TriangulatesConcavePolygons) {
    const std::vector<std::pair<std::vector<glm::dvec3>, double>> outlines{
        {{{0, 0, 0}, {4, 0, 0}, {1, 1, 0}, {0, 4, 0}}, 4.0},
        {{{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1, 1, 0}, {1, 2, 0}, {0, 2, 0}}, 3.0},
        {comb(2), 7.0},
        {comb(40), 159.0}};
    for (const auto& [outline, area] : outlines)
        for (std::size_t first = 0; first < outline.size(); ++first)
            for (const bool turned : {false, true}) {
                std::vector<glm::dvec3> corners(outline.begin() + std::ptrdiff_t(first),
                                                outline.end());
                corners.insert(corners.end(), outline.begin(),
                               outline.begin() + std::ptrdiff_t(first));
                if (turned) // in another plane, far from the origin
                    for (glm::dvec3& c : corners) c = glm::dvec3(1e3 - c.y, 1e3, c.x);
                const SkinMesh mesh = polygon(corners);
                EXPECT_EQ(mesh.triangles().size(), 3 * (outline.size() - 2));
                const Areas areas = areasOf(mesh);
                EXPECT_NEAR(areas.all, area, 1e-6) << outline.size() << " from " << first;
                EXPECT_LT(areas.back, 1e-6) << outline.size() << " from " << first;
            }
}

TEST(Polygons, TriangulatesConvexPolygonsAsFans) {
    const SkinMesh mesh = polygon({{0, 0, 0}, {2, 0, 0}, {2, 1, 0.1}, {1, 2, 0}, {0, 1, 0}});
    EXPECT_EQ(mesh.triangles(), (std::vector<std::uint32_t>{0, 1, 2, 0, 2, 3, 0, 3, 4}));
}

/// A bent polygon has no plane in which everyone would find the same concave corners.
TEST(Polygons, TriangulationIsIndependentOfOrientation) {
    std::mt19937 random(12);
    std::uniform_real_distribution<double> number(-1.0, 1.0);
    int cut = 0;
    for (int i = 0; i < 200; ++i) {
        std::vector<glm::dvec3> corners, turned;
        for (int k = 0; k < 4 + i % 4; ++k)
            corners.emplace_back(number(random), number(random), 0.7 * number(random));
        const glm::dquat turn = glm::normalize(
            glm::dquat(number(random), number(random), number(random), number(random)));
        for (const glm::dvec3& corner : corners) turned.push_back(turn * corner);
        const std::vector<std::uint32_t> as = polygon(corners).triangles();
        EXPECT_EQ(as, polygon(turned).triangles()) << i;
        cut += as[3] != 0; // not a fan
    }
    EXPECT_GT(cut, 40);
}

TEST(Polygons, TriangulatesDegeneratePolygons) {
    for (const std::vector<glm::dvec3>& corners :
         {std::vector<glm::dvec3>(5, {1, 1, 1}),
          std::vector<glm::dvec3>{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {1, 0, 0}},
          std::vector<glm::dvec3>{{0, 0, 0}, {1, 1, 0}, {1, 0, 0}, {0, 1, 0}},
          std::vector<glm::dvec3>{
              {-1e18, 0, 0}, {1e18, 0, 0}, {0, 1e-300, 0}, {0, 1e18, 0}, {1, 1, 1}}})
        EXPECT_EQ(polygon(corners).triangles().size(), 3 * (corners.size() - 2));
}

/// A zigzag that winds back, whose ears are blocked by the corners between.
TEST(Polygons, TriangulatesLargePolygonsFast) {
    const std::clock_t begin = std::clock();
    std::vector<glm::dvec3> corners;
    const int turns = 20'000;
    corners.reserve(2 * std::size_t(turns));
    for (int k = 0; k < turns; ++k) corners.push_back({k, k % 2 == 0 ? 0.0 : 1000.0, 0});
    for (int k = turns; k-- > 0;) corners.push_back({k, k % 2 == 0 ? 0.5 : 1000.5, 0});
    EXPECT_EQ(polygon(corners).triangles().size(), 3 * (corners.size() - 2));
    EXPECT_LT(double(std::clock() - begin) / CLOCKS_PER_SEC, 8.0);
}

TEST(Polygons, AreDrawnAsBound) {
    const std::string path = testing::TempDir() + "concave.obj";
    std::ofstream(path) << "v 0 0 0\nv 4 0 0\nv 1 1 0\nv 0 4 0\nvt 0 0\nvt 1 0\nvt 2 0\nvt 3 0\n"
                           "f 2/2 3/3 4/4 1/1\n";
    const osgSkin::ImportedMesh mesh = osgSkin::importMesh(path);
    ASSERT_EQ(mesh.parts.size(), 1u);
    const osg::Geometry& geometry = *mesh.parts[0].geometry;
    const auto& texCoords = dynamic_cast<const osg::Vec2Array&>(*geometry.getTexCoordArray(0));
    const osg::PrimitiveSet& drawn = *geometry.getPrimitiveSet(0);
    const std::vector<std::uint32_t> bound = mesh.mesh.triangles();
    ASSERT_EQ(drawn.getNumIndices(), bound.size());
    for (unsigned int k = 0; k < drawn.getNumIndices(); ++k) {
        EXPECT_EQ(mesh.parts[0].sourceVertex[drawn.index(k)], bound[k]);
        EXPECT_EQ(texCoords[drawn.index(k)].x(), float(bound[k]));
    }
    EXPECT_NEAR(areasOf(mesh.mesh).all, 4.0, 1e-9);
}
