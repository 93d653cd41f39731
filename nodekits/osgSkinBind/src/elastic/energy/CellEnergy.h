// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_ELASTIC_CELLENERGY_H
#define OSGSKINBIND_ELASTIC_CELLENERGY_H

#include "elastic/lattice/CellShape.h"

namespace osgSkin::elastic {

/// The flesh, in units of its shear stiffness mu.
struct Flesh {
    double bulk = 20.0;         ///< kappa: resistance of a cell's volume to change
    double barrier = 10.0;      ///< against inversion
    double barrierBegins = 0.8; ///< J below which the barrier acts
};

/// One cell's numbers, corner by corner: a structure of arrays, so that Gauss points fill SIMD
/// lanes.
struct CellState {
    double corner[3][8];   ///< positions
    double gradient[3][8]; ///< of the energy by them
    double volume = 0.0;   ///< of each Gauss point at rest
};

/// Elastic energy of a cell and its gradient: as-rigid-as-possible |F - R|^2 at the Gauss points,
/// one volume term kappa / 2 (mean J - 1)^2 for the cell, so that trilinear cells do not lock, and
/// a barrier -(J - J0)^2 ln(J / J0) below J0 (Li et al. 2020), infinite at 0.
/// \param shape of all cells
/// \param flesh what it is made of
/// \param cell its positions and volume; gets the gradient
/// \param leastJacobian gets the smallest J of the Gauss points
/// \return infinity, and no gradient, where some J is not above 0
double cellEnergy(const CellShape& shape, const Flesh& flesh, CellState& cell,
                  double& leastJacobian);

} // namespace osgSkin::elastic

#endif
