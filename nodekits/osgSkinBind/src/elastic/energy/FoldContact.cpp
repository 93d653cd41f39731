// SPDX-License-Identifier: GPL-3.0-or-later
#include "elastic/energy/FoldContact.h"

#include "elastic/lattice/DeformedCells.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <optional>

namespace osgSkin::elastic {
namespace {

/// The other side faces a probe where the product of their normals is below the first; below the
/// second it does so fully.
constexpr double kAcross = 0.3, kFacing = -0.5;

/// Points count as in a cell that are beyond its faces by rounding.
constexpr double kSpare = 0.999;

/// Touches that weigh less are forgotten.
constexpr double kLeastWeight = 0.01;

} // namespace

FoldContact::FoldContact(const VoxelLattice& lattice, const RestSkin& skin, const SkinPatch& patch,
                         const Eigen::VectorXd& nodeRatios, const ContactSizes& sizes)
    : _lattice(lattice), _skin(skin), _patch(patch), _sizes(sizes), _nodeRatios(nodeRatios) {
    for (const VoxelLattice::Cell& cell : lattice.cells()) {
        RatioSpan& span = _ratiosOf.emplace_back();
        for (const std::uint32_t node : cell.nodes) {
            span.low = std::min(span.low, nodeRatios[node]);
            span.high = std::max(span.high, nodeRatios[node]);
        }
    }
    const Points rest = patch.positions(lattice.rest());
    for (std::uint32_t t = 0; t < patch.triangles().size(); ++t) {
        const auto& [a, b, c] = patch.triangles()[t];
        const Point one = rest.col(b) - rest.col(a), other = rest.col(c) - rest.col(a);
        const double longest = std::max({one.norm(), other.norm(), (other - one).norm()});
        const int rows = std::max(1, static_cast<int>(std::ceil(longest / sizes.spacing)));
        // The centroids of the rows^2 small triangles that equal ones divide it into.
        const double area = 0.5 * one.cross(other).norm() / (rows * rows);
        for (int i = 0; i < rows; ++i)
            for (int j = 0; j < rows - i; ++j)
                for (const double shift : {1.0 / 3.0, 2.0 / 3.0}) {
                    const double u = (i + shift) / rows, v = (j + shift) / rows;
                    if (u + v > 1.0) continue;
                    const Point shares(1.0 - u - v, u, v);
                    _probes.push_back({t, shares, on(t, shares, rest), area, ratioAt(t, shares)});
                }
    }
}

double FoldContact::ratioAt(std::uint32_t triangle, const Point& shares) const {
    const auto& [a, b, c] = _patch.triangles()[triangle];
    const std::vector<double>& ratios = _patch.ratios();
    return shares[0] * ratios[a] + shares[1] * ratios[b] + shares[2] * ratios[c];
}

Point FoldContact::on(std::uint32_t triangle, const Point& shares, const Points& vertices) const {
    const auto& [a, b, c] = _patch.triangles()[triangle];
    return shares[0] * vertices.col(a) + shares[1] * vertices.col(b) + shares[2] * vertices.col(c);
}

void FoldContact::restart() {
    _touches.clear();
    _detections = 0;
}

void FoldContact::detect(const Points& nodes) {
    const DeformedCells cells(_lattice, nodes);
    const Points vertices = _patch.positions(nodes);
    const Points normals = _patch.normals(vertices);
    ++_detections;
    const double share = _detections <= _sizes.fresh
                             ? 1.0
                             : std::max(_sizes.leastShare, 1.0 / (_detections - _sizes.fresh + 1));
    for (Touch& touch : _touches) touch.weight *= 1.0 - share;
    _touches.erase(std::remove_if(_touches.begin(), _touches.end(),
                                  [](const Touch& touch) { return touch.weight < kLeastWeight; }),
                   _touches.end());
    for (std::uint32_t i = 0; i < _probes.size(); ++i) {
        const Probe& probe = _probes[i];
        const Point here = on(probe.triangle, probe.shares, vertices);
        const Point normal = on(probe.triangle, probe.shares, normals).normalized();
        Touch found;
        if (look(i, here, cells, normals, found) ||
            look(i, here + (_sizes.gap + _sizes.margin) * normal, cells, normals, found)) {
            found.weight = share;
            _touches.push_back(found);
        }
    }
}

bool FoldContact::look(std::uint32_t index, const Point& at, const DeformedCells& cells,
                       const Points& normals, Touch& result) const {
    const Probe& probe = _probes[index];
    bool touches = false;
    const auto mayTouch = [&](std::uint32_t cell) { return this->mayTouch(probe, cell); };
    cells.find(at, mayTouch, [&](std::uint32_t cell, const Point& local) {
        double ratio = 0.0;
        const auto shares = CellShape::values(local);
        for (std::size_t c = 0; c < 8; ++c)
            ratio += shares[c] * _nodeRatios[_lattice.cells()[cell].nodes[c]];
        if (std::abs(ratio - probe.ratio) < _sizes.sides) return false;
        const Point rest = _lattice.cells()[cell].low + _lattice.shape().edge * local;
        if ((rest - probe.rest).norm() < _sizes.apart) return false;
        const std::optional<bool> inside = _lattice.isInside(rest);
        if (inside && !*inside) return false;
        touches = touch(index, rest, normals, result) && (inside || _skin.inside(rest));
        return touches;
    });
    return touches;
}

bool FoldContact::mayTouch(const Probe& probe, std::uint32_t cell) const {
    const auto& [low, high] = _ratiosOf[cell];
    if (std::max(high - probe.ratio, probe.ratio - low) < kSpare * _sizes.sides) return false;
    const Point from = _lattice.cells()[cell].low - probe.rest;
    const Point to = from.array() + _lattice.shape().edge;
    return from.cwiseAbs().cwiseMax(to.cwiseAbs()).norm() > kSpare * _sizes.apart;
}

bool FoldContact::touch(std::uint32_t index, const Point& rest, const Points& normals,
                        Touch& result) const {
    const Probe& probe = _probes[index];
    const RestSkin::Nearest nearest = _skin.nearest(rest);
    const std::uint32_t triangle = _patch.triangleOf(nearest.triangle);
    if (triangle == SkinPatch::kNone) return false;
    if (std::abs(ratioAt(triangle, nearest.shares) - probe.ratio) < _sizes.sides) return false;
    const Point normal = on(triangle, nearest.shares, normals).normalized();
    const double facing =
        (kAcross - normal.dot(on(probe.triangle, probe.shares, normals).normalized())) /
        (kAcross - kFacing);
    const auto& [a, b, c] = _skin.triangles()[nearest.triangle];
    const Points& skin = _skin.positions();
    const Point there = nearest.shares[0] * skin.col(a) + nearest.shares[1] * skin.col(b) +
                        nearest.shares[2] * skin.col(c);
    const double apart = ((there - probe.rest).norm() - _sizes.apart) / _sizes.ramp;
    if (apart <= 0.0 || facing <= 0.0) return false;
    // Both grow from nothing, so that nothing jumps where pairs come and go.
    const double gap = _sizes.gap * std::min(apart, 1.0) * std::min(facing, 1.0);
    result = {index, triangle, nearest.shares, normal, gap, 1.0};
    return true;
}

double FoldContact::value(const Points& nodes, Points& gradient) const {
    if (_touches.empty()) return 0.0;
    const Points vertices = _patch.positions(nodes);
    Points byVertex = Points::Zero(3, vertices.cols());
    double energy = 0.0;
    for (const Touch& touch : _touches) {
        const Probe& probe = _probes[touch.probe];
        const Point off =
            on(probe.triangle, probe.shares, vertices) - on(touch.triangle, touch.shares, vertices);
        const double depth = touch.gap - touch.normal.dot(off);
        if (depth <= 0.0) continue;
        const double stiffness = touch.weight * _sizes.stiffness * probe.area;
        energy += 0.5 * stiffness * depth * depth;
        const Point force = stiffness * depth * touch.normal;
        for (std::size_t k = 0; k < 3; ++k) {
            const auto corner = static_cast<Eigen::Index>(k);
            byVertex.col(_patch.triangles()[probe.triangle][k]) -= probe.shares[corner] * force;
            byVertex.col(_patch.triangles()[touch.triangle][k]) += touch.shares[corner] * force;
        }
    }
    _patch.spread(byVertex, gradient);
    return energy;
}

} // namespace osgSkin::elastic
