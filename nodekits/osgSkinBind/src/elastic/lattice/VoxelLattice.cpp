// SPDX-License-Identifier: GPL-3.0-or-later
#include "elastic/lattice/VoxelLattice.h"

#include "elastic/lattice/Unsolvable.h"
#include "mesh/DisjointSets.h"

#include <map>

namespace osgSkin::elastic {
namespace {

Point cornerOf(const Point& low, double edge, std::size_t corner) {
    return low + edge * Point(double(corner & 1u), double(corner >> 1 & 1u), double(corner >> 2));
}

} // namespace

VoxelLattice::VoxelLattice(const RestSkin& skin, double edge, double reach)
    : _grid(skin, edge, reach), _shape(edge) {
    connect();
}

/// Touching copies share the nodes of the face between them.
void VoxelLattice::connect() {
    const std::size_t copies = _grid.copies().size();
    DisjointSets pieces(copies), corners(8 * copies);
    _grid.forEachTouch([&](std::int32_t a, std::int32_t b, int axis) {
        const auto from = static_cast<std::size_t>(a), to = static_cast<std::size_t>(b);
        const std::size_t step = std::size_t(1) << axis;
        pieces.join(from, to);
        for (std::size_t c = 0; c < 8; ++c)
            if ((c & step) == 0) corners.join(8 * from + (c | step), 8 * to + c);
    });
    const std::int32_t middle = [&] { // the copy whose centre is nearest to the joint's
        std::int32_t best = FilledGrid::kEmpty;
        double nearest = _grid.reach();
        for (std::size_t i = 0; i < copies; ++i) {
            const double away =
                ((_grid.copies()[i].place.cast<double>().array() + 0.5) * _grid.edge())
                    .matrix()
                    .norm();
            if (away >= nearest) continue;
            nearest = away;
            best = static_cast<std::int32_t>(i);
        }
        return best;
    }();
    if (middle == FilledGrid::kEmpty) throw Unsolvable("there is no skin around the joint");

    _cellOfCopy.assign(copies, -1);
    std::vector<std::size_t> sets;
    const std::size_t main = pieces.find(static_cast<std::size_t>(middle));
    for (std::size_t i = 0; i < copies; ++i) {
        if (pieces.find(i) != main) continue;
        _cellOfCopy[i] = static_cast<std::int32_t>(_cells.size());
        Cell& cell = _cells.emplace_back();
        cell.low = _grid.copies()[i].place.cast<double>() * _grid.edge();
        for (std::size_t c = 0; c < 8; ++c) sets.push_back(corners.find(8 * i + c));
    }
    numberNodes(sets);
}

/// \param setOf the node that each cell's corner belongs to, eight a cell, under any number
void VoxelLattice::numberNodes(const std::vector<std::size_t>& setOf) {
    std::map<std::size_t, std::uint32_t> numbers;
    std::vector<Point> free, pinned;
    const double rim = _grid.reach() - _grid.edge();
    for (const bool pin : {false, true})
        for (std::size_t i = 0; i < setOf.size(); ++i) {
            Cell& cell = _cells[i / 8];
            const Point at = cornerOf(cell.low, _grid.edge(), i % 8);
            if ((at.norm() > rim) != pin) continue;
            const auto count = static_cast<std::uint32_t>(free.size() + pinned.size());
            const auto [place, added] = numbers.try_emplace(setOf[i], count);
            if (added) (pin ? pinned : free).push_back(at);
            cell.nodes[i % 8] = place->second;
        }
    _free = static_cast<Eigen::Index>(free.size());
    if (free.empty() || pinned.empty()) throw Unsolvable("its limbs end within reach");
    free.insert(free.end(), pinned.begin(), pinned.end());
    _rest.resize(3, static_cast<Eigen::Index>(free.size()));
    for (std::size_t i = 0; i < free.size(); ++i) _rest.col(static_cast<Eigen::Index>(i)) = free[i];
}

Point VoxelLattice::gaussPoint(const Cell& cell, std::size_t point) const {
    return cell.low + _shape.edge * CellShape::local(point);
}

bool VoxelLattice::embed(const Point& rest, Embedded& result) const {
    const std::int32_t copy = _grid.copyNear(rest);
    if (copy == FilledGrid::kEmpty || _cellOfCopy[static_cast<std::size_t>(copy)] < 0) return false;
    result.cell = static_cast<std::uint32_t>(_cellOfCopy[static_cast<std::size_t>(copy)]);
    const Point local = (rest - _cells[result.cell].low) / _shape.edge;
    const Point within = local.cwiseMax(0.0).cwiseMin(1.0);
    const Point beyond = local - within;
    result.weights = CellShape::values(within);
    const Eigen::Matrix<double, 3, 8> slopes = CellShape::slopes(within);
    for (std::size_t c = 0; c < 8; ++c)
        result.weights[c] += slopes.col(static_cast<Eigen::Index>(c)).dot(beyond);
    return true;
}

Point VoxelLattice::positionOf(const Embedded& point, const Points& nodes) const {
    Point result = Point::Zero();
    const Cell& cell = _cells[point.cell];
    for (std::size_t c = 0; c < 8; ++c) result += point.weights[c] * nodes.col(cell.nodes[c]);
    return result;
}

} // namespace osgSkin::elastic
