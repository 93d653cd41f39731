// SPDX-License-Identifier: GPL-3.0-or-later
#include "Shapes.h"
#include "mesh/WeldedMesh.h"
#include "ratios/RatioFields.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

using namespace osgSkin;

namespace {

/// A square of triangles, two units wide, with a field that rises across it from the left.
struct Sheet {
    SkinMesh mesh = shapes::sheet(21);
    std::vector<double> field;

    template <typename Rise>
    explicit Sheet(const Rise& rise) {
        for (const glm::dvec3& p : mesh.positions) field.push_back(rise(p));
    }

    double shareAt(double x, double y) const {
        const auto v = static_cast<std::size_t>(std::lround(10.0 * (y + 1.0)) * 21 +
                                                std::lround(10.0 * (x + 1.0)));
        return gradientFactor(WeldedMesh(mesh), field)[v];
    }
};

} // namespace

TEST(GradientFactor, IsOneOnAnEvenSlope) {
    const Sheet even([](const glm::dvec3& p) { return 0.5 + 0.4 * p.x; });
    EXPECT_NEAR(even.shareAt(0.0, 0.0), 1.0, 1e-9);
    const Sheet flat([](const glm::dvec3&) { return 1.0; });
    EXPECT_EQ(flat.shareAt(0.0, 0.0), 1.0);
}

TEST(GradientFactor, ComparesLocalAndMeanSlope) {
    // Rises within two units at the lower edge, within one at the upper: on average one and a half
    // times as steep as at the lower edge. So the upper edge is a third steeper than the mean, and
    // at the lower one the share is not below 1.
    const Sheet fan([](const glm::dvec3& p) {
        const double width = 1.5 - 0.5 * p.y;
        return std::clamp(0.5 + p.x / width, 0.0, 1.0);
    });
    EXPECT_GT(fan.shareAt(0.0, 0.8), 1.2);
    EXPECT_LT(fan.shareAt(0.0, 0.8), 1.5);
    EXPECT_EQ(fan.shareAt(0.0, -0.8), 1.0);
    EXPECT_EQ(fan.shareAt(-0.9, 0.9), 1.0); // flat there
}
