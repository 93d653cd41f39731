// SPDX-License-Identifier: GPL-3.0-or-later
#include "elastic/lattice/DeformedCells.h"

#include <Eigen/LU>

namespace osgSkin::elastic {
namespace {

constexpr double kBinEdges = 1.5; ///< a bin's size in cells' edges
constexpr int kNewtonSteps = 6;
constexpr double kWithin = 1e-6;

} // namespace

DeformedCells::DeformedCells(const VoxelLattice& lattice, const Points& nodes)
    : _lattice(lattice), _nodes(nodes), _binSize(kBinEdges * lattice.shape().edge) {
    for (const VoxelLattice::Cell& cell : lattice.cells()) {
        Eigen::AlignedBox3d& box = _boxes.emplace_back();
        for (const std::uint32_t node : cell.nodes) box.extend(nodes.col(node));
        _bounds.extend(box);
    }
    _bins = (_bounds.sizes() / _binSize).array().floor().cast<int>() + 1;
    _first.assign(index(_bins - Eigen::Vector3i::Ones()) + 2, 0);
    const auto forEachBin = [this](const Eigen::AlignedBox3d& box, const auto& visit) {
        const Eigen::Vector3i low = binAt(box.min()), high = binAt(box.max());
        for (int z = low.z(); z <= high.z(); ++z)
            for (int y = low.y(); y <= high.y(); ++y)
                for (int x = low.x(); x <= high.x(); ++x) visit(index({x, y, z}));
    };
    for (const Eigen::AlignedBox3d& box : _boxes)
        forEachBin(box, [this](std::size_t bin) { ++_first[bin + 1]; });
    for (std::size_t bin = 1; bin < _first.size(); ++bin) _first[bin] += _first[bin - 1];
    _cells.resize(_first.back());
    std::vector<std::uint32_t> next(_first.begin(), _first.end() - 1);
    for (std::uint32_t cell = 0; cell < _boxes.size(); ++cell)
        forEachBin(_boxes[cell], [&](std::size_t bin) { _cells[next[bin]++] = cell; });
}

Eigen::Vector3i DeformedCells::binAt(const Point& point) const {
    const Eigen::Vector3i bin = ((point - _bounds.min()) / _binSize).array().floor().cast<int>();
    return bin.cwiseMax(0).cwiseMin(_bins - Eigen::Vector3i::Ones());
}

std::size_t DeformedCells::index(const Eigen::Vector3i& bin) const {
    const auto at = bin.cast<std::size_t>(), bins = _bins.cast<std::size_t>();
    return (at.z() * bins.y() + at.y()) * bins.x() + at.x();
}

/// Newton's method on the trilinear map.
bool DeformedCells::locate(std::uint32_t index, const Point& point, Point& local) const {
    Eigen::Matrix<double, 3, 8> corners;
    for (std::size_t c = 0; c < 8; ++c)
        corners.col(static_cast<Eigen::Index>(c)) = _nodes.col(_lattice.cells()[index].nodes[c]);
    local.setConstant(0.5);
    for (int step = 0; step < kNewtonSteps; ++step) {
        const auto values = CellShape::values(local);
        const Point off = corners * Eigen::Map<const Eigen::Matrix<double, 8, 1>>(values.data());
        const Eigen::Matrix3d slope = corners * CellShape::slopes(local).transpose();
        const Point change = slope.inverse() * (point - off);
        local += change;
        if (!(local.cwiseAbs().maxCoeff() < 4.0)) return false; // it lies elsewhere
        if (change.cwiseAbs().maxCoeff() < 0.1 * kWithin) break;
    }
    return local.minCoeff() >= -kWithin && local.maxCoeff() <= 1.0 + kWithin;
}

} // namespace osgSkin::elastic
