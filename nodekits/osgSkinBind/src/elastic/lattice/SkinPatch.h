// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_ELASTIC_SKINPATCH_H
#define OSGSKINBIND_ELASTIC_SKINPATCH_H

#include "elastic/lattice/VoxelLattice.h"
#include "elastic/skin/RestSkin.h"

#include <vector>

namespace osgSkin::elastic {

/// The part of the skin that a lattice carries. Const after construction.
class SkinPatch {
public:
    static constexpr std::uint32_t kNone = 0xffffffffu;

    /// \param ratios the joint's bend ratio at each vertex of the skin
    SkinPatch(const VoxelLattice& lattice, const RestSkin& skin, const std::vector<double>& ratios);

    /// Indices in the skin, rising.
    const std::vector<std::uint32_t>& vertices() const { return _vertices; }
    const std::vector<Embedded>& embedded() const { return _embedded; }
    const std::vector<double>& ratios() const { return _ratios; }

    /// Those whose three corners the lattice carries; corners are indices in vertices().
    const RestSkin::Triangles& triangles() const { return _triangles; }

    /// The patch's triangle for one of the skin, kNone where it is not carried.
    std::uint32_t triangleOf(std::uint32_t ofSkin) const { return _triangleOf[ofSkin]; }

    /// Positions of vertices() for the nodes'.
    Points positions(const Points& nodes) const;

    /// Adds the nodes' share of a gradient by vertices().
    void spread(const Points& byVertex, Points& byNode) const;

    /// Area-weighted unit normals at vertices(), outwards; zero where there is none.
    Points normals(const Points& positions) const;

private:
    const VoxelLattice& _lattice;
    std::vector<std::uint32_t> _vertices;
    std::vector<Embedded> _embedded;
    std::vector<double> _ratios;
    RestSkin::Triangles _triangles;
    std::vector<std::uint32_t> _triangleOf;
    double _outwards = 1.0; ///< -1 where triangles wind the other way
};

} // namespace osgSkin::elastic

#endif
