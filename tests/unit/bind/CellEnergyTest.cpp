// SPDX-License-Identifier: GPL-3.0-or-later
#include <elastic/energy/CellEnergy.h>

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/SVD>

#include <cmath>
#include <random>

namespace {

using namespace osgSkin::elastic;

constexpr double kEdge = 0.5;
const Flesh kNoBulk{0.0, 0.0, 0.0};

/// A cell whose corners went through `map`.
template <typename Map>
CellState cellOf(const CellShape& shape, const Map& map) {
    CellState cell;
    cell.volume = shape.volumeOfPoint();
    for (std::size_t c = 0; c < 8; ++c) {
        const Point p = map(kEdge * Point(double(c & 1u), double(c >> 1 & 1u), double(c >> 2)));
        for (std::size_t i = 0; i < 3; ++i) cell.corner[i][c] = p[static_cast<Eigen::Index>(i)];
    }
    return cell;
}

double energyOf(const CellShape& shape, const Flesh& flesh, CellState cell) {
    double least = 0.0;
    return cellEnergy(shape, flesh, cell, least);
}

} // namespace

TEST(CellEnergy, IsNothingForACellThatOnlyMoves) {
    const CellShape shape(kEdge);
    const Eigen::Matrix3d turn =
        Eigen::AngleAxisd(2.0, Point(1, 2, -1).normalized()).toRotationMatrix();
    CellState cell =
        cellOf(shape, [&](const Point& p) { return Point(turn * p + Point(3, 1, 2)); });
    double least = 0.0;
    EXPECT_NEAR(cellEnergy(shape, Flesh(), cell, least), 0.0, 1e-12);
    EXPECT_NEAR(least, 1.0, 1e-12);
    for (const auto& along : cell.gradient)
        for (const double slope : along) EXPECT_NEAR(slope, 0.0, 1e-10);
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
        const CellState cell = cellOf(shape, [&](const Point& p) { return Point(f * p); });
        EXPECT_NEAR(energyOf(shape, kNoBulk, cell), expected, 1e-9) << f;
    }
}

TEST(CellEnergy, GradientIsTheSlopeOfTheValue) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> shift(-0.12, 0.12);
    const CellShape shape(kEdge);
    Flesh flesh;
    flesh.barrierBegins = 1.1; // so that the barrier acts at every point
    CellState cell = cellOf(shape, [&](const Point& p) {
        return Point(p + Point(shift(random), shift(random), shift(random)));
    });
    double least = 0.0;
    ASSERT_TRUE(std::isfinite(cellEnergy(shape, flesh, cell, least)));
    constexpr double kStep = 1e-6;
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t c = 0; c < 8; ++c) {
            CellState up = cell, down = cell;
            up.corner[i][c] += kStep;
            down.corner[i][c] -= kStep;
            const double slope =
                (energyOf(shape, flesh, up) - energyOf(shape, flesh, down)) / (2.0 * kStep);
            EXPECT_NEAR(cell.gradient[i][c], slope, 1e-6 * (1.0 + std::abs(slope)));
        }
}

TEST(CellEnergy, IsInfiniteForAnInvertedCell) {
    const CellShape shape(kEdge);
    const CellState mirrored =
        cellOf(shape, [](const Point& p) { return Point(-p.x(), p.y(), p.z()); });
    EXPECT_TRUE(std::isinf(energyOf(shape, Flesh(), mirrored)));
    const CellState flat = cellOf(shape, [](const Point& p) { return Point(0.0, p.y(), p.z()); });
    EXPECT_TRUE(std::isinf(energyOf(shape, Flesh(), flat)));
}

TEST(CellEnergy, BarrierGrowsWithoutEndTowardsFlatness) {
    const CellShape shape(kEdge);
    double before = 0.0;
    for (const double thickness : {0.4, 0.1, 0.01, 1e-4, 1e-8}) {
        Flesh flesh{0.0, 10.0, 0.5};
        const CellState cell =
            cellOf(shape, [&](const Point& p) { return Point(thickness * p.x(), p.y(), p.z()); });
        const double barrier = energyOf(shape, flesh, cell) - energyOf(shape, kNoBulk, cell);
        EXPECT_GT(barrier, before) << thickness;
        before = barrier;
    }
    const double volume = kEdge * kEdge * kEdge;
    EXPECT_NEAR(before, -10.0 * volume * 0.25 * std::log(2e-8), 1e-5); // -(J - J0)^2 ln(J / J0)
}
