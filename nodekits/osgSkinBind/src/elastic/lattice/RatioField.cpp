// SPDX-License-Identifier: GPL-3.0-or-later
#include "elastic/lattice/RatioField.h"

#include <Eigen/IterativeLinearSolvers>
#include <Eigen/SparseCore>

namespace osgSkin::elastic {
namespace {

/// How firmly the skin's ratios hold, against the Laplacian's 1 an edge's length.
constexpr double kSkinHolds = 10.0;

} // namespace

Eigen::VectorXd ratioField(const VoxelLattice& lattice, const SkinPatch& patch) {
    const CellShape& shape = lattice.shape();
    const Eigen::Matrix<double, 8, 8> laplacian = shape.laplacian();
    const Eigen::Index count = lattice.rest().cols();
    Eigen::VectorXd target = Eigen::VectorXd::Zero(count);
    std::vector<Eigen::Triplet<double>> entries;
    for (const VoxelLattice::Cell& cell : lattice.cells())
        for (std::size_t a = 0; a < 8; ++a)
            for (std::size_t b = 0; b < 8; ++b)
                entries.emplace_back(
                    cell.nodes[a], cell.nodes[b],
                    laplacian(static_cast<Eigen::Index>(a), static_cast<Eigen::Index>(b)));
    for (std::size_t v = 0; v < patch.vertices().size(); ++v) {
        const Embedded& at = patch.embedded()[v];
        const auto& nodes = lattice.cells()[at.cell].nodes;
        const double hold = kSkinHolds * shape.edge;
        for (std::size_t a = 0; a < 8; ++a) {
            target[nodes[a]] += hold * at.weights[a] * patch.ratios()[v];
            for (std::size_t b = 0; b < 8; ++b)
                entries.emplace_back(nodes[a], nodes[b], hold * at.weights[a] * at.weights[b]);
        }
    }
    Eigen::SparseMatrix<double> system(count, count);
    system.setFromTriplets(entries.begin(), entries.end());
    Eigen::ConjugateGradient<Eigen::SparseMatrix<double>, Eigen::Lower | Eigen::Upper> solver(
        system);
    solver.setTolerance(1e-6);
    return Eigen::VectorXd(solver.solve(target)).cwiseMax(0.0).cwiseMin(1.0);
}

Points turned(const Points& points, const Eigen::VectorXd& ratios, const Eigen::Quaterniond& by) {
    const Eigen::AngleAxisd whole(by.w() < 0.0 ? Eigen::Quaterniond(-by.coeffs()) : by);
    Points result(3, points.cols());
    for (Eigen::Index i = 0; i < points.cols(); ++i)
        result.col(i) = Eigen::AngleAxisd(ratios[i] * whole.angle(), whole.axis()) * points.col(i);
    return result;
}

} // namespace osgSkin::elastic
