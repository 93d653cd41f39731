// SPDX-License-Identifier: GPL-3.0-or-later
#include "elastic/solid/SkinPatch.h"

#include <Eigen/Geometry>
#include <Eigen/IterativeLinearSolvers>
#include <Eigen/SparseCore>

namespace osgSkin::elastic {

SkinPatch::SkinPatch(const VoxelLattice& lattice, const RestSkin& skin,
                     const std::vector<double>& ratios)
    : _lattice(lattice), _triangleOf(skin.triangles().size(), kNone) {
    const Points& all = skin.positions();
    std::vector<bool> used(ratios.size(), false);
    for (const auto& triangle : skin.triangles())
        for (const std::uint32_t corner : triangle) used[corner] = true;
    std::vector<std::uint32_t> local(ratios.size(), kNone);
    for (std::uint32_t v = 0; v < ratios.size(); ++v) {
        Embedded embedded;
        if (!used[v] || !lattice.embed(all.col(v), embedded)) continue;
        local[v] = static_cast<std::uint32_t>(_vertices.size());
        _vertices.push_back(v);
        _embedded.push_back(embedded);
        _ratios.push_back(ratios[v]);
    }
    double volume = 0.0; // of the tetrahedra to the joint; its sign is that of the winding
    for (std::uint32_t t = 0; t < skin.triangles().size(); ++t) {
        const auto& [a, b, c] = skin.triangles()[t];
        volume += all.col(a).dot(all.col(b).cross(all.col(c)));
        if (local[a] == kNone || local[b] == kNone || local[c] == kNone) continue;
        _triangleOf[t] = static_cast<std::uint32_t>(_triangles.size());
        _triangles.push_back({local[a], local[b], local[c]});
    }
    _outwards = volume < 0.0 ? -1.0 : 1.0;
}

Points SkinPatch::positions(const Points& nodes) const {
    Points result(3, static_cast<Eigen::Index>(_vertices.size()));
    for (std::size_t v = 0; v < _vertices.size(); ++v)
        result.col(static_cast<Eigen::Index>(v)) = _lattice.positionOf(_embedded[v], nodes);
    return result;
}

void SkinPatch::spread(const Points& byVertex, Points& byNode) const {
    for (std::size_t v = 0; v < _vertices.size(); ++v) {
        const auto here = byVertex.col(static_cast<Eigen::Index>(v));
        if (here.isZero(0.0)) continue;
        const VoxelLattice::Cell& cell = _lattice.cells()[_embedded[v].cell];
        for (std::size_t c = 0; c < 8; ++c)
            byNode.col(cell.nodes[c]) += _embedded[v].weights[c] * here;
    }
}

Points SkinPatch::normals(const Points& positions) const {
    Points result = Points::Zero(3, positions.cols());
    for (const auto& [a, b, c] : _triangles) {
        const Point one = positions.col(b) - positions.col(a);
        const Point other = positions.col(c) - positions.col(a);
        const Point area = _outwards * one.cross(other);
        for (const std::uint32_t corner : {a, b, c}) result.col(corner) += area;
    }
    for (Eigen::Index v = 0; v < result.cols(); ++v)
        if (const double length = result.col(v).norm(); length > 0.0) result.col(v) /= length;
    return result;
}

namespace {

/// Weight of the skin's ratios per edge length, relative to the Laplacian.
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
