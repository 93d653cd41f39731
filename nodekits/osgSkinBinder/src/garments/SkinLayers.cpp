// SPDX-License-Identifier: GPL-3.0-or-later
#include "garments/SkinLayers.h"

#include "mesh/SkinSmoother.h"
#include "mesh/WeldedMesh.h"
#include "regions/BinaryField.h"
#include "regions/SpreadRegions.h"

#include <algorithm>

namespace osgSkin {
namespace {

/// A vertex with a larger hold than this takes the region below it.
constexpr double kMostly = 0.5;

/// The smoothing width, in the skin's size, for vertices that are not attached.
constexpr double kNoWidth = 1e-6;

} // namespace

SkinLayers::SkinLayers(const WeldedMesh& mesh, const std::vector<PlannedJoint>& joints,
                       const Regions& regions)
    : _mesh(mesh) {
    if (mesh.shells > 1)
        _attached = findAttached(mesh, regions, joints, limbRadii({mesh, joints, regions.jointOf}));
}

/// For each shell, whether it has an attached vertex with a larger hold than this.
std::vector<bool> SkinLayers::layers(double hold) const {
    std::vector<bool> isLayer(_mesh.shells);
    for (const Attached& a : _attached)
        if (a.hold > hold) isLayer[_mesh.shellOf[a.vertex]] = true;
    return isLayer;
}

/// The mesh without the shells that have no attached vertex.
WeldedMesh SkinLayers::layersAlone() const {
    WeldedMesh mesh = _mesh;
    const std::vector<bool> isLayer = layers(0.0);
    const auto isOther = [&](const auto& t) { return !isLayer[mesh.shellOf[t[0]]]; };
    mesh.triangles.erase(std::remove_if(mesh.triangles.begin(), mesh.triangles.end(), isOther),
                         mesh.triangles.end());
    listNeighbours(mesh.vertexCount(), edgesOf(mesh.triangles), mesh.firstNeighbour,
                   mesh.neighbours);
    return mesh;
}

void SkinLayers::follow(Regions& regions) const {
    const std::vector<bool> isLayer = layers(kMostly);
    if (std::find(isLayer.begin(), isLayer.end(), true) == isLayer.end()) return;
    const std::vector<std::uint32_t> alone = regions.jointOf;
    for (std::uint32_t v = 0; v < _mesh.vertexCount(); ++v)
        if (_mesh.shellOf[v] != WeldedMesh::kNoShell && isLayer[_mesh.shellOf[v]] &&
            regions.seedOf[v] == Regions::kNone)
            regions.jointOf[v] = Regions::kNone;
    for (const Attached& a : _attached) {
        if (!(a.hold > kMostly)) continue;
        const std::uint32_t corner = a.on.nearestCorner(), below = regions.jointOf[corner];
        regions.jointOf[a.vertex] = below != Regions::kNone ? below : alone[corner];
    }
    spreadRegions(_mesh, regions.jointOf);
    removeIslands(_mesh, std::vector<bool>(_mesh.vertexCount()), regions.jointOf);
}

template <typename Value>
void SkinLayers::blend(std::vector<Value>& field) const {
    for (const Attached& a : _attached) {
        Value below(0.0);
        for (int k = 0; k < 3; ++k)
            below += a.on.shares[k] * field[a.on.corners[static_cast<std::size_t>(k)]];
        field[a.vertex] += a.hold * (below - field[a.vertex]);
    }
}

void SkinLayers::follow(JointFields& bend, JointFields& twist) const {
    if (_attached.empty()) return;
    const SkinSmoother smoother(layersAlone());
    std::vector<double> widths(_mesh.vertexCount(), kNoWidth * _mesh.size);
    for (const Attached& a : _attached) widths[a.vertex] += a.gap;
    for (JointFields* fields : {&bend, &twist})
        for (std::size_t j = 0; j < fields->jointCount(); ++j) {
            if (fields->entries(j).empty()) continue;
            std::vector<double> field = fields->values(j);
            blend(field);
            std::vector<double> smooth = field;
            smoother.smooth(smooth, widths);
            for (const Attached& a : _attached) field[a.vertex] = smooth[a.vertex];
            fields->set(j, field);
        }
}

void SkinLayers::follow(std::vector<glm::dvec3>& moves) const {
    blend(moves);
}

} // namespace osgSkin
