// SPDX-License-Identifier: GPL-3.0-or-later
#include "elastic/energy/ElasticBody.h"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <limits>

namespace osgSkin::elastic {

double ElasticBody::value(const Points& nodes, Points& gradient) const {
    const std::vector<VoxelLattice::Cell>& cells = _lattice.cells();
    double energy = 0.0;
    CellBatch batch;
    for (std::size_t first = 0; first < cells.size(); first += CellBatch::kCells) {
        const std::size_t count = std::min(CellBatch::kCells, cells.size() - first);
        for (std::size_t lane = 0; lane < CellBatch::kCells; ++lane) {
            const auto& of = cells[first + std::min(lane, count - 1)].nodes;
            for (std::size_t c = 0; c < CellShape::kCorners; ++c) {
                const double* node = nodes.data() + std::size_t{3} * of[c];
                for (std::size_t i = 0; i < 3; ++i) batch.corner[i][c][lane] = node[i];
            }
        }
        if (!cellEnergies(_lattice.shape(), _flesh, batch))
            return std::numeric_limits<double>::infinity();
        for (std::size_t lane = 0; lane < count; ++lane) {
            energy += batch.energy[lane];
            const auto& of = cells[first + lane].nodes;
            for (std::size_t c = 0; c < CellShape::kCorners; ++c) {
                double* node = gradient.data() + std::size_t{3} * of[c];
                for (std::size_t i = 0; i < 3; ++i) node[i] += batch.gradient[i][c][lane];
            }
        }
    }
    return energy;
}

ElasticBody::Volumes ElasticBody::volumes(const Points& nodes) const {
    Volumes result;
    result.least = std::numeric_limits<double>::infinity();
    for (const VoxelLattice::Cell& cell : _lattice.cells()) {
        Eigen::Matrix<double, 3, 8> corners;
        for (std::size_t c = 0; c < 8; ++c)
            corners.col(static_cast<Eigen::Index>(c)) = nodes.col(cell.nodes[c]);
        for (std::size_t g = 0; g < CellShape::kPoints; ++g) {
            const Eigen::Matrix3d slope = corners *
                                          CellShape::slopes(CellShape::local(g)).transpose() /
                                          _lattice.shape().edge;
            const double jacobian = slope.determinant();
            result.least = std::min(result.least, jacobian);
            result.whole += jacobian;
        }
    }
    result.whole /= static_cast<double>(CellShape::kPoints * _lattice.cells().size());
    return result;
}

} // namespace osgSkin::elastic
