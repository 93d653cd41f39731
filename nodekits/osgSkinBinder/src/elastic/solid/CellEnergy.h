// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBINDER_ELASTIC_CELLENERGY_H
#define OSGSKINBINDER_ELASTIC_CELLENERGY_H

#include "elastic/solid/VoxelLattice.h"

namespace osgSkin::elastic {

/// The flesh, in units of its shear stiffness mu.
struct Flesh {
    double bulk = 20.0;         ///< kappa: resistance of a cell's volume to change
    double barrier = 10.0;      ///< against inversion
    double barrierBegins = 0.8; ///< J below which the barrier acts
};

/// Values of several cells side by side, one cell a SIMD lane. All lanes must be set; copy a cell
/// to unused ones. Positions are relative to a point of the cell: they are rounded to single
/// precision.
struct CellBatch {
    static constexpr std::size_t kCells = 16;
    static constexpr std::size_t kAlignment = 64;

    alignas(kAlignment) float corner[3][CellShape::kCorners][kCells];   ///< positions
    alignas(kAlignment) float gradient[3][CellShape::kCorners][kCells]; ///< of each cell's energy
    alignas(kAlignment) float energy[kCells];
};

/// Elastic energies of cells and their gradients: as-rigid-as-possible |F - R|^2 at the Gauss
/// points, one volume term kappa / 2 (mean J - 1)^2 for the cell, so that trilinear cells do not
/// lock, and a barrier -(J - J0)^2 ln(J / J0) below J0 (Li et al. 2020), infinite at 0.
/// \param shape of all cells
/// \param batch has positions; gets energies and gradients
/// \return false if some J is not above 0: the energy is infinite
bool cellEnergies(const CellShape& shape, const Flesh& flesh, CellBatch& batch);

} // namespace osgSkin::elastic

#endif
