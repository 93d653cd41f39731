// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_ELASTIC_DEFORMEDCELLS_H
#define OSGSKINBIND_ELASTIC_DEFORMEDCELLS_H

#include "elastic/lattice/VoxelLattice.h"

#include <Eigen/Geometry>

#include <cstdint>
#include <vector>

namespace osgSkin::elastic {

/// Finds what flesh is at a place once the lattice is deformed: a point's rest positions. Cells are
/// sorted into a regular grid of bins.
class DeformedCells {
public:
    DeformedCells(const VoxelLattice& lattice, const Points& nodes);

    static constexpr std::size_t kNoBin = static_cast<std::size_t>(-1);

    std::size_t bins() const { return _first.size() - 1; }

    /// The bin that a point lies in; kNoBin where no cell is near.
    std::size_t binOf(const Point& point) const {
        return _bounds.contains(point) ? index(binAt(point)) : kNoBin;
    }

    /// Calls visit(cell) for each cell that reaches into a bin.
    template <typename Visit>
    void forEachIn(std::size_t bin, const Visit& visit) const {
        for (std::uint32_t i = _first[bin]; i < _first[bin + 1]; ++i) visit(_cells[i]);
    }

    /// Calls found(cell, local) for each cell that the point lies in, until it returns true.
    ///
    /// \param bin the point's
    /// \param matters which cells are looked into; most of the time goes there
    template <typename Matters, typename Found>
    void find(std::size_t bin, const Point& point, const Matters& matters,
              const Found& found) const;

private:
    Eigen::Vector3i binAt(const Point& point) const;
    std::size_t index(const Eigen::Vector3i& bin) const;
    bool locate(std::uint32_t cell, const Point& point, Point& local) const;

    /// A cell's trilinear map as a polynomial: at the lowest corner, and by x, y, z, xy, yz, zx and
    /// xyz.
    struct Map {
        Point at, x, y, z, xy, yz, zx, xyz;
    };

    Eigen::AlignedBox3d _bounds;
    Eigen::Vector3i _bins;
    double _binSize;
    std::vector<Eigen::AlignedBox3d> _boxes; ///< of the cells
    std::vector<Map> _maps;                  ///< of the cells
    std::vector<std::uint32_t> _first;       ///< of each bin; size: bins + 1
    std::vector<std::uint32_t> _cells;
};

template <typename Matters, typename Found>
void DeformedCells::find(std::size_t bin, const Point& point, const Matters& matters,
                         const Found& found) const {
    for (std::uint32_t i = _first[bin]; i < _first[bin + 1]; ++i) {
        const std::uint32_t cell = _cells[i];
        Point local;
        if (_boxes[cell].contains(point) && matters(cell) && locate(cell, point, local) &&
            found(cell, local))
            return;
    }
}

} // namespace osgSkin::elastic

#endif
