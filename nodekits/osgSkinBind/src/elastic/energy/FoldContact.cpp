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

/// Touches that weigh less are forgotten.
constexpr double kLeastWeight = 0.01;

} // namespace

Point FoldContact::on(std::uint32_t triangle, const Point& shares, const Points& vertices) const {
    const auto& [a, b, c] = _skin.patch().triangles()[triangle];
    return shares[0] * vertices.col(a) + shares[1] * vertices.col(b) + shares[2] * vertices.col(c);
}

void FoldContact::restart() {
    _touches.clear();
    _detections = 0;
}

void FoldContact::detect(const Points& nodes) {
    const ContactSizes& sizes = _skin.sizes();
    const Points vertices = _skin.patch().positions(nodes);
    Flesh flesh{DeformedCells(_skin.lattice(), nodes), {}, _skin.patch().normals(vertices)};
    for (std::size_t bin = 0; bin < flesh.cells.bins(); ++bin) {
        FoldSkin::RatioSpan& span = flesh.ratios.emplace_back();
        flesh.cells.forEachIn(bin, [&](std::uint32_t cell) { span.extend(_skin.ratiosOf(cell)); });
    }
    ++_detections;
    const double share = _detections <= sizes.fresh
                             ? 1.0
                             : std::max(sizes.leastShare, 1.0 / (_detections - sizes.fresh + 1));
    for (Touch& touch : _touches) {
        touch.weight *= 1.0 - share;
        touch.stiffness *= 1.0 - share;
    }
    _touches.erase(std::remove_if(_touches.begin(), _touches.end(),
                                  [](const Touch& touch) { return touch.weight < kLeastWeight; }),
                   _touches.end());
    for (const Probe& probe : _skin.probes()) {
        const Point here = on(probe.triangle, probe.shares, vertices);
        const Point normal = on(probe.triangle, probe.shares, flesh.normals).normalized();
        Touch found;
        if (!look(probe, here, flesh, found) &&
            !look(probe, here + (sizes.gap + sizes.margin) * normal, flesh, found))
            continue;
        found.weight = share;
        found.stiffness = share * sizes.stiffness * probe.area;
        _touches.push_back(found);
    }
}

bool FoldContact::look(const Probe& probe, const Point& at, const Flesh& flesh,
                       Touch& result) const {
    const std::size_t bin = flesh.cells.binOf(at);
    if (bin == DeformedCells::kNoBin || !_skin.mayTouch(probe, flesh.ratios[bin])) return false;
    const ContactSizes& sizes = _skin.sizes();
    bool touches = false;
    const auto mayTouch = [&](std::uint32_t cell) { return _skin.mayTouch(probe, cell); };
    flesh.cells.find(bin, at, mayTouch, [&](std::uint32_t cell, const Point& local) {
        if (std::abs(_skin.ratioIn(cell, local) - probe.ratio) < sizes.sides) return false;
        const VoxelLattice& lattice = _skin.lattice();
        const Point rest = lattice.cells()[cell].low + lattice.shape().edge * local;
        if ((rest - probe.rest).norm() < sizes.apart) return false;
        touches = touch(probe, rest, flesh.normals, result);
        return touches;
    });
    return touches;
}

bool FoldContact::touch(const Probe& probe, const Point& rest, const Points& normals,
                        Touch& result) const {
    const ContactSizes& sizes = _skin.sizes();
    const std::optional<bool> inside = _skin.lattice().isInside(rest);
    if (inside && !*inside) return false;
    const RestSkin::Nearest nearest = _skin.skin().nearest(rest);
    const std::uint32_t triangle = _skin.patch().triangleOf(nearest.triangle);
    if (triangle == SkinPatch::kNone) return false;
    if (std::abs(_skin.ratioOn(triangle, nearest.shares) - probe.ratio) < sizes.sides) return false;
    const Point there = on(triangle, nearest.shares, _skin.restVertices());
    const double apart = ((there - probe.rest).norm() - sizes.apart) / sizes.ramp;
    if (apart <= 0.0) return false;
    const Point normal = on(triangle, nearest.shares, normals).normalized();
    const double facing =
        (kAcross - normal.dot(on(probe.triangle, probe.shares, normals).normalized())) /
        (kAcross - kFacing);
    if (facing <= 0.0) return false;
    if (!inside && !_skin.isInside(rest, nearest, there)) return false;
    const auto& own = _skin.patch().triangles()[probe.triangle];
    const auto& other = _skin.patch().triangles()[triangle];
    for (std::size_t k = 0; k < 3; ++k) {
        const auto corner = static_cast<Eigen::Index>(k);
        result.corners[k] = own[k];
        result.shares[k] = probe.shares[corner];
        result.corners[3 + k] = other[k];
        result.shares[3 + k] = -nearest.shares[corner];
    }
    result.normal = normal;
    // Both grow from nothing, so that nothing jumps where pairs come and go.
    result.gap = sizes.gap * std::min(apart, 1.0) * std::min(facing, 1.0);
    return true;
}

double FoldContact::value(const Points& nodes, Points& gradient) const {
    if (_touches.empty()) return 0.0;
    const SkinPatch& patch = _skin.patch();
    const Points vertices = patch.positions(nodes);
    Points byVertex = Points::Zero(3, vertices.cols());
    double energy = 0.0;
    for (const Touch& touch : _touches) {
        Point off = Point::Zero();
        for (std::size_t k = 0; k < 6; ++k) off += touch.shares[k] * vertices.col(touch.corners[k]);
        const double depth = touch.gap - touch.normal.dot(off);
        if (depth <= 0.0) continue;
        energy += 0.5 * touch.stiffness * depth * depth;
        const Point force = touch.stiffness * depth * touch.normal;
        for (std::size_t k = 0; k < 6; ++k)
            byVertex.col(touch.corners[k]) -= touch.shares[k] * force;
    }
    patch.spread(byVertex, gradient);
    return energy;
}

} // namespace osgSkin::elastic
