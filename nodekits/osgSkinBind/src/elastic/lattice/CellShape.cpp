// SPDX-License-Identifier: GPL-3.0-or-later
#include "elastic/lattice/CellShape.h"

namespace osgSkin::elastic {
namespace {

bool bit(std::size_t number, Eigen::Index axis) {
    return (number >> axis & 1u) != 0;
}

} // namespace

Point CellShape::local(std::size_t point) {
    Point result;
    for (Eigen::Index axis = 0; axis < 3; ++axis) result[axis] = bit(point, axis) ? kHigh : kLow;
    return result;
}

std::array<double, CellShape::kCorners> CellShape::values(const Point& local) {
    std::array<double, kCorners> result{};
    for (std::size_t c = 0; c < kCorners; ++c) {
        result[c] = 1.0;
        for (Eigen::Index axis = 0; axis < 3; ++axis)
            result[c] *= bit(c, axis) ? local[axis] : 1.0 - local[axis];
    }
    return result;
}

Eigen::Matrix<double, 3, 8> CellShape::slopes(const Point& local) {
    Eigen::Matrix<double, 3, 8> result;
    for (std::size_t c = 0; c < kCorners; ++c)
        for (Eigen::Index axis = 0; axis < 3; ++axis) {
            double slope = bit(c, axis) ? 1.0 : -1.0;
            for (Eigen::Index other = 0; other < 3; ++other)
                if (other != axis) slope *= bit(c, other) ? local[other] : 1.0 - local[other];
            result(axis, static_cast<Eigen::Index>(c)) = slope;
        }
    return result;
}

CellShape::CellShape(double length) : edge(length) {
    for (std::size_t g = 0; g < kPoints; ++g) {
        const auto shares = values(local(g));
        const Eigen::Matrix<double, 3, 8> slopesHere = slopes(local(g)) / edge;
        for (std::size_t c = 0; c < kCorners; ++c) {
            value[c][g] = shares[c];
            for (Eigen::Index axis = 0; axis < 3; ++axis)
                slope[axis][c][g] = slopesHere(axis, static_cast<Eigen::Index>(c));
        }
    }
}

Eigen::Matrix<double, 8, 8> CellShape::laplacian() const {
    Eigen::Matrix<double, 8, 8> result = Eigen::Matrix<double, 8, 8>::Zero();
    for (std::size_t a = 0; a < kCorners; ++a)
        for (std::size_t b = 0; b < kCorners; ++b)
            for (const auto& along : slope)
                for (std::size_t g = 0; g < kPoints; ++g)
                    result(static_cast<Eigen::Index>(a), static_cast<Eigen::Index>(b)) +=
                        volumeOfPoint() * along[a][g] * along[b][g];
    return result;
}

} // namespace osgSkin::elastic
