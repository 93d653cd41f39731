// SPDX-License-Identifier: GPL-3.0-or-later
#include "elastic/solid/Energies.h"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <limits>

namespace osgSkin::elastic {
namespace {

constexpr double kSkinWithin = 2.0; ///< largest distance of the outer side's skin

Point outwardsOf(const std::vector<Bone>& bones, const std::vector<Eigen::Quaterniond>& rotations,
                 Point& across) {
    Point flexion = Point::Zero(), along = Point::Zero();
    for (const Eigen::Quaterniond& q : rotations)
        flexion += q.w() < 0.0 ? Point(-q.vec()) : Point(q.vec());
    for (const Bone& bone : bones)
        if (bone.moves && bone.from.norm() < kAtCentre && bone.to.norm() > along.norm())
            along = bone.to;
    Point outwards = along.cross(flexion); // a flexion moves the bone the other way
    if (!(outwards.norm() > 0.0)) return outwards;
    across = outwards.cross(flexion).normalized();
    if (across.dot(along) < 0.0) across = -across;
    return outwards.normalized();
}

double smooth(double from, double to, double at) {
    const double t = std::clamp((at - from) / (to - from), 0.0, 1.0);
    return t * t * (3.0 - 2.0 * t);
}

/// The vector from the nearest point of the bones.
Point offBones(const std::vector<Bone>& bones, const Point& p) {
    Point nearest = Point::Constant(std::numeric_limits<double>::infinity());
    for (const Bone& bone : bones) {
        const Point off = p - nearestOn(bone, p);
        if (!(off.squaredNorm() >= nearest.squaredNorm())) nearest = off;
    }
    return nearest;
}

} // namespace

HingeCore hingeCore(const Points& skin, const std::vector<Bone>& bones,
                    const std::vector<Eigen::Quaterniond>& rotations, const HingeSizes& sizes) {
    HingeCore core{Point::Zero(), sizes.radius, Point::Zero(), sizes.halfWidth, Point::Zero()};
    const Point outwards = core.outwards = outwardsOf(bones, rotations, core.along);
    double nearest = std::numeric_limits<double>::infinity();
    for (Eigen::Index v = 0; v < skin.cols(); ++v) {
        const double height = outwards.dot(skin.col(v));
        const double beside = (skin.col(v) - height * outwards).norm();
        if (height <= 0.0 || skin.col(v).norm() > kSkinWithin || beside >= nearest) continue;
        nearest = beside;
        core.centre = (height - sizes.below - sizes.radius) * outwards;
    }
    return core;
}

BoneCores::BoneCores(const VoxelLattice& lattice, const RestSkin& skin,
                     const std::vector<Bone>& bones, const HingeCore* hinge, const CoreSizes& sizes)
    : _lattice(lattice) {
    const double stiffness = sizes.stiffness * lattice.shape().volumeOfPoint();
    for (std::uint32_t i = 0; i < lattice.cells().size(); ++i) {
        const VoxelLattice::Cell& cell = lattice.cells()[i];
        const Point middle = cell.low + Point::Constant(0.5 * lattice.shape().edge);
        const double deep = skin.distance(middle) + lattice.shape().edge;
        for (std::uint32_t g = 0; g < CellShape::kPoints; ++g) {
            const Point at = lattice.gaussPoint(cell, g);
            if (hinge && hinge->contains(at)) {
                _held.push_back({i, g, at, stiffness, hinge->shareAt(at)});
                continue;
            }
            if (at.norm() < sizes.endsBefore) continue;
            double nearest = std::numeric_limits<double>::infinity();
            bool moves = false;
            for (const Bone& bone : bones) {
                const double away = (nearestOn(bone, at) - at).norm();
                if (away >= nearest) continue;
                nearest = away;
                moves = bone.moves;
            }
            // No point of the cell is deeper than `deep`.
            const double share = nearest * (1.0 - sizes.thickness) / sizes.thickness;
            if (share < deep && share < skin.distance(at))
                _held.push_back({i, g, at, stiffness, moves ? 1.0 : 0.0});
        }
    }
}

Points BoneCores::goals(const Eigen::Quaterniond& turn) const {
    const Eigen::Quaterniond unit = Eigen::Quaterniond::Identity();
    Points goals(3, static_cast<Eigen::Index>(_held.size()));
    for (std::size_t i = 0; i < _held.size(); ++i)
        goals.col(static_cast<Eigen::Index>(i)) = unit.slerp(_held[i].share, turn) * _held[i].rest;
    return goals;
}

double BoneCores::value(const Points& nodes, const Points& goals, Points& gradient) const {
    double energy = 0.0;
    for (std::size_t i = 0; i < _held.size(); ++i) {
        const Held& held = _held[i];
        const VoxelLattice::Cell& cell = _lattice.cells()[held.cell];
        const auto& shares = _lattice.shape().value;
        Point off = -goals.col(static_cast<Eigen::Index>(i));
        for (std::size_t c = 0; c < 8; ++c) off += shares[c][held.point] * nodes.col(cell.nodes[c]);
        energy += 0.5 * held.stiffness * off.squaredNorm();
        for (std::size_t c = 0; c < 8; ++c)
            gradient.col(cell.nodes[c]) += held.stiffness * shares[c][held.point] * off;
    }
    return energy;
}

double ElasticBody::value(const Points& nodes, Points& gradient) const {
    const std::vector<VoxelLattice::Cell>& cells = _lattice.cells();
    double energy = 0.0;
    CellBatch batch;
    for (std::size_t begin = 0; begin < cells.size(); begin += CellBatch::kCells) {
        const std::size_t count = std::min(CellBatch::kCells, cells.size() - begin);
        for (std::size_t lane = 0; lane < CellBatch::kCells; ++lane) {
            const auto& of = cells[begin + std::min(lane, count - 1)].nodes;
            const double* first = nodes.data() + std::size_t{3} * of[0];
            for (std::size_t c = 0; c < CellShape::kCorners; ++c) {
                const double* node = nodes.data() + std::size_t{3} * of[c];
                for (std::size_t i = 0; i < 3; ++i)
                    batch.corner[i][c][lane] = static_cast<float>(node[i] - first[i]);
            }
        }
        if (!cellEnergies(_lattice.shape(), _flesh, batch))
            return std::numeric_limits<double>::infinity();
        for (std::size_t lane = 0; lane < count; ++lane) {
            energy += batch.energy[lane];
            const auto& of = cells[begin + lane].nodes;
            for (std::size_t c = 0; c < CellShape::kCorners; ++c) {
                double* node = gradient.data() + std::size_t{3} * of[c];
                for (std::size_t i = 0; i < 3; ++i) node[i] += batch.gradient[i][c][lane];
            }
        }
    }
    return energy;
}

ElasticBody::Volumes ElasticBody::volumes(const Points& nodes) const {
    Volumes result;
    result.least = std::numeric_limits<double>::infinity();
    for (const VoxelLattice::Cell& cell : _lattice.cells()) {
        Eigen::Matrix<double, 3, 8> corners;
        for (std::size_t c = 0; c < 8; ++c)
            corners.col(static_cast<Eigen::Index>(c)) = nodes.col(cell.nodes[c]);
        for (std::size_t g = 0; g < CellShape::kPoints; ++g) {
            const Eigen::Matrix3d slope = corners *
                                          CellShape::slopes(CellShape::local(g)).transpose() /
                                          _lattice.shape().edge;
            const double jacobian = slope.determinant();
            result.least = std::min(result.least, jacobian);
            result.whole += jacobian;
        }
    }
    result.whole /= static_cast<double>(CellShape::kPoints * _lattice.cells().size());
    return result;
}

Fascia::Fascia(const VoxelLattice& lattice, double stiffness)
    : _stiffness(Eigen::VectorXd::Zero(lattice.rest().cols())) {
    // A cell has as many Gauss points as corners.
    for (const VoxelLattice::Cell& cell : lattice.cells())
        for (const std::uint32_t node : cell.nodes)
            _stiffness[node] += stiffness * lattice.shape().volumeOfPoint();
}

double Fascia::value(const Points& nodes, const Points& goals, Points& gradient) const {
    double energy = 0.0;
    for (Eigen::Index i = 0; i < nodes.cols(); ++i) {
        const Point off = nodes.col(i) - goals.col(i);
        energy += 0.5 * _stiffness[i] * off.squaredNorm();
        gradient.col(i) += _stiffness[i] * off;
    }
    return energy;
}

OuterSkin::OuterSkin(const SkinPatch& patch, const Points& skin, const std::vector<Bone>& bones,
                     const HingeCore* hinge, const OuterSizes& sizes)
    : _sizes(sizes), _bones(bones) {
    if (!hinge || !(hinge->outwards.norm() > 0.0) || bones.empty()) return;
    std::vector<double> areas(patch.vertices().size(), 0.0);
    for (const auto& triangle : patch.triangles()) {
        const auto corner = [&](std::size_t i) { return skin.col(patch.vertices()[triangle[i]]); };
        const double area =
            0.5 * Point(corner(1) - corner(0)).cross(Point(corner(2) - corner(0))).norm();
        for (const std::uint32_t v : triangle) areas[v] += area / 3.0;
    }
    for (std::size_t v = 0; v < areas.size(); ++v) {
        const Point p = skin.col(patch.vertices()[v]);
        const double along = hinge->along.dot(p);
        const Point across = p - along * hinge->along;
        const double share =
            smooth(sizes.from, sizes.whole, hinge->outwards.dot(across.normalized())) *
            (1.0 - smooth(sizes.reach, sizes.end, std::abs(along)));
        const double distance = offBones(bones, p).norm();
        if (share * areas[v] * distance > 0.0)
            _held.push_back({v, distance, sizes.stiffness * share * areas[v]});
    }
}

std::vector<Bone> OuterSkin::posed(const Eigen::Quaterniond& turn) const {
    std::vector<Bone> bones = _bones;
    for (Bone& bone : bones)
        if (bone.moves) bone = {turn * bone.from, turn * bone.to, true};
    return bones;
}

double OuterSkin::value(const Points& skin, const std::vector<Bone>& posed,
                        Points& gradient) const {
    double energy = 0.0;
    for (const Held& held : _held) {
        const auto column = static_cast<Eigen::Index>(held.vertex);
        const Point off = offBones(posed, skin.col(column));
        const double distance = off.norm();
        const double tooFar = distance - std::clamp(distance, _sizes.least * held.distance,
                                                    _sizes.most * held.distance);
        if (tooFar == 0.0 || !(distance > 0.0)) continue;
        energy += 0.5 * held.stiffness * tooFar * tooFar;
        gradient.col(column) += held.stiffness * tooFar / distance * off;
    }
    return energy;
}

} // namespace osgSkin::elastic
