// SPDX-License-Identifier: GPL-3.0-or-later
#include "elastic/energy/BoneCores.h"

#include <algorithm>
#include <array>
#include <limits>

namespace osgSkin::elastic {
namespace {

double distanceTo(const Bone& bone, const Point& p) {
    const Point along = bone.to - bone.from;
    const double square = along.squaredNorm();
    const double t = square > 0.0 ? std::clamp((p - bone.from).dot(along) / square, 0.0, 1.0) : 0.0;
    return (bone.from + t * along - p).norm();
}

} // namespace

BoneCores::BoneCores(const VoxelLattice& lattice, const RestSkin& skin,
                     const std::vector<Bone>& bones, const HingeCore* hinge, const CoreSizes& sizes)
    : _lattice(lattice) {
    const double stiffness = sizes.stiffness * lattice.shape().volumeOfPoint();
    for (std::uint32_t i = 0; i < lattice.cells().size(); ++i) {
        const VoxelLattice::Cell& cell = lattice.cells()[i];
        for (std::uint32_t g = 0; g < CellShape::kPoints; ++g) {
            const Point at = lattice.gaussPoint(cell, g);
            if (hinge && (at - hinge->centre).norm() < hinge->radius) {
                _held.push_back({i, g, at, stiffness, 0.5});
                continue;
            }
            if (at.norm() < sizes.endsBefore) continue;
            double nearest = std::numeric_limits<double>::infinity();
            bool moves = false;
            for (const Bone& bone : bones) {
                const double away = distanceTo(bone, at);
                if (away >= nearest) continue;
                nearest = away;
                moves = bone.moves;
            }
            if (nearest * (1.0 - sizes.thickness) < sizes.thickness * skin.distance(at))
                _held.push_back({i, g, at, stiffness, moves ? 1.0 : 0.0});
        }
    }
}

double BoneCores::value(const Points& nodes, const Eigen::Quaterniond& turn,
                        Points& gradient) const {
    const Eigen::Quaterniond unit = Eigen::Quaterniond::Identity();
    const std::array<Eigen::Matrix3d, 3> turns{
        unit.toRotationMatrix(), unit.slerp(0.5, turn).toRotationMatrix(), turn.toRotationMatrix()};
    double energy = 0.0;
    for (const Held& held : _held) {
        const VoxelLattice::Cell& cell = _lattice.cells()[held.cell];
        const auto& shares = _lattice.shape().value;
        Point off = -(turns[static_cast<std::size_t>(2.0 * held.share)] * held.rest);
        for (std::size_t c = 0; c < 8; ++c) off += shares[c][held.point] * nodes.col(cell.nodes[c]);
        energy += 0.5 * held.stiffness * off.squaredNorm();
        for (std::size_t c = 0; c < 8; ++c)
            gradient.col(cell.nodes[c]) += held.stiffness * shares[c][held.point] * off;
    }
    return energy;
}

} // namespace osgSkin::elastic
