// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBINDER_ELASTIC_SOLID_VOXELLATTICE_H
#define OSGSKINBINDER_ELASTIC_SOLID_VOXELLATTICE_H

#include "elastic/solid/RestSkin.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <vector>

namespace osgSkin::elastic {

/// A cubic cell's trilinear shape functions at its 2 x 2 x 2 Gauss points. The bits of a corner's
/// or point's number are its position along x (lowest bit), y and z.
struct CellShape {
    static constexpr std::size_t kCorners = 8, kPoints = 8;

    /// The two Gauss points along an edge of length 1.
    static constexpr double kLow = 0.21132486540518708, kHigh = 0.7886751345948129;

    double edge = 0.0;
    double value[kCorners][kPoints];    ///< N_c at each point
    double slope[3][kCorners][kPoints]; ///< dN_c / dX at each point

    explicit CellShape(double edge);

    /// Integral of dN_a . dN_b over the cell.
    Eigen::Matrix<double, 8, 8> laplacian() const;

    double volumeOfPoint() const { return edge * edge * edge / kPoints; }

    /// A Gauss point's position in the cell, 0 to 1.
    static Point local(std::size_t point);

    /// N_c at a position in the cell.
    static std::array<double, kCorners> values(const Point& local);

    /// dN_c / dlocal, a column for each corner.
    static Eigen::Matrix<double, 3, 8> slopes(const Point& local);
};

/// Cubic cells in a ball around the joint, each with 3 x 3 x 3 samples that are inside the skin or
/// not. A cell has a copy for each connected piece of its filled samples, so that two limbs in one
/// cell that do not touch (thighs below the crotch) stay separate (virtual nodes: Molino, Bao &
/// Fedkiw 2004).
class FilledGrid {
public:
    static constexpr int kFine = 3; ///< samples along a cell's edge
    static constexpr std::int32_t kEmpty = -1;

    /// \param edge of the cells
    /// \param reach radius of the ball, which has the cells whose centres are inside
    FilledGrid(const RestSkin& skin, double edge, double reach);

    double edge() const { return _edge; }
    double reach() const { return _reach; }
    /// For each copy the coordinates of its cell, whose lowest corner is at edge * coordinates.
    const std::vector<Eigen::Vector3i>& copies() const { return _copies; }

    /// The copy that owns the filled sample nearest to the point, up to a few samples away; kEmpty
    /// if there is none.
    std::int32_t copyNear(const Point& point) const;

    /// The copy that owns the sample in whose small cube the point is; kEmpty if it is not filled.
    std::int32_t copyAt(const Point& point) const;

    /// Whether a point is inside the skin; not set if the skin may intersect its sample's cube.
    std::optional<bool> isInside(const Point& point) const;

    /// Calls join(a, b, axis) for copies that touch; b is the next one along the axis.
    template <typename Join>
    void forEachTouch(const Join& join) const;

private:
    std::size_t indexOf(const Eigen::Vector3i& fine) const {
        const auto at = fine.cast<std::size_t>();
        const auto samples = static_cast<std::size_t>(_samples);
        return (at.z() * samples + at.y()) * samples + at.x();
    }
    Point sampleAt(const Eigen::Vector3i& fine) const;
    Eigen::Vector3i fineAt(const Point& point) const;
    bool contains(const Eigen::Vector3i& fine) const;
    void classify(const RestSkin& skin);
    bool isInside(const RestSkin& skin, const Eigen::Vector3i& fine) const;
    void fillAroundVertices(const RestSkin& skin);
    void makeCopies();
    void flood(const Eigen::Vector3i& from, const Eigen::Vector3i& cell, std::int32_t copy);
    bool inBall(const Eigen::Vector3i& cell) const;

    double _edge, _reach;
    int _half;                         ///< cells from the centre to one side
    int _samples;                      ///< along an axis
    std::vector<std::int32_t> _copyOf; ///< of each sample
    std::vector<bool> _sure;           ///< of each sample: its cube is on one side of the skin
    std::vector<Eigen::Vector3i> _copies;
};

/// The skin around a joint makes no elastic solid; what() says why. solveElasticJoint() catches it
/// and sets ElasticShapes::reason.
struct Unsolvable : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// Trilinear weights of a cell's eight nodes for a point in the cell. A point beside the cell moves
/// with the cell's nearest point and the deformation gradient there.
struct Embedded {
    std::uint32_t cell = 0;
    std::array<double, 8> weights{};
};

/// The body around a joint as cubic cells: the connected piece nearest to the joint's centre. Cells
/// that the skin intersects are filled wholly: thin flesh would crumple in a fold. Nodes at the rim
/// of the ball are pinned; the free ones come first.
class VoxelLattice {
public:
    struct Cell {
        std::array<std::uint32_t, 8> nodes{}; ///< of corner c at (c & 1, c >> 1 & 1, c >> 2)
        Point low;                            ///< lowest corner
    };

    /// \throw osgSkin::elastic::Unsolvable if there is no such piece
    VoxelLattice(const RestSkin& skin, double edge, double reach);

    const CellShape& shape() const { return _shape; }
    const std::vector<Cell>& cells() const { return _cells; }
    const Points& rest() const { return _rest; } ///< the nodes
    Eigen::Index freeNodes() const { return _free; }

    /// Rest position of a cell's Gauss point.
    Point gaussPoint(const Cell& cell, std::size_t point) const;

    /// \return false if no cell is near, or the nearest one belongs to another piece
    bool embed(const Point& rest, Embedded& result) const;

    /// See FilledGrid::isInside().
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
