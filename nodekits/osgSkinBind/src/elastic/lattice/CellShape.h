// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_ELASTIC_CELLSHAPE_H
#define OSGSKINBIND_ELASTIC_CELLSHAPE_H

#include "elastic/skin/Points.h"

#include <array>
#include <cstddef>

namespace osgSkin::elastic {

/// A cubic cell's trilinear shape functions at its 2 x 2 x 2 Gauss points. Corners and points are
/// numbered by bits: x the lowest, z the highest.
struct CellShape {
    static constexpr std::size_t kCorners = 8, kPoints = 8;

    /// Of the two Gauss points along an edge of length 1.
    static constexpr double kLow = 0.21132486540518708, kHigh = 0.7886751345948129;

    double edge = 0.0;
    double value[kCorners][kPoints];    ///< N_c at each point
    double slope[3][kCorners][kPoints]; ///< dN_c / dX at each point

    explicit CellShape(double edge);

    /// Integral of dN_a . dN_b over the cell.
    Eigen::Matrix<double, 8, 8> laplacian() const;

    double volumeOfPoint() const { return edge * edge * edge / kPoints; }

    /// In edges, 0..1, from the lowest corner.
    static Point local(std::size_t point);

    /// N_c at a local point.
    static std::array<double, kCorners> values(const Point& local);

    /// dN_c / dlocal, a column for each corner.
    static Eigen::Matrix<double, 3, 8> slopes(const Point& local);
};

} // namespace osgSkin::elastic

#endif
