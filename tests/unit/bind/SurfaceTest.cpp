// SPDX-License-Identifier: GPL-3.0-or-later
// Meshes that are no surface: equations on their vertices took minutes, and gigabytes.
#include "Shapes.h"

#include "mesh/WeldedMesh.h"

#include <osgSkin/Error>
#include <osgSkinBind/Bind>
#include <osgSkinBind/FitSkeleton>

#include <gtest/gtest.h>

#include <ctime>
#include <random>

using namespace osgSkin;

namespace {

/// Triangles between vertices at random, around the cylinder of shapes::cylinder().
SkinMesh trianglesAtRandom(std::uint32_t vertices, std::size_t triangles) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> place(-1.0, 1.0);
    std::uniform_int_distribution<std::uint32_t> vertex(0, vertices - 1);
    SkinMesh mesh;
    for (std::uint32_t v = 0; v < vertices; ++v)
        mesh.positions.emplace_back(place(random), 4.0 + 4.0 * place(random), place(random));
    for (std::size_t t = 0; t < triangles; ++t) {
        const std::uint32_t a = vertex(random), b = vertex(random), c = vertex(random);
        if (a == b || b == c || c == a) continue;
        mesh.faceSizes.push_back(3);
        mesh.faceVertices.insert(mesh.faceVertices.end(), {a, b, c});
    }
    return mesh;
}

void expectRefused(const SkinMesh& mesh, const char* part) {
    const std::clock_t begin = std::clock();
    const RestSkeleton skeleton = shapes::chainAlongY({1.1, 4.1}, 7.0);
    const auto complaint = [&](const auto& step) -> std::string {
        try {
            step();
            return "none";
        } catch (const Error& error) {
            return error.what();
        }
    };
    EXPECT_NE(complaint([&] { bind(mesh, skeleton); }).find(part), std::string::npos);
    BindOptions paper;
    paper.method = BindOptions::Method::Paper;
    EXPECT_NE(complaint([&] { bind(mesh, skeleton, paper); }).find(part), std::string::npos);
    EXPECT_NE(complaint([&] { fitSkeleton(mesh); }).find(part), std::string::npos);
    EXPECT_LT(double(std::clock() - begin) / CLOCKS_PER_SEC, 6.0); // with sanitizers, too
}

} // namespace

TEST(Surface, TrianglesAtRandomAreNone) {
    expectRefused(trianglesAtRandom(1500, 4500),
                  "triangles of 1500 vertices join vertices all over the mesh, expected a surface");
    expectRefused(trianglesAtRandom(160, 8000), "expected at most 12 for each vertex");
}

TEST(Surface, ManySmallOnesOfNoKindAreNone) {
    SkinMesh all = trianglesAtRandom(100, 300);
    for (int i = 0; i < 40; ++i)
        all = shapes::joined(all, shapes::moved(trianglesAtRandom(100, 300), {0.0, 1e-3 * i, 0.0}));
    expectRefused(all, "expected a surface");
}

TEST(Surface, FacesOfAllCellsOfASolidAreNone) {
    constexpr std::uint32_t kSide = 24;
    const auto corner = [](std::uint32_t x, std::uint32_t y, std::uint32_t z) {
        return x + kSide * (y + kSide * z);
    };
    SkinMesh mesh;
    for (std::uint32_t i = 0; i < kSide * kSide * kSide; ++i)
        mesh.positions.emplace_back(i % kSide, i / kSide % kSide, i / kSide / kSide);
    for (std::uint32_t z = 0; z + 1 < kSide; ++z)
        for (std::uint32_t y = 0; y + 1 < kSide; ++y)
            for (std::uint32_t x = 0; x + 1 < kSide; ++x) {
                const std::uint32_t a = corner(x, y, z), b = corner(x + 1, y, z);
                mesh.faceSizes.insert(mesh.faceSizes.end(), {4, 4});
                mesh.faceVertices.insert(mesh.faceVertices.end(),
                                         {a, b, corner(x + 1, y + 1, z), corner(x, y + 1, z), a, b,
                                          corner(x + 1, y, z + 1), corner(x, y, z + 1)});
            }
    expectRefused(mesh, "expected a surface");
}

/// What has least to do with a body, and is fine.
TEST(Surface, BallsAndRingsAndSieves) {
    const auto isSurface = [](const shapes::Filled& filled, int range) {
        const WeldedMesh mesh(shapes::voxelSurface(filled, range, 0.25));
        EXPECT_GT(mesh.vertexCount(), 1000u);
        EXPECT_NO_THROW(requireSurface(mesh)) << mesh.vertexCount();
    };
    const auto ball = [](int radius) {
        return [radius](int x, int y, int z) { return x * x + y * y + z * z < radius * radius; };
    };
    isSurface(ball(10), 12);
    isSurface(ball(40), 44);
    isSurface(
        [](int x, int y, int z) {
            const int aside = x * x + y * y;
            return aside > 20 * 20 && aside < 30 * 30 && z * z < 25;
        },
        32);
    isSurface( // a plate with 64 holes
        [](int x, int y, int z) { return (x % 5 != 0 || y % 5 != 0) && z >= -2 && z < 2; }, 20);
}
