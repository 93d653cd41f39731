// SPDX-License-Identifier: GPL-3.0-or-later
#include "elastic/solid/CellEnergy.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/SVD>

#include <cmath>
#include <random>

namespace {

using namespace osgSkin::elastic;

constexpr double kEdge = 0.5;
const Flesh kNoBulk{0.0, 0.0, 0.0};

/// A batch of one cell, in all lanes, whose corners went through `map`.
template <typename Map>
CellBatch cellOf(const Map& map) {
    CellBatch batch;
    for (std::size_t c = 0; c < CellShape::kCorners; ++c) {
        const Point p = map(kEdge * Point(double(c & 1u), double(c >> 1 & 1u), double(c >> 2)));
        for (std::size_t i = 0; i < 3; ++i)
            for (double& corner : batch.corner[i][c]) corner = p[static_cast<Eigen::Index>(i)];
    }
    return batch;
}

double energyOf(const CellShape& shape, const Flesh& flesh, CellBatch batch) {
    EXPECT_TRUE(cellEnergies(shape, flesh, batch));
    for (const double energy : batch.energy) EXPECT_EQ(energy, batch.energy[0]);
    return batch.energy[0];
}

} // namespace

TEST(CellEnergy, IsNothingForACellThatOnlyMoves) {
    const CellShape shape(kEdge);
    const Eigen::Matrix3d turn =
        Eigen::AngleAxisd(2.0, Point(1, 2, -1).normalized()).toRotationMatrix();
    CellBatch batch = cellOf([&](const Point& p) { return Point(turn * p + Point(3, 1, 2)); });
    ASSERT_TRUE(cellEnergies(shape, Flesh(), batch));
    for (const double energy : batch.energy) EXPECT_NEAR(energy, 0.0, 1e-12);
    for (const auto& along : batch.gradient)
        for (const auto& corner : along)
            for (const double slope : corner) EXPECT_NEAR(slope, 0.0, 1e-10);
}

// tr S of F = R S by the quartic's root against the one by singular values.
TEST(CellEnergy, IsTheDistanceToTheNearestRotation) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> entry(-1.0, 1.0);
    const CellShape shape(kEdge);
    int tried = 0;
    while (tried < 200) {
        Eigen::Matrix3d f;
        for (Eigen::Index i = 0; i < 9; ++i) f(i) = entry(random);
        if (f.determinant() < 0.02) continue;
        ++tried;
        const Point s = Eigen::JacobiSVD<Eigen::Matrix3d>(f).singularValues();
        const double expected =
            kEdge * kEdge * kEdge * (s - Point::Ones()).squaredNorm(); // |F - R|^2
        const CellBatch batch = cellOf([&](const Point& p) { return Point(f * p); });
        EXPECT_NEAR(energyOf(shape, kNoBulk, batch), expected, 1e-9) << f;
    }
}

TEST(CellEnergy, GradientIsTheSlopeOfTheValue) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> shift(-0.12, 0.12);
    const CellShape shape(kEdge);
    Flesh flesh;
    flesh.barrierBegins = 1.1; // so that the barrier acts at every point
    CellBatch batch;
    // Each lane has a cell of its own.
    for (std::size_t lane = 0; lane < CellBatch::kCells; ++lane) {
        const CellBatch one = cellOf([&](const Point& p) {
            return Point(p + Point(shift(random), shift(random), shift(random)));
        });
        for (std::size_t i = 0; i < 3; ++i)
            for (std::size_t c = 0; c < CellShape::kCorners; ++c)
                batch.corner[i][c][lane] = one.corner[i][c][0];
    }
    ASSERT_TRUE(cellEnergies(shape, flesh, batch));
    constexpr double kStep = 1e-6;
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t c = 0; c < CellShape::kCorners; ++c) {
            CellBatch up = batch, down = batch;
            for (double& corner : up.corner[i][c]) corner += kStep;
            for (double& corner : down.corner[i][c]) corner -= kStep;
            ASSERT_TRUE(cellEnergies(shape, flesh, up));
            ASSERT_TRUE(cellEnergies(shape, flesh, down));
            for (std::size_t lane = 0; lane < CellBatch::kCells; ++lane) {
                const double slope = (up.energy[lane] - down.energy[lane]) / (2.0 * kStep);
                EXPECT_NEAR(batch.gradient[i][c][lane], slope, 1e-6 * (1.0 + std::abs(slope)));
            }
        }
}

TEST(CellEnergy, IsInfiniteForAnInvertedCell) {
    const CellShape shape(kEdge);
    CellBatch mirrored = cellOf([](const Point& p) { return Point(-p.x(), p.y(), p.z()); });
    EXPECT_FALSE(cellEnergies(shape, Flesh(), mirrored));
    CellBatch flat = cellOf([](const Point& p) { return Point(0.0, p.y(), p.z()); });
    EXPECT_FALSE(cellEnergies(shape, Flesh(), flat));
    // One lane is enough.
    CellBatch batch = cellOf([](const Point& p) { return p; });
    for (std::size_t c = 0; c < CellShape::kCorners; ++c) batch.corner[0][c][5] *= -1.0;
    EXPECT_FALSE(cellEnergies(shape, Flesh(), batch));
}

TEST(CellEnergy, BarrierGrowsWithoutEndTowardsFlatness) {
    const CellShape shape(kEdge);
    double before = 0.0;
    for (const double thickness : {0.4, 0.1, 0.01, 1e-4, 1e-8}) {
        Flesh flesh{0.0, 10.0, 0.5};
        const CellBatch batch =
            cellOf([&](const Point& p) { return Point(thickness * p.x(), p.y(), p.z()); });
        const double barrier = energyOf(shape, flesh, batch) - energyOf(shape, kNoBulk, batch);
        EXPECT_GT(barrier, before) << thickness;
        before = barrier;
    }
    const double volume = kEdge * kEdge * kEdge;
    EXPECT_NEAR(before, -10.0 * volume * 0.25 * std::log(2e-8), 1e-5); // -(J - J0)^2 ln(J / J0)
}
