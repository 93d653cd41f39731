// SPDX-License-Identifier: GPL-3.0-or-later
#include "elastic/energy/Fascia.h"

namespace osgSkin::elastic {

Fascia::Fascia(const VoxelLattice& lattice, double stiffness)
    : _stiffness(Eigen::VectorXd::Zero(lattice.rest().cols())) {
    // A cell has as many Gauss points as corners.
    for (const VoxelLattice::Cell& cell : lattice.cells())
        for (const std::uint32_t node : cell.nodes)
            _stiffness[node] += stiffness * lattice.shape().volumeOfPoint();
}

double Fascia::value(const Points& nodes, const Points& goals, Points& gradient) const {
    double energy = 0.0;
    for (Eigen::Index i = 0; i < nodes.cols(); ++i) {
        const Point off = nodes.col(i) - goals.col(i);
        energy += 0.5 * _stiffness[i] * off.squaredNorm();
        gradient.col(i) += _stiffness[i] * off;
    }
    return energy;
}

} // namespace osgSkin::elastic
