// SPDX-License-Identifier: GPL-3.0-or-later
//
// Fields for a joint's typical rotations: on a sheet, and on a ring that is closed, cut, or alone.
#include "ratios/MinimizeStretch.h"
#include "Shapes.h"
#include "mesh/HeatGraph.h"
#include "mesh/SkinSmoother.h"
#include "mesh/WeldedMesh.h"

#include <glm/gtc/constants.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

using namespace osgSkin;

namespace {

/// A field that rises from left to right between -0.7 and 0.7, steepest in the middle.
struct Rise {
    WeldedMesh mesh;
    std::vector<double> field;
    std::vector<bool> isFree;

    explicit Rise(std::uint32_t side = 21) : mesh(shapes::sheet(side)) {
        for (const glm::dvec3& p : mesh.positions) {
            const double t = std::clamp(0.5 + p.x / 1.4, 0.0, 1.0);
            field.push_back(t * t * t * (10.0 + t * (6.0 * t - 15.0)));
            isFree.push_back(t > 0.0 && t < 1.0);
        }
    }

    /// Largest increase along x between neighbours near a height.
    double steepestAt(double y) const {
        const auto side = static_cast<std::size_t>(std::lround(std::sqrt(mesh.positions.size())));
        const double step = 2.0 / static_cast<double>(side - 1);
        const auto row = static_cast<std::size_t>(std::lround((y + 1.0) / step)) * side;
        double most = 0.0;
        for (std::size_t x = 1; x < side; ++x)
            most = std::max(most, (field[row + x] - field[row + x - 1]) / step);
        return most;
    }
};

/// About the sheet's centre: the lower half is stretched, the upper half compressed.
const std::vector<glm::dvec3> kTurn = {{0.0, 0.0, 1.5}};

} // namespace

TEST(MinimizeStretch, WidensTheBlendWhereSkinStretches) {
    Rise rise;
    const double before = rise.steepestAt(-0.8);
    minimizeStretch(HeatGraph(rise.mesh), rise.field, rise.isFree, glm::dvec3(0.0), kTurn);
    EXPECT_LT(rise.steepestAt(-0.8), 0.7 * before);
    EXPECT_GT(rise.steepestAt(0.0), 1.2 * rise.steepestAt(-0.8));
    for (const double a : rise.field) {
        EXPECT_GE(a, 0.0);
        EXPECT_LE(a, 1.0);
    }
}

TEST(MinimizeStretch, KeepsFixedVertices) {
    Rise rise;
    const std::vector<double> before = rise.field;
    for (std::size_t v = 0; v < before.size(); v += 3) rise.isFree[v] = false;
    minimizeStretch(HeatGraph(rise.mesh), rise.field, rise.isFree, glm::dvec3(0.0), kTurn);
    EXPECT_NE(rise.field, before);
    for (std::size_t v = 0; v < before.size(); ++v)
        if (!rise.isFree[v]) {
            EXPECT_EQ(rise.field[v], before[v]) << v;
        }
    rise.field = before;
    rise.isFree.assign(before.size(), false);
    minimizeStretch(HeatGraph(rise.mesh), rise.field, rise.isFree, glm::dvec3(0.0), kTurn);
    EXPECT_EQ(rise.field, before);
}

TEST(MinimizeStretch, IsSimilarOnACoarserCopy) {
    Rise fine(121);
    const std::vector<double> before = fine.field;
    Rise whole = fine;
    minimizeStretch(HeatGraph(whole.mesh), whole.field, whole.isFree, glm::dvec3(0.0), kTurn);
    const SkinSmoother smoother(fine.mesh, 0.7);
    std::size_t vertices = 0;
    smoother.change(fine.field, fine.isFree, 0.7,
                    [&vertices](const HeatGraph& skin, std::vector<double>& field,
                                const std::vector<bool>& isFree) {
                        vertices = field.size();
                        minimizeStretch(skin, field, isFree, glm::dvec3(0.0), kTurn);
                    });
    EXPECT_LT(vertices, fine.field.size() / 3);
    double most = 0.0, moved = 0.0;
    for (std::size_t v = 0; v < before.size(); ++v) {
        most = std::max(most, std::abs(fine.field[v] - whole.field[v]));
        moved = std::max(moved, std::abs(whole.field[v] - before[v]));
        if (!fine.isFree[v]) {
            EXPECT_EQ(fine.field[v], before[v]) << v;
        }
    }
    EXPECT_GT(moved, 0.1);
    EXPECT_LT(most, 0.5 * moved);
}

namespace {

constexpr std::uint32_t kAround = 24, kThrough = 8;

/// A closed ring whose field rises from 0 on its left to 1 on its right, above and below.
struct Ring {
    SkinMesh mesh;
    std::vector<double> field;
    std::vector<bool> isFree;

    Ring() {
        for (std::uint32_t i = 0; i < kAround; ++i)
            for (std::uint32_t k = 0; k < kThrough; ++k) {
                const double a = glm::two_pi<double>() * i / kAround;
                const double b = glm::two_pi<double>() * k / kThrough;
                const double far = 3.0 + std::cos(b);
                mesh.positions.emplace_back(far * std::cos(a), far * std::sin(a), std::sin(b));
                field.push_back(std::clamp(0.5 + 0.8 * std::cos(a), 0.0, 1.0));
                isFree.push_back(field.back() > 0.0 && field.back() < 1.0);
                const auto at = [](std::uint32_t u, std::uint32_t w) {
                    return u % kAround * kThrough + w % kThrough;
                };
                for (const std::uint32_t corner : {at(i, k), at(i + 1, k), at(i + 1, k + 1),
                                                   at(i, k), at(i + 1, k + 1), at(i, k + 1)})
                    mesh.faceVertices.push_back(corner);
            }
        mesh.faceSizes.assign(mesh.faceVertices.size() / 3, 3);
    }

    /// The numbers of vertices above and below the middle that stay free.
    std::pair<std::size_t, std::size_t> freeAfter() const {
        std::vector<bool> free = isFree;
        pinUnanchoredPatches(HeatGraph(WeldedMesh(mesh)), field, free);
        std::size_t above = 0, below = 0;
        for (std::size_t v = 0; v < free.size(); ++v)
            if (free[v]) ++(mesh.positions[v].y > 0.0 ? above : below);
        return {above, below};
    }
};

} // namespace

TEST(PinnedPatches, PatchBetweenBothEndsStaysFree) {
    const Ring ring;
    const auto all =
        static_cast<std::size_t>(std::count(ring.isFree.begin(), ring.isFree.end(), true));
    const auto [above, below] = ring.freeAfter();
    EXPECT_GT(above, 10u);
    EXPECT_EQ(above, below);
    EXPECT_EQ(above + below, all);
}

TEST(PinnedPatches, DeadEndIsPinned) {
    Ring ring;
    const auto whole = ring.freeAfter();
    // One triangle fewer, at the top.
    const std::size_t cut = std::size_t(6) * kThrough * (kAround / 4);
    ring.mesh.faceVertices.erase(ring.mesh.faceVertices.begin() + std::ptrdiff_t(cut),
                                 ring.mesh.faceVertices.begin() + std::ptrdiff_t(cut + 3));
    ring.mesh.faceSizes.pop_back();
    EXPECT_EQ(ring.freeAfter(), std::make_pair(std::size_t(0), whole.second));
}

TEST(PinnedPatches, PatchWithoutTwoEndsIsPinned) {
    const std::pair<std::size_t, std::size_t> none;
    Ring ring;
    ring.isFree.assign(ring.isFree.size(), true);
    EXPECT_EQ(ring.freeAfter(), none);
    for (const double end : {0.0, 1.0}) {
        Ring one;
        for (std::size_t v = 0; v < one.field.size(); ++v) one.isFree[v] = one.field[v] != end;
        EXPECT_EQ(one.freeAfter(), none) << end;
    }
}
