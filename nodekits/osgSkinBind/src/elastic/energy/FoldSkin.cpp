// SPDX-License-Identifier: GPL-3.0-or-later
#include "elastic/energy/FoldSkin.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace osgSkin::elastic {
namespace {

/// Points count as in a cell that are beyond its faces by rounding.
constexpr double kSpare = 0.999;

/// How far from a triangle its two sides are tested, in radii.
constexpr double kBeside = 2e-3;

/// A nearest point with smaller shares lies on an edge of its triangle, whose normal says nothing
/// about sides there.
constexpr double kOnEdge = 1e-6;

} // namespace

FoldSkin::FoldSkin(const VoxelLattice& lattice, const RestSkin& skin, const SkinPatch& patch,
                   const Eigen::VectorXd& nodeRatios, const ContactSizes& sizes)
    : _lattice(lattice), _skin(skin), _patch(patch), _sizes(sizes), _nodeRatios(nodeRatios),
      _rest(patch.positions(lattice.rest())) {
    for (const VoxelLattice::Cell& cell : lattice.cells()) {
        RatioSpan& span = _ratiosOf.emplace_back();
        for (const std::uint32_t node : cell.nodes)
            span.extend({nodeRatios[node], nodeRatios[node]});
    }
    placeProbes();
    findSides();
}

void FoldSkin::placeProbes() {
    for (std::uint32_t t = 0; t < _patch.triangles().size(); ++t) {
        const auto& [a, b, c] = _patch.triangles()[t];
        const Point one = _rest.col(b) - _rest.col(a), other = _rest.col(c) - _rest.col(a);
        const double longest = std::max({one.norm(), other.norm(), (other - one).norm()});
        const int rows = std::max(1, static_cast<int>(std::ceil(longest / _sizes.spacing)));
        // The centroids of the rows^2 small triangles that equal ones divide it into.
        const double area = 0.5 * one.cross(other).norm() / (rows * rows);
        for (int i = 0; i < rows; ++i)
            for (int j = 0; j < rows - i; ++j)
                for (const double shift : {1.0 / 3.0, 2.0 / 3.0}) {
                    const double u = (i + shift) / rows, v = (j + shift) / rows;
                    if (u + v > 1.0) continue;
                    const Point shares(1.0 - u - v, u, v);
                    const Point at = u * one + v * other + _rest.col(a);
                    _probes.push_back({t, shares, at, area, ratioOn(t, shares)});
                }
    }
}

void FoldSkin::findSides() {
    for (const auto& [a, b, c] : _patch.triangles()) {
        const Point one = _rest.col(b) - _rest.col(a), other = _rest.col(c) - _rest.col(a);
        const Point normal = one.cross(other).normalized();
        const Point middle = _rest.col(a) + (one + other) / 3.0;
        const bool before = _skin.inside(middle + kBeside * normal);
        const bool behind = _skin.inside(middle - kBeside * normal);
        _outwards.push_back(before == behind ? Point::Zero() : before ? Point(-normal) : normal);
    }
}

void FoldSkin::RatioSpan::extend(const RatioSpan& other) {
    low = std::min(low, other.low);
    high = std::max(high, other.high);
}

bool FoldSkin::mayTouch(const Probe& probe, const RatioSpan& flesh) const {
    return std::max(flesh.high - probe.ratio, probe.ratio - flesh.low) >= kSpare * _sizes.sides;
}

bool FoldSkin::mayTouch(const Probe& probe, std::uint32_t cell) const {
    if (!mayTouch(probe, _ratiosOf[cell])) return false;
    const Point from = _lattice.cells()[cell].low - probe.rest;
    const Point to = from.array() + _lattice.shape().edge;
    const double apart = kSpare * _sizes.apart;
    return from.cwiseAbs().cwiseMax(to.cwiseAbs()).squaredNorm() > apart * apart;
}

double FoldSkin::ratioIn(std::uint32_t cell, const Point& local) const {
    const auto shares = CellShape::values(local);
    double ratio = 0.0;
    for (std::size_t c = 0; c < CellShape::kCorners; ++c)
        ratio += shares[c] * _nodeRatios[_lattice.cells()[cell].nodes[c]];
    return ratio;
}

double FoldSkin::ratioOn(std::uint32_t triangle, const Point& shares) const {
    const auto& [a, b, c] = _patch.triangles()[triangle];
    const std::vector<double>& ratios = _patch.ratios();
    return shares[0] * ratios[a] + shares[1] * ratios[b] + shares[2] * ratios[c];
}

/// Nothing of the skin lies between a point and its nearest one, so the triangle's sides tell.
bool FoldSkin::isInside(const Point& rest, const RestSkin::Nearest& nearest,
                        const Point& there) const {
    const std::uint32_t triangle = _patch.triangleOf(nearest.triangle);
    if (triangle != SkinPatch::kNone && nearest.shares.minCoeff() > kOnEdge)
        if (const double height = _outwards[triangle].dot(rest - there); height != 0.0)
            return height < 0.0;
    return _skin.inside(rest);
}

} // namespace osgSkin::elastic
