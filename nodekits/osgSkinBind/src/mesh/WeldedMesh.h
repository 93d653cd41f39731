// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef OSGSKINBIND_WELDEDMESH_H
#define OSGSKINBIND_WELDEDMESH_H

#include <osgSkinRig/SkinMesh>

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace osgSkin {

/// The skin as binding sees it: vertices that share a position are one, faces are triangles.
///
/// OSG splits vertices at texture and normal seams; walking such a mesh's edges would stop there.
/// Pieces that are closed by themselves stay apart where they touch, as the boxes of a blocky
/// figure do, unless they share vertices in the mesh as given.
struct WeldedMesh {
    static constexpr std::uint32_t kNoShell = 0xffffffffu;

    std::vector<glm::dvec3> positions;
    std::vector<std::uint32_t> weldedOf; ///< welded vertex of each vertex of the mesh as given
    std::vector<std::array<std::uint32_t, 3>> triangles; ///< no corner twice, no triangle twice
    std::vector<glm::dvec3> normals; ///< unit, pointing outwards; zero where there is none

    std::vector<std::uint32_t> firstNeighbour; ///< size: vertices + 1; offsets into `neighbours`
    std::vector<std::uint32_t> neighbours;     ///< sorted for each vertex

    std::vector<std::uint32_t> shellOf; ///< connected piece of each vertex; kNoShell without a face
    std::size_t shells = 0;
    std::size_t openEdges = 0; ///< edges with one triangle
    double size = 0.0;         ///< largest extent along x, y or z

    /// Vertices closer than these fractions of the mesh's size are the same point. Single precision
    /// rounds by a tenth of the first one, and once more where a body's parts stand under
    /// transforms of their own. Weights that somebody painted join no vertices but copies.
    static constexpr double kRounded = 1e-6, kCopies = 1e-9;

    /// \pre mesh.validate() passes.
    explicit WeldedMesh(const SkinMesh& mesh, double same = kRounded);

    std::size_t vertexCount() const { return positions.size(); }

private:
    void weld(const SkinMesh& mesh, double tolerance);
    void partClosedPieces(const SkinMesh& mesh);
    void addTriangles(const SkinMesh& mesh);
    void connect();
    void findShells();
    void computeNormals();
};

} // namespace osgSkin

#endif
