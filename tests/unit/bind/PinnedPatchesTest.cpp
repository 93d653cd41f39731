// SPDX-License-Identifier: GPL-3.0-or-later
//
// Which parts of a skin are drawn out, on a ring: closed, cut, and alone.
#include "mesh/HeatGraph.h"
#include "mesh/WeldedMesh.h"
#include "ratios/MinimizeStretch.h"

#include <glm/gtc/constants.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

using namespace osgSkin;

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

    /// How many vertices above the middle stay free, and below.
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

TEST(PinnedPatches, BetweenBothKindsStaysFree) {
    const Ring ring;
    const auto all =
        static_cast<std::size_t>(std::count(ring.isFree.begin(), ring.isFree.end(), true));
    const auto [above, below] = ring.freeAfter();
    EXPECT_GT(above, 10u);
    EXPECT_EQ(above, below);
    EXPECT_EQ(above + below, all);
}

TEST(PinnedPatches, WhatEndsIsKept) {
    Ring ring;
    const auto whole = ring.freeAfter();
    // One triangle less, at the top.
    const std::size_t cut = std::size_t(6) * kThrough * (kAround / 4);
    ring.mesh.faceVertices.erase(ring.mesh.faceVertices.begin() + std::ptrdiff_t(cut),
                                 ring.mesh.faceVertices.begin() + std::ptrdiff_t(cut + 3));
    ring.mesh.faceSizes.pop_back();
    EXPECT_EQ(ring.freeAfter(), std::make_pair(std::size_t(0), whole.second));
}

TEST(PinnedPatches, WhatNobodyHoldsAtBothEndsIsKept) {
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
