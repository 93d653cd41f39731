// SPDX-License-Identifier: GPL-3.0-or-later
#include "elastic/lattice/DeformedCells.h"

namespace osgSkin::elastic {
namespace {

constexpr double kBinEdges = 1.0; ///< a bin's size in cells' edges
constexpr int kNewtonSteps = 6;
constexpr double kWithin = 1e-6;

/// A point that is so many edges off a cell's middle lies elsewhere.
constexpr double kFar = 3.5;

} // namespace

DeformedCells::DeformedCells(const VoxelLattice& lattice, const Points& nodes)
    : _binSize(kBinEdges * lattice.shape().edge) {
    _boxes.reserve(lattice.cells().size());
    _maps.reserve(lattice.cells().size());
    for (const VoxelLattice::Cell& cell : lattice.cells()) {
        Eigen::AlignedBox3d& box = _boxes.emplace_back();
        for (const std::uint32_t node : cell.nodes) box.extend(nodes.col(node));
        _bounds.extend(box);
        const auto corner = [&](std::size_t c) { return nodes.col(cell.nodes[c]); };
        Map& map = _maps.emplace_back();
        map.at = corner(0);
        map.x = corner(1) - corner(0);
        map.y = corner(2) - corner(0);
        map.z = corner(4) - corner(0);
        map.xy = corner(3) - corner(2) - map.x;
        map.yz = corner(6) - corner(4) - map.y;
        map.zx = corner(5) - corner(4) - map.x;
        map.xyz = corner(7) - corner(6) - corner(5) + corner(4) - map.xy;
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
    const Map& map = _maps[index];
    const Point target = point - map.at;
    local.setConstant(0.5);
    for (int step = 0; step < kNewtonSteps; ++step) {
        const double x = local.x(), y = local.y(), z = local.z();
        const Point byZ = map.z + x * map.zx + y * map.yz + x * y * map.xyz;
        const Point byX = map.x + y * map.xy + z * (map.zx + y * map.xyz);
        const Point byY = map.y + x * map.xy + z * (map.yz + x * map.xyz);
        const Point left = target - x * map.x - y * (map.y + x * map.xy) - z * byZ;
        // Cramer's rule.
        const Point across = byY.cross(byZ);
        const double scale = 1.0 / byX.dot(across);
        const Point change(scale * left.dot(across), scale * left.dot(byZ.cross(byX)),
                           scale * left.dot(byX.cross(byY)));
        local += change;
        const double off = (local.array() - 0.5).abs().maxCoeff();
        if (!(off < kFar)) return false;
        if (change.cwiseAbs().maxCoeff() < 0.1 * kWithin) break;
    }
    return local.minCoeff() >= -kWithin && local.maxCoeff() <= 1.0 + kWithin;
}

} // namespace osgSkin::elastic
