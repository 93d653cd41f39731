// SPDX-License-Identifier: GPL-3.0-or-later
#include "elastic/solve/Preconditioner.h"

#include "elastic/lattice/Unsolvable.h"

#include <Eigen/SparseCholesky>
#include <hwy/aligned_allocator.h>

#include <algorithm>

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
    _factor = BlockedFactor(decomposed.matrixL());
    const auto& order = decomposed.permutationP().indices();
    _place.assign(order.data(), order.data() + order.size());
}

Points Preconditioner::solve(const Points& gradient) const {
    constexpr std::size_t kStride = BlockedFactor::kStride;
    const auto x = hwy::AllocateAligned<double>(kStride * _place.size());
    for (std::size_t i = 0; i < _place.size(); ++i) {
        double* const to = &x[kStride * static_cast<std::size_t>(_place[i])];
        std::copy_n(gradient.data() + 3 * i, 3, to);
        to[3] = 0.0;
    }
    _factor.solve(x.get());
    Points result = Points::Zero(3, gradient.cols());
    for (std::size_t i = 0; i < _place.size(); ++i)
        std::copy_n(&x[kStride * static_cast<std::size_t>(_place[i])], 3, result.data() + 3 * i);
    return result;
}

} // namespace osgSkin::elastic
