// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_ELASTIC_PRECONDITIONER_H
#define OSGSKINBIND_ELASTIC_PRECONDITIONER_H

#include "elastic/energy/BoneCores.h"
#include "elastic/lattice/VoxelLattice.h"
#include "elastic/solve/BlockedFactor.h"

#include <vector>

namespace osgSkin::elastic {

/// The lattice's Laplacian plus its bones, factored once: the part of the Hessian that never
/// changes and is the same for x, y and z (Liu, Bouaziz & Kavan 2017). Const after construction.
class Preconditioner {
public:
    Preconditioner(const VoxelLattice& lattice, const BoneCores& cores);

    /// Displacement of the free nodes for a gradient; pinned nodes get none.
    Points solve(const Points& gradient) const;

private:
    Eigen::Index _free = 0;
    BlockedFactor _factor;
    std::vector<int> _place; ///< of each free node in the factor's order
};

} // namespace osgSkin::elastic

#endif
