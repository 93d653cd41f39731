// SPDX-License-Identifier: GPL-3.0-or-later
#include "elastic/solve/Preconditioner.h"

#include "elastic/lattice/Unsolvable.h"

#include <Eigen/SparseCholesky>

namespace osgSkin::elastic {
namespace {

using Matrix = Eigen::SparseMatrix<double>;
using Dense = Eigen::Matrix<double, 8, 8>;

/// Curvature of |F - R|^2 without the turning of R.
constexpr double kCurvature = 2.0;

std::vector<Dense> stiffnesses(const VoxelLattice& lattice, const BoneCores& cores) {
    const CellShape& shape = lattice.shape();
    std::vector<Dense> result(lattice.cells().size(), kCurvature * shape.laplacian());
    for (const BoneCores::Held& held : cores.held())
        for (Eigen::Index a = 0; a < 8; ++a)
            for (Eigen::Index b = 0; b < 8; ++b)
                result[held.cell](a, b) +=
                    held.stiffness * shape.value[a][held.point] * shape.value[b][held.point];
    return result;
}

} // namespace

Preconditioner::Preconditioner(const VoxelLattice& lattice, const BoneCores& cores)
    : _free(lattice.freeNodes()) {
    std::vector<Eigen::Triplet<double>> entries;
    const std::vector<Dense> stiffness = stiffnesses(lattice, cores);
    for (std::size_t i = 0; i < stiffness.size(); ++i) {
        const auto& nodes = lattice.cells()[i].nodes;
        for (std::size_t a = 0; a < 8; ++a)
            for (std::size_t b = 0; b < 8; ++b)
                if (nodes[a] < _free && nodes[b] < _free)
                    entries.emplace_back(
                        nodes[a], nodes[b],
                        stiffness[i](static_cast<Eigen::Index>(a), static_cast<Eigen::Index>(b)));
    }
    Matrix system(_free, _free);
    system.setFromTriplets(entries.begin(), entries.end());
    const Eigen::SimplicialLLT<Matrix> decomposed(system);
    if (decomposed.info() != Eigen::Success) throw Unsolvable("its lattice hangs together badly");
    _factor = decomposed.matrixL();
    const auto& order = decomposed.permutationP().indices();
    _place.assign(order.data(), order.data() + order.size());
}

/// Eigen solves column by column; the three coordinates at once read the factor once.
Points Preconditioner::solve(const Points& gradient) const {
    Points x(3, _free);
    for (Eigen::Index i = 0; i < _free; ++i)
        x.col(_place[static_cast<std::size_t>(i)]) = gradient.col(i);
    const int* starts = _factor.outerIndexPtr();
    const int* rows = _factor.innerIndexPtr();
    const double* values = _factor.valuePtr();
    for (Eigen::Index column = 0; column < _free; ++column) {
        const int begin = starts[column], end = starts[column + 1];
        const Point own = x.col(column) / values[begin]; // the diagonal comes first
        x.col(column) = own;
        for (int k = begin + 1; k < end; ++k) x.col(rows[k]) -= values[k] * own;
    }
    for (Eigen::Index column = _free; column-- > 0;) {
        const int begin = starts[column], end = starts[column + 1];
        Point own = x.col(column);
        for (int k = begin + 1; k < end; ++k) own -= values[k] * x.col(rows[k]);
        x.col(column) = own / values[begin];
    }
    Points result = Points::Zero(3, gradient.cols());
    for (Eigen::Index i = 0; i < _free; ++i)
        result.col(i) = x.col(_place[static_cast<std::size_t>(i)]);
    return result;
}

} // namespace osgSkin::elastic
