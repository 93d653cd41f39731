// SPDX-License-Identifier: GPL-3.0-or-later
#include "elastic/solid/FoldContact.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <optional>

namespace osgSkin::elastic {
namespace {

constexpr double kBinEdges = 1.0; ///< a bin's size in cells' edges
constexpr int kNewtonSteps = 6;
constexpr double kWithin = 1e-6;

/// Points that come farther from a cell's centre, in edges, are not in the cell: in any Newton
/// step, and in the first.
constexpr double kFar = 3.5, kFirstFar = 1.2;

/// Boxes of cells are wider than the cells, so that rounding loses no point.
constexpr float kRoom = 1e-5f;

/// Tolerance for rounding: a conservative test comes before the exact one.
constexpr double kSpare = 0.999;

/// How far from a triangle its two sides are tested, in radii.
constexpr double kBeside = 2e-3;

/// A nearest point with a smaller share is on an edge of its triangle; the normal does not show the
/// side there.
constexpr double kOnEdge = 1e-6;

/// The other side begins to face a probe where the dot product of their normals is below the first,
/// and faces it fully below the second.
constexpr double kAcross = 0.3, kFacing = -0.5;

} // namespace

DeformedCells::DeformedCells(const VoxelLattice& lattice, const Points& nodes)
    : _binSize(kBinEdges * lattice.shape().edge) {
    std::vector<Eigen::AlignedBox3d> boxes;
    boxes.reserve(lattice.cells().size());
    _maps.reserve(lattice.cells().size());
    for (const VoxelLattice::Cell& cell : lattice.cells()) {
        Eigen::AlignedBox3d& box = boxes.emplace_back();
        for (const std::uint32_t node : cell.nodes) box.extend(nodes.col(node));
        _bounds.extend(box);
        const auto corner = [&](std::size_t c) { return nodes.col(cell.nodes[c]); };
        Map& map = _maps.emplace_back();
        map.at = corner(0);
        map.x = corner(1) - corner(0);
        map.y = corner(2) - corner(0);
        map.z = corner(4) - corner(0);
        map.xy = corner(3) - corner(2) - map.x;
        map.yz = corner(6) - corner(4) - map.y;
        map.zx = corner(5) - corner(4) - map.x;
        map.xyz = corner(7) - corner(6) - corner(5) + corner(4) - map.xy;
    }
    _bins = (_bounds.sizes() / _binSize).array().floor().cast<int>() + 1;
    _first.assign(index(_bins - Eigen::Vector3i::Ones()) + 2, 0);
    const auto forEachBin = [&](const auto& visit) {
        for (std::uint32_t cell = 0; cell < boxes.size(); ++cell)
            anyBin(boxes[cell], [&](std::size_t bin) {
                visit(bin, cell);
                return false;
            });
    };
    forEachBin([this](std::size_t bin, std::uint32_t) { ++_first[bin + 1]; });
    for (std::size_t bin = 1; bin < _first.size(); ++bin) _first[bin] += _first[bin - 1];
    _entries.resize(_first.back());
    std::vector<std::uint32_t> next(_first.begin(), _first.end() - 1);
    forEachBin([&](std::size_t bin, std::uint32_t cell) {
        Entry& entry = _entries[next[bin]++];
        entry.cell = cell;
        for (std::size_t k = 0; k < 3; ++k) {
            const auto axis = static_cast<Eigen::Index>(k);
            entry.low[k] = static_cast<float>(boxes[cell].min()[axis]) - kRoom;
            entry.high[k] = static_cast<float>(boxes[cell].max()[axis]) + kRoom;
        }
    });
}

Eigen::Vector3i DeformedCells::binAt(const Point& point) const {
    const Eigen::Vector3i bin = ((point - _bounds.min()) / _binSize).array().floor().cast<int>();
    return bin.cwiseMax(0).cwiseMin(_bins - Eigen::Vector3i::Ones());
}

std::size_t DeformedCells::index(const Eigen::Vector3i& bin) const {
    const auto at = bin.cast<std::size_t>(), bins = _bins.cast<std::size_t>();
    return (at.z() * bins.y() + at.y()) * bins.x() + at.x();
}

/// Newton's method on the trilinear map.
bool DeformedCells::locate(std::uint32_t index, const Point& point, Point& local) const {
    const Map& map = _maps[index];
    const Point target = point - map.at;
    local.setConstant(0.5);
    for (int step = 0; step < kNewtonSteps; ++step) {
        const double x = local.x(), y = local.y(), z = local.z();
        const Point byZ = map.z + x * map.zx + y * map.yz + x * y * map.xyz;
        const Point byX = map.x + y * map.xy + z * (map.zx + y * map.xyz);
        const Point byY = map.y + x * map.xy + z * (map.yz + x * map.xyz);
        const Point left = target - x * map.x - y * (map.y + x * map.xy) - z * byZ;
        // Cramer's rule.
        const Point across = byY.cross(byZ);
        const double scale = 1.0 / byX.dot(across);
        const Point change(scale * left.dot(across), scale * left.dot(byZ.cross(byX)),
                           scale * left.dot(byX.cross(byY)));
        local += change;
        const double off = (local.array() - 0.5).abs().maxCoeff();
        if (!(off < (step == 0 ? kFirstFar : kFar))) return false;
        if (change.cwiseAbs().maxCoeff() < 0.1 * kWithin) break;
    }
    return local.minCoeff() >= -kWithin && local.maxCoeff() <= 1.0 + kWithin;
}

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
        std::vector<Probe>& probes = _probes.emplace_back();
        const Point one = _rest.col(b) - _rest.col(a), other = _rest.col(c) - _rest.col(a);
        const double longest = std::max({one.norm(), other.norm(), (other - one).norm()});
        const int rows = std::max(1, static_cast<int>(std::ceil(longest / _sizes.spacing)));
        // The centroids of rows^2 equal small triangles.
        const double area = 0.5 * one.cross(other).norm() / (rows * rows);
        for (int i = 0; i < rows; ++i)
            for (int j = 0; j < rows - i; ++j)
                for (const double shift : {1.0 / 3.0, 2.0 / 3.0}) {
                    const double u = (i + shift) / rows, v = (j + shift) / rows;
                    if (u + v > 1.0) continue;
                    const Point shares(1.0 - u - v, u, v);
                    const Point at = u * one + v * other + _rest.col(a);
                    probes.push_back({shares, at, area, ratioOn(t, shares)});
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

bool FoldSkin::mayTouch(const RatioSpan& skin, const RatioSpan& flesh) const {
    return std::max(flesh.high - skin.low, skin.high - flesh.low) >= kSpare * _sizes.sides;
}

bool FoldSkin::mayTouch(const Probe& probe, std::uint32_t cell) const {
    if (!mayTouch({probe.ratio, probe.ratio}, _ratiosOf[cell])) return false;
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

/// The skin has no other point between this one and the nearest, so the triangle's side decides.
bool FoldSkin::isInside(const Point& rest, const RestSkin::Nearest& nearest,
                        const Point& there) const {
    const std::uint32_t triangle = _patch.triangleOf(nearest.triangle);
    if (triangle != SkinPatch::kNone && nearest.shares.minCoeff() > kOnEdge)
        if (const double height = _outwards[triangle].dot(rest - there); height != 0.0)
            return height < 0.0;
    return _skin.inside(rest);
}

Point FoldContact::on(std::uint32_t triangle, const Point& shares, const Points& vertices) const {
    const auto& [a, b, c] = _skin.patch().triangles()[triangle];
    return shares[0] * vertices.col(a) + shares[1] * vertices.col(b) + shares[2] * vertices.col(c);
}

void FoldContact::detect(const Points& nodes) {
    Flesh flesh{DeformedCells(_skin.lattice(), nodes), {}, _skin.patch().positions(nodes), {}};
    flesh.normals = _skin.patch().normals(flesh.vertices);
    for (std::size_t bin = 0; bin < flesh.cells.bins(); ++bin) {
        FoldSkin::RatioSpan& span = flesh.ratios.emplace_back();
        flesh.cells.forEachIn(bin, [&](std::uint32_t cell) { span.extend(_skin.ratiosOf(cell)); });
    }
    _touches.clear();
    for (std::uint32_t t = 0; t < _skin.probes().size(); ++t)
        if (mayTouch(t, flesh))
            for (const Probe& each : _skin.probes()[t]) probe(t, each, flesh);
}

/// Whether flesh of the other side is near a triangle.
bool FoldContact::mayTouch(std::uint32_t triangle, const Flesh& flesh) const {
    const double ahead = _skin.sizes().gap + _skin.sizes().margin;
    Eigen::AlignedBox3d box;
    FoldSkin::RatioSpan own;
    for (const std::uint32_t corner : _skin.patch().triangles()[triangle]) {
        box.extend(flesh.vertices.col(corner));
        box.extend(flesh.vertices.col(corner) + ahead * flesh.normals.col(corner));
        const double ratio = _skin.patch().ratios()[corner];
        own.extend({ratio, ratio});
    }
    return flesh.cells.anyBin(
        box, [&](std::size_t bin) { return _skin.mayTouch(own, flesh.ratios[bin]); });
}

void FoldContact::probe(std::uint32_t triangle, const Probe& probe, const Flesh& flesh) {
    const ContactSizes& sizes = _skin.sizes();
    const Point here = on(triangle, probe.shares, flesh.vertices);
    const Point normal = on(triangle, probe.shares, flesh.normals).normalized();
    Touch found;
    if (!look(triangle, probe, here, normal, flesh, found) &&
        !look(triangle, probe, here + (sizes.gap + sizes.margin) * normal, normal, flesh, found))
        return;
    found.stiffness = sizes.stiffness * probe.area;
    _touches.push_back(found);
}

bool FoldContact::look(std::uint32_t triangle, const Probe& probe, const Point& at,
                       const Point& normal, const Flesh& flesh, Touch& result) const {
    const std::size_t bin = flesh.cells.binOf(at);
    if (bin == DeformedCells::kNoBin ||
        !_skin.mayTouch({probe.ratio, probe.ratio}, flesh.ratios[bin]))
        return false;
    const ContactSizes& sizes = _skin.sizes();
    bool touches = false;
    const auto mayTouch = [&](std::uint32_t cell) { return _skin.mayTouch(probe, cell); };
    flesh.cells.find(bin, at, mayTouch, [&](std::uint32_t cell, const Point& local) {
        if (std::abs(_skin.ratioIn(cell, local) - probe.ratio) < sizes.sides) return false;
        const VoxelLattice& lattice = _skin.lattice();
        const Point rest = lattice.cells()[cell].low + lattice.shape().edge * local;
        if ((rest - probe.rest).norm() < sizes.apart) return false;
        touches = touch(triangle, probe, rest, normal, flesh, result);
        return touches;
    });
    return touches;
}

/// \param facing the probe's normal
bool FoldContact::touch(std::uint32_t own, const Probe& probe, const Point& rest,
                        const Point& facing, const Flesh& flesh, Touch& result) const {
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
    const Point normal = on(triangle, nearest.shares, flesh.normals).normalized();
    const double opposite = (kAcross - normal.dot(facing)) / (kAcross - kFacing);
    if (opposite <= 0.0) return false;
    if (!inside && !_skin.isInside(rest, nearest, there)) return false;
    const auto& corners = _skin.patch().triangles()[own];
    const auto& other = _skin.patch().triangles()[triangle];
    for (std::size_t k = 0; k < 3; ++k) {
        const auto corner = static_cast<Eigen::Index>(k);
        result.corners[k] = corners[k];
        result.shares[k] = probe.shares[corner];
        result.corners[3 + k] = other[k];
        result.shares[3 + k] = -nearest.shares[corner];
    }
    result.normal = normal;
    // Both factors grow from 0, so that the gap does not jump as pairs appear and disappear.
    result.gap = sizes.gap * std::min(apart, 1.0) * std::min(opposite, 1.0);
    return true;
}

double FoldContact::value(const Points& vertices, Points& gradient) const {
    double energy = 0.0;
    for (const Touch& touch : _touches) {
        Point off = Point::Zero();
        for (std::size_t k = 0; k < 6; ++k) off += touch.shares[k] * vertices.col(touch.corners[k]);
        const double depth = touch.gap - touch.normal.dot(off);
        if (depth <= 0.0) continue;
        energy += 0.5 * touch.stiffness * depth * depth;
        const Point force = touch.stiffness * depth * touch.normal;
        for (std::size_t k = 0; k < 6; ++k)
            gradient.col(touch.corners[k]) -= touch.shares[k] * force;
    }
    return energy;
}

} // namespace osgSkin::elastic
