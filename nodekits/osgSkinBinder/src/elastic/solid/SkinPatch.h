// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBINDER_ELASTIC_SOLID_SKINPATCH_H
#define OSGSKINBINDER_ELASTIC_SOLID_SKINPATCH_H

#include "elastic/solid/RestSkin.h"
#include "elastic/solid/VoxelLattice.h"

#include <Eigen/Geometry>

#include <vector>

namespace osgSkin::elastic {

/// The part of the skin that is embedded in a lattice. Const after construction.
class SkinPatch {
public:
    static constexpr std::uint32_t kNone = 0xffffffffu;

    /// \param ratios the joint's bend ratio at each vertex of the skin
    SkinPatch(const VoxelLattice& lattice, const RestSkin& skin, const std::vector<double>& ratios);

    /// Indices in the skin, ascending.
    const std::vector<std::uint32_t>& vertices() const { return _vertices; }
    const std::vector<Embedded>& embedded() const { return _embedded; }
    const std::vector<double>& ratios() const { return _ratios; }

    /// Triangles with all corners in the lattice; corners are indices in vertices().
    const RestSkin::Triangles& triangles() const { return _triangles; }

    /// The index in triangles() of a triangle of the skin; kNone if it is not there.
    std::uint32_t triangleOf(std::uint32_t ofSkin) const { return _triangleOf[ofSkin]; }

    /// Positions of vertices() for positions of the nodes.
    Points positions(const Points& nodes) const;

    /// Adds a gradient with respect to vertices() to that with respect to nodes.
    void spread(const Points& byVertex, Points& byNode) const;

    /// Area-weighted unit normals at vertices(), outwards; zero if not defined.
    Points normals(const Points& positions) const;

private:
    const VoxelLattice& _lattice;
    std::vector<std::uint32_t> _vertices;
    std::vector<Embedded> _embedded;
    std::vector<double> _ratios;
    RestSkin::Triangles _triangles;
    std::vector<std::uint32_t> _triangleOf;
    double _outwards = 1.0; ///< -1 if triangles face inwards
};

/// The joint's bend ratio at each node, 0 to 1: as harmonic as the skin's ratios allow.
Eigen::VectorXd ratioField(const VoxelLattice& lattice, const SkinPatch& patch);

/// Rotates each point about the joint by its ratio of a rotation.
Points turned(const Points& points, const Eigen::VectorXd& ratios, const Eigen::Quaterniond& by);

} // namespace osgSkin::elastic

#endif
