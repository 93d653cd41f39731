// SPDX-License-Identifier: GPL-3.0-or-later
#include "correctives/ShapeFit.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

using namespace osgSkin;

namespace {

constexpr double kTolerance = 1e-4;

/// Ten vertices that bulge with the bend, not as a polynomial.
glm::dvec3 offsetAt(std::size_t vertex, const glm::dvec2& xy) {
    const double v = static_cast<double>(vertex);
    return {0.3 * xy.x * xy.x * std::sin(v), 0.2 * std::sin(2.0 * xy.x) * std::cos(v),
            0.1 * xy.y * (1.0 + xy.x)};
}

JointShapes shapesOfHinge() {
    JointShapes shapes;
    shapes.functions.joint = 1;
    shapes.functions.basis = CorrectiveJoint::Basis::Hinge;
    shapes.functions.axis = {1, 0, 0};
    shapes.functions.low = {-0.2, -0.3};
    shapes.functions.high = {0.9, 0.3};
    shapes.functions.knots = {-0.2, 0.0, 0.2, 0.45, 0.7, 0.9};
    for (std::uint32_t v = 0; v < 10; ++v) shapes.vertices.push_back(v);
    for (double x = -0.2; x <= 0.91; x += 0.05)
        for (const double y : {-0.2, 0.0, 0.2}) {
            shapes.samples.emplace_back(x, y);
            shapes.offsets.emplace_back();
            for (std::size_t v = 0; v < 10; ++v)
                shapes.offsets.back().push_back(offsetAt(v, {x, y}));
        }
    return shapes;
}

glm::dvec3 fittedAt(const FittedShapes& fit, std::size_t vertex, const glm::dvec2& xy) {
    double beta[CorrectiveJoint::kMaxModes];
    fit.functions.weights(xy, beta);
    glm::dvec3 sum(0.0);
    for (std::size_t k = 0; k < fit.functions.modes; ++k)
        sum += beta[k] * fit.vectors[vertex * fit.functions.modes + k];
    return sum;
}

} // namespace

TEST(ShapeFit, MatchesSamplesAndInterpolates) {
    const FittedShapes fit = fitShapes(shapesOfHinge(), {6, kTolerance});
    EXPECT_LE(fit.functions.modes, 6u);
    EXPECT_LE(fit.residual, 0.004);
    for (std::size_t v = 0; v < 10; ++v) {
        EXPECT_EQ(glm::length(fittedAt(fit, v, {0.0, 0.0})), 0.0); // at rest nothing moves
        for (const glm::dvec2& xy : {glm::dvec2(0.12, 0.1), {0.33, -0.1}, {0.58, 0.05}, {0.77, 0}})
            EXPECT_LE(glm::distance(fittedAt(fit, v, xy), offsetAt(v, xy)), 0.01) << v;
        for (std::size_t k = 0; k < fit.functions.modes; ++k)
            EXPECT_LE(glm::length(fit.vectors[v * fit.functions.modes + k]), 1.0 + 1e-12);
    }
}

TEST(ShapeFit, FitsHeavierSamplesBetter) {
    JointShapes shapes = shapesOfHinge();
    for (std::size_t s = 0; s < shapes.samples.size(); ++s) // a jump, which no smooth sum can fit
        for (glm::dvec3& offset : shapes.offsets[s])
            if (shapes.samples[s].x > 0.62) offset.z += 1.0;
    const auto worst = [](const FittedShapes& fit) {
        double most = 0.0;
        for (double x = 0.0; x < 0.6; x += 0.05)
            most = std::max(most, glm::distance(fittedAt(fit, 3, {x, 0.0}), offsetAt(3, {x, 0.0})));
        return most;
    };
    const double alike = worst(fitShapes(shapes, {6, kTolerance}));
    for (const glm::dvec2& sample : shapes.samples)
        shapes.weights.emplace_back(10, sample.x > 0.62 ? 1e-3 : 1.0);
    EXPECT_GT(alike, 0.1);
    EXPECT_LT(worst(fitShapes(shapes, {6, kTolerance})), 0.3 * alike);
}

TEST(ShapeFit, FewerModesFitWorse) {
    JointShapes shapes = shapesOfHinge();
    EXPECT_GT(fitShapes(shapes, {1, kTolerance}).residual,
              2.0 * fitShapes(shapes, {6, kTolerance}).residual);
    for (auto& sample : shapes.offsets)
        for (glm::dvec3& offset : sample) offset = glm::dvec3(0.0);
    EXPECT_EQ(fitShapes(shapes, {6, kTolerance}).functions.modes, 0u);
}

TEST(ShapeFit, PackingCopiesSeamsAndDropsSmallOffsets) {
    JointShapes shapes = shapesOfHinge();
    for (auto& sample : shapes.offsets) sample[4] = glm::dvec3(1e-6);
    const FittedShapes fit = fitShapes(shapes, {6, kTolerance});
    const std::vector<std::uint32_t> weldedOf = {0, 4, 7, 7, 12}; // 12 does not belong to the joint
    const Correctives packed = packShapes({fit}, weldedOf);
    const std::vector<std::uint32_t> firstEntry = {0, 1, 1, 2, 3, 3};
    EXPECT_EQ(packed.firstEntry, firstEntry);
    const std::size_t count = packed.sharesOf(0);
    for (std::size_t i = 0; i < count; ++i) {
        EXPECT_EQ(packed.shares[count + i], packed.shares[2 * count + i]); // copies of 7
        EXPECT_NEAR(packed.shares[count + i] / 32767.0,
                    fit.vectors[7 * packed.joints[0].modes + i / 3][static_cast<int>(i % 3)], 2e-5);
    }
}

TEST(ShapeFit, PackingDropsNegligibleModes) {
    const JointShapes shapes = shapesOfHinge();
    FittedShapes fit = fitShapes(shapes, {6, kTolerance});
    fit.tolerance = 0.1; // larger than the effect of bends to the side
    std::vector<std::uint32_t> weldedOf;
    for (std::uint32_t v = 0; v < shapes.vertices.size(); ++v) weldedOf.push_back(v);
    const Correctives packed = packShapes({fit}, weldedOf);
    const std::size_t modes = fit.functions.modes, last = 3 * (modes - 1);
    ASSERT_GE(modes, 3u);
    std::size_t leftOut = 0;
    for (std::uint32_t v = 0; v < weldedOf.size(); ++v) {
        const std::uint32_t entry = packed.firstEntry[v];
        ASSERT_EQ(packed.firstEntry[v + 1], entry + 1);
        const std::int16_t* shares = &packed.shares[packed.entries[entry].firstShare];
        if (std::all_of(shares + last, shares + last + 3, [](auto share) { return share == 0; }))
            ++leftOut;
        FittedShapes now = fit;
        for (std::size_t i = 0; i < 3 * modes; ++i)
            now.vectors[v * modes + i / 3][static_cast<int>(i % 3)] = shares[i] / 32767.0;
        for (const glm::dvec2& xy : shapes.samples)
            EXPECT_LE(glm::distance(fittedAt(now, v, xy), fittedAt(fit, v, xy)), 0.1001) << v;
    }
    EXPECT_EQ(leftOut, weldedOf.size());
}
