// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_ELASTIC_FASCIA_H
#define OSGSKINBIND_ELASTIC_FASCIA_H

#include "elastic/lattice/VoxelLattice.h"

namespace osgSkin::elastic {

/// What ties the flesh loosely to its place along the bones: every bit of it is drawn to where the
/// plain skin's turn takes it. Without it a deep fold has many shapes, as one side may slide along
/// the other for nothing, and which one comes out depends on the way there. Const after
/// construction.
class Fascia {
public:
    /// \param stiffness mu / r^2 a volume
    Fascia(const VoxelLattice& lattice, double stiffness);

    /// Energy of the nodes' positions; its gradient is added.
    /// \param goals of all nodes
    double value(const Points& nodes, const Points& goals, Points& gradient) const;

private:
    Eigen::VectorXd _stiffness; ///< of each node, times its volume
};

} // namespace osgSkin::elastic

#endif
