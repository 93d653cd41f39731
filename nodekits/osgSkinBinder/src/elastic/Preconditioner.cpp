// SPDX-License-Identifier: GPL-3.0-or-later
//
// foreach_target.h includes this file once for each instruction set; the best one is chosen at run
// time.
#include "elastic/Preconditioner.h"

#include <Eigen/SparseCholesky>
#include <hwy/aligned_allocator.h>

#include <algorithm>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "elastic/Preconditioner.cpp"
#include <hwy/foreach_target.h>
// Must follow foreach_target.h.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace osgSkin::elastic {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using Tag = hn::CappedTag<float, BlockedFactor::kStride>;
using V = hn::Vec<Tag>;

HWY_INLINE float* at(float* x, int unknown) {
    return x + BlockedFactor::kStride * static_cast<std::size_t>(unknown);
}

HWY_INLINE constexpr int triangleAt(int row, int column) {
    return row * (row - 1) / 2 + column;
}

/// Solves L y = b in a block and updates the unknowns below.
template <int kColumns>
HWY_INLINE void forward(const BlockedFactor::Block& block, const int* rows, const float* values,
                        float* x) {
    const Tag d;
    const float* triangle = values + kColumns;
    V own[kColumns];
    for (int c = 0; c < kColumns; ++c) {
        own[c] = hn::Load(d, at(x, block.first + c));
        for (int k = 0; k < c; ++k)
            own[c] = hn::NegMulAdd(hn::Set(d, triangle[triangleAt(c, k)]), own[k], own[c]);
        own[c] = hn::Mul(own[c], hn::Set(d, values[c]));
        hn::Store(own[c], d, at(x, block.first + c));
    }
    const float* value = triangle + triangleAt(kColumns, 0);
    for (int r = block.firstRow; r < block.endRow; ++r, value += kColumns) {
        float* other = at(x, rows[r]);
        V sum = hn::Load(d, other);
        for (int c = 0; c < kColumns; ++c) sum = hn::NegMulAdd(hn::Set(d, value[c]), own[c], sum);
        hn::Store(sum, d, other);
    }
}

/// Solves L^T x = y in a block.
template <int kColumns>
HWY_INLINE void backward(const BlockedFactor::Block& block, const int* rows, const float* values,
                         float* x) {
    const Tag d;
    const float* triangle = values + kColumns;
    V own[kColumns];
    for (int c = 0; c < kColumns; ++c) own[c] = hn::Load(d, at(x, block.first + c));
    const float* value = triangle + triangleAt(kColumns, 0);
    for (int r = block.firstRow; r < block.endRow; ++r, value += kColumns) {
        const V other = hn::Load(d, at(x, rows[r]));
        for (int c = 0; c < kColumns; ++c)
            own[c] = hn::NegMulAdd(hn::Set(d, value[c]), other, own[c]);
    }
    for (int c = kColumns; c-- > 0;) {
        for (int k = c + 1; k < kColumns; ++k)
            own[c] = hn::NegMulAdd(hn::Set(d, triangle[triangleAt(k, c)]), own[k], own[c]);
        own[c] = hn::Mul(own[c], hn::Set(d, values[c]));
        hn::Store(own[c], d, at(x, block.first + c));
    }
}

void solveAll(const BlockedFactor& factor, float* unknowns) {
    const int* rows = factor.rows.data();
    for (std::size_t lane = 0; lane < 3; lane += hn::Lanes(Tag())) {
        float* x = unknowns + lane;
        for (const BlockedFactor::Block& block : factor.blocks) {
            const float* values = factor.values.data() + block.firstValue;
            switch (block.columns) {
            case 1:
                forward<1>(block, rows, values, x);
                break;
            case 2:
                forward<2>(block, rows, values, x);
                break;
            case 3:
                forward<3>(block, rows, values, x);
                break;
            default:
                forward<4>(block, rows, values, x);
            }
        }
        for (std::size_t i = factor.blocks.size(); i-- > 0;) {
            const BlockedFactor::Block& block = factor.blocks[i];
            const float* values = factor.values.data() + block.firstValue;
            switch (block.columns) {
            case 1:
                backward<1>(block, rows, values, x);
                break;
            case 2:
                backward<2>(block, rows, values, x);
                break;
            case 3:
                backward<3>(block, rows, values, x);
                break;
            default:
                backward<4>(block, rows, values, x);
            }
        }
    }
}

} // namespace HWY_NAMESPACE
} // namespace osgSkin::elastic
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace osgSkin::elastic {
namespace {

/// True if the next column has this column's structure without its diagonal.
bool continues(const Eigen::SparseMatrix<double>& lower, int column) {
    const int* starts = lower.outerIndexPtr();
    const int* rows = lower.innerIndexPtr();
    const int begin = starts[column] + 1, end = starts[column + 1];
    return std::equal(rows + begin, rows + end, rows + end, rows + starts[column + 2]);
}

using Matrix = Eigen::SparseMatrix<double>;
using Dense = Eigen::Matrix<double, 8, 8>;

/// Curvature of |F - R|^2 with R held constant.
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

BlockedFactor::BlockedFactor(const Eigen::SparseMatrix<double>& lower) {
    const int count = static_cast<int>(lower.cols());
    const int* starts = lower.outerIndexPtr();
    const double* of = lower.valuePtr();
    for (int column = 0; column < count;) {
        Block block;
        block.first = column;
        block.columns = 1;
        while (block.columns < kMaxColumns && column + block.columns < count &&
               continues(lower, column + block.columns - 1))
            ++block.columns;
        const int last = column + block.columns - 1;
        block.firstRow = static_cast<int>(rows.size());
        rows.insert(rows.end(), lower.innerIndexPtr() + starts[last] + 1,
                    lower.innerIndexPtr() + starts[last + 1]);
        block.endRow = static_cast<int>(rows.size());
        block.firstValue = values.size();
        for (int c = column; c <= last; ++c) values.push_back(float(1.0 / of[starts[c]]));
        for (int row = column + 1; row <= last; ++row)
            for (int c = column; c < row; ++c) values.push_back(float(of[starts[c] + row - c]));
        for (int r = 0; r < block.endRow - block.firstRow; ++r)
            for (int c = column; c <= last; ++c)
                values.push_back(float(of[starts[c] + last - c + 1 + r]));
        blocks.push_back(block);
        column = last + 1;
    }
}

HWY_EXPORT(solveAll);

void BlockedFactor::solve(float* x) const {
    HWY_DYNAMIC_DISPATCH(solveAll)(*this, x);
}

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
    if (decomposed.info() != Eigen::Success) throw Unsolvable("its lattice is badly connected");
    _factor = BlockedFactor(decomposed.matrixL());
    const auto& order = decomposed.permutationP().indices();
    _place.assign(order.data(), order.data() + order.size());
}

Directions Preconditioner::solve(const Directions& gradient) const {
    constexpr std::size_t kStride = BlockedFactor::kStride;
    const auto x = hwy::AllocateAligned<float>(kStride * _place.size());
    for (std::size_t i = 0; i < _place.size(); ++i) {
        float* const to = &x[kStride * static_cast<std::size_t>(_place[i])];
        std::copy_n(gradient.data() + 3 * i, 3, to);
        to[3] = 0.0f;
    }
    _factor.solve(x.get());
    Directions result = Directions::Zero(3, gradient.cols());
    for (std::size_t i = 0; i < _place.size(); ++i)
        std::copy_n(&x[kStride * static_cast<std::size_t>(_place[i])], 3, result.data() + 3 * i);
    return result;
}

} // namespace osgSkin::elastic
#endif
