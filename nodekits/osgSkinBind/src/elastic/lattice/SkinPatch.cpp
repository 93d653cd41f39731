// SPDX-License-Identifier: GPL-3.0-or-later
#include "elastic/lattice/SkinPatch.h"

#include <Eigen/Geometry>

namespace osgSkin::elastic {

SkinPatch::SkinPatch(const VoxelLattice& lattice, const RestSkin& skin,
                     const std::vector<double>& ratios)
    : _lattice(lattice), _triangleOf(skin.triangles().size(), kNone) {
    const Points& all = skin.positions();
    std::vector<bool> used(ratios.size(), false);
    for (const auto& triangle : skin.triangles())
        for (const std::uint32_t corner : triangle) used[corner] = true;
    std::vector<std::uint32_t> local(ratios.size(), kNone);
    for (std::uint32_t v = 0; v < ratios.size(); ++v) {
        Embedded embedded;
        if (!used[v] || !lattice.embed(all.col(v), embedded)) continue;
        local[v] = static_cast<std::uint32_t>(_vertices.size());
        _vertices.push_back(v);
        _embedded.push_back(embedded);
        _ratios.push_back(ratios[v]);
    }
    double volume = 0.0; // of the tetrahedra to the joint: its sign is the winding's
    for (std::uint32_t t = 0; t < skin.triangles().size(); ++t) {
        const auto& [a, b, c] = skin.triangles()[t];
        volume += all.col(a).dot(all.col(b).cross(all.col(c)));
        if (local[a] == kNone || local[b] == kNone || local[c] == kNone) continue;
        _triangleOf[t] = static_cast<std::uint32_t>(_triangles.size());
        _triangles.push_back({local[a], local[b], local[c]});
    }
    _outwards = volume < 0.0 ? -1.0 : 1.0;
}

Points SkinPatch::positions(const Points& nodes) const {
    Points result(3, static_cast<Eigen::Index>(_vertices.size()));
    for (std::size_t v = 0; v < _vertices.size(); ++v)
        result.col(static_cast<Eigen::Index>(v)) = _lattice.positionOf(_embedded[v], nodes);
    return result;
}

void SkinPatch::spread(const Points& byVertex, Points& byNode) const {
    for (std::size_t v = 0; v < _vertices.size(); ++v) {
        const auto here = byVertex.col(static_cast<Eigen::Index>(v));
        if (here.isZero(0.0)) continue;
        const VoxelLattice::Cell& cell = _lattice.cells()[_embedded[v].cell];
        for (std::size_t c = 0; c < 8; ++c)
            byNode.col(cell.nodes[c]) += _embedded[v].weights[c] * here;
    }
}

Points SkinPatch::normals(const Points& positions) const {
    Points result = Points::Zero(3, positions.cols());
    for (const auto& [a, b, c] : _triangles) {
        const Point one = positions.col(b) - positions.col(a);
        const Point other = positions.col(c) - positions.col(a);
        const Point area = _outwards * one.cross(other);
        for (const std::uint32_t corner : {a, b, c}) result.col(corner) += area;
    }
    for (Eigen::Index v = 0; v < result.cols(); ++v)
        if (const double length = result.col(v).norm(); length > 0.0) result.col(v) /= length;
    return result;
}

} // namespace osgSkin::elastic
