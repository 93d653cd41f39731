// SPDX-License-Identifier: GPL-3.0-or-later
#include "elastic/energy/BoneCores.h"

#include <limits>

namespace osgSkin::elastic {

BoneCores::BoneCores(const VoxelLattice& lattice, const RestSkin& skin,
                     const std::vector<Bone>& bones, const HingeCore* hinge, const CoreSizes& sizes)
    : _lattice(lattice) {
    const double stiffness = sizes.stiffness * lattice.shape().volumeOfPoint();
    for (std::uint32_t i = 0; i < lattice.cells().size(); ++i) {
        const VoxelLattice::Cell& cell = lattice.cells()[i];
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
            if (nearest * (1.0 - sizes.thickness) < sizes.thickness * skin.distance(at))
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

} // namespace osgSkin::elastic
