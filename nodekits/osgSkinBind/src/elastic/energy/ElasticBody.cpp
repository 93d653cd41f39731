// SPDX-License-Identifier: GPL-3.0-or-later
#include "elastic/energy/ElasticBody.h"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <limits>

namespace osgSkin::elastic {

double ElasticBody::value(const Points& nodes, Points& gradient) const {
    const double pointVolume = _lattice.shape().volumeOfPoint();
    double energy = 0.0;
    CellState state;
    state.volume = pointVolume;
    for (const VoxelLattice::Cell& cell : _lattice.cells()) {
        for (std::size_t c = 0; c < 8; ++c) {
            const double* corner = nodes.data() + std::size_t{3} * cell.nodes[c];
            for (std::size_t i = 0; i < 3; ++i) state.corner[i][c] = corner[i];
        }
        double least = 0.0;
        energy += cellEnergy(_lattice.shape(), _flesh, state, least);
        if (!std::isfinite(energy)) return energy;
        for (std::size_t c = 0; c < 8; ++c) {
            double* corner = gradient.data() + std::size_t{3} * cell.nodes[c];
            for (std::size_t i = 0; i < 3; ++i) corner[i] += state.gradient[i][c];
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
