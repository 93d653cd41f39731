// SPDX-License-Identifier: GPL-3.0-or-later
#include "fit/body/SolidGrid.h"
#include "Shapes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <vector>

using namespace osgSkin;

namespace {

/// Half a box's side and the thickness of its walls, in cubes.
constexpr int kHalf = 12, kWall = 2;

/// The number of cubes of a hollow box with a square hole in its top, after filling pockets.
std::size_t filled(int hole) {
    const SkinMesh box = shapes::voxelSurface(
        [hole](int x, int y, int z) {
            const int most =
                std::max({std::abs(2 * x + 1), std::abs(2 * y + 1), std::abs(2 * z + 1)});
            const bool isWall = most < 2 * kHalf && most > 2 * (kHalf - kWall);
            const int low = -(hole / 2);
            const bool isHole =
                y >= kHalf - kWall && x >= low && x < low + hole && z >= low && z < low + hole;
            return isWall && !isHole;
        },
        kHalf + 1, 1.0);
    fit::ClosedShell shell;
    const std::vector<std::uint32_t> triangles = box.triangles();
    for (std::size_t t = 0; t < triangles.size(); t += 3)
        shell.push_back({box.positions[triangles[t]], box.positions[triangles[t + 1]],
                         box.positions[triangles[t + 2]]});
    fit::SolidGrid grid(glm::dvec3(-kHalf), glm::dvec3(kHalf), 2 * kHalf);
    grid.add(shell);
    grid.fillPockets();
    return grid.count();
}

} // namespace

TEST(SolidGrid, FillsCavitiesWithSmallHoles) {
    constexpr auto cube = [](std::size_t half) { return 8 * half * half * half; };
    constexpr std::size_t kBox = cube(kHalf), kCavity = cube(kHalf - kWall);
    for (const int hole : {0, 1, 2, 4, 6}) { // except corners, which are far from everything
        EXPECT_GE(filled(hole), kBox - kCavity / 5) << hole;
        EXPECT_LE(filled(hole), kBox) << hole;
    }
    for (const int hole : {7, 10}) EXPECT_LE(filled(hole), kBox - kCavity) << hole;
}
