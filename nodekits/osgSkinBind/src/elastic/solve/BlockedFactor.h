// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_ELASTIC_BLOCKEDFACTOR_H
#define OSGSKINBIND_ELASTIC_BLOCKEDFACTOR_H

#include <Eigen/SparseCore>

#include <cstddef>
#include <vector>

namespace osgSkin::elastic {

/// A sparse Cholesky factor L whose neighbouring columns of equal structure form blocks
/// (supernodes: Davis 2006, section 4.8), so that solving reads and writes each unknown once for
/// up to four columns.
struct BlockedFactor {
    static constexpr int kMaxColumns = 4;
    /// Doubles of an unknown: three right sides, and one that pads them.
    static constexpr std::size_t kStride = 4;

    struct Block {
        int first = 0, columns = 0;   ///< of the block
        int firstRow = 0, endRow = 0; ///< range in rows
        std::size_t firstValue = 0;
    };
    std::vector<Block> blocks;
    std::vector<int> rows; ///< below the blocks' triangles
    /// Of each block the inverse of its diagonal, its triangle row by row, and its rows.
    std::vector<double> values;

    BlockedFactor() = default;

    /// \param lower triangle, compressed; each column begins with its diagonal
    explicit BlockedFactor(const Eigen::SparseMatrix<double>& lower);

    /// Solves L L^T x = b for three right sides at once.
    /// \param x kStride numbers of each unknown, aligned to 32 bytes; b on entry
    void solve(double* x) const;
};

} // namespace osgSkin::elastic

#endif
