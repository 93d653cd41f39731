// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_ELASTIC_VOXELLATTICE_H
#define OSGSKINBIND_ELASTIC_VOXELLATTICE_H

#include "elastic/lattice/CellShape.h"
#include "elastic/lattice/FilledGrid.h"

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace osgSkin::elastic {

/// Trilinear weights of a cell's eight nodes: for a point in the cell, or for one beside it that
/// moves with the cell's nearest point and deformation gradient.
struct Embedded {
    std::uint32_t cell = 0;
    std::array<double, 8> weights{};
};

/// The body around a joint as cubic cells: the connected piece that the joint's centre lies in or
/// nearest to. Cells count whole, also where the skin cuts them: flesh that thins out there would
/// crumple in a fold. Nodes at the rim of the ball are pinned; the free ones come first.
class VoxelLattice {
public:
    struct Cell {
        std::array<std::uint32_t, 8> nodes{}; ///< corner c at place + (c & 1, c >> 1 & 1, c >> 2)
        Point low;                            ///< lowest corner
    };

    /// \throw osgSkin::elastic::Unsolvable where there is no such piece
    VoxelLattice(const RestSkin& skin, double edge, double reach);

    const CellShape& shape() const { return _shape; }
    const std::vector<Cell>& cells() const { return _cells; }
    const Points& rest() const { return _rest; } ///< the nodes
    Eigen::Index freeNodes() const { return _free; }

    /// Rest position of a cell's Gauss point.
    Point gaussPoint(const Cell& cell, std::size_t point) const;

    /// False where nothing of the lattice is near, or what is nearest is no part of it.
    bool embed(const Point& rest, Embedded& result) const;

    /// FilledGrid::isInside().
    std::optional<bool> isInside(const Point& rest) const { return _grid.isInside(rest); }

    Point positionOf(const Embedded& point, const Points& nodes) const;

private:
    void connect();
    void numberNodes(const std::vector<std::size_t>& setOf);

    FilledGrid _grid;
    CellShape _shape;
    std::vector<Cell> _cells;
    std::vector<std::int32_t> _cellOfCopy;
    Points _rest;
    Eigen::Index _free = 0;
};

} // namespace osgSkin::elastic

#endif
