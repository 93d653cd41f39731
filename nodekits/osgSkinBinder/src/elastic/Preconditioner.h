// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBINDER_ELASTIC_PRECONDITIONER_H
#define OSGSKINBINDER_ELASTIC_PRECONDITIONER_H

#include "elastic/Minimise.h"
#include "elastic/solid/Energies.h"
#include "elastic/solid/VoxelLattice.h"

#include <Eigen/SparseCore>

#include <cstddef>
#include <vector>

namespace osgSkin::elastic {

/// A sparse Cholesky factor L whose neighbouring columns of equal structure form blocks
/// (supernodes: Davis 2006, section 4.8), so that solving reads and writes each unknown once for
/// up to four columns. In single precision: it only guides the minimiser.
struct BlockedFactor {
    static constexpr int kMaxColumns = 4;
    /// Floats per unknown: three right sides and one for padding.
    static constexpr std::size_t kStride = 4;

    struct Block {
        int first = 0, columns = 0;   ///< of the block
        int firstRow = 0, endRow = 0; ///< range in rows
        std::size_t firstValue = 0;
    };
    std::vector<Block> blocks;
    std::vector<int> rows; ///< below the blocks' triangles
    /// For each block the inverse of its diagonal, its triangle row by row, and its rows.
    std::vector<float> values;

    BlockedFactor() = default;

    /// \param lower triangle, compressed; each column begins with its diagonal
    explicit BlockedFactor(const Eigen::SparseMatrix<double>& lower);

    /// Solves L L^T x = b for three right sides at once.
    /// \param x kStride numbers for each unknown, aligned to 16 bytes; b on entry
    void solve(float* x) const;
};

/// The lattice's Laplacian plus the bone cores, factored once: the part of the Hessian that never
/// changes and is the same for x, y and z (Liu, Bouaziz & Kavan 2017). Const after construction.
class Preconditioner {
public:
    /// \throw osgSkin::elastic::Unsolvable where the matrix is singular
    Preconditioner(const VoxelLattice& lattice, const BoneCores& cores);

    /// Displacement of the free nodes for a gradient; pinned nodes get none.
    Directions solve(const Directions& gradient) const;

private:
    Eigen::Index _free = 0;
    BlockedFactor _factor;
    std::vector<int> _place; ///< index of each free node in the factor
};

} // namespace osgSkin::elastic

#endif
