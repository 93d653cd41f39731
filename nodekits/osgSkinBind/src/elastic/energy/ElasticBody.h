// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_ELASTIC_ELASTICBODY_H
#define OSGSKINBIND_ELASTIC_ELASTICBODY_H

#include "elastic/energy/CellEnergy.h"
#include "elastic/lattice/VoxelLattice.h"

namespace osgSkin::elastic {

/// The flesh of a whole lattice. Const after construction.
class ElasticBody {
public:
    ElasticBody(const VoxelLattice& lattice, const Flesh& flesh)
        : _lattice(lattice), _flesh(flesh) {}

    /// Energy of the nodes' positions; its gradient is added. Infinity where a cell is inverted.
    double value(const Points& nodes, Points& gradient) const;

    /// Volumes, posed over rest.
    struct Volumes {
        double least = 0.0; ///< J of the Gauss point that is pressed most; not above 0: inverted
        double whole = 0.0;
    };
    Volumes volumes(const Points& nodes) const;

private:
    const VoxelLattice& _lattice;
    Flesh _flesh;
};

} // namespace osgSkin::elastic

#endif
