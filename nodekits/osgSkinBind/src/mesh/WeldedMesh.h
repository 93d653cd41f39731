// SPDX-License-Identifier: MIT
#ifndef OSGSKINBIND_MESH_WELDEDMESH_H
#define OSGSKINBIND_MESH_WELDEDMESH_H

#include <osgSkinBind/Export>
#include <osgSkinRig/SkinMesh>

#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace osgSkin {

/// A directed edge: start vertex, end vertex.
using DirectedEdge = std::pair<std::uint32_t, std::uint32_t>;

/// Indices that lie one after the other.
struct IndexRange {
    const std::uint32_t *first, *last;

    const std::uint32_t* begin() const { return first; }
    const std::uint32_t* end() const { return last; }
};

/// All edges of triangles, in both directions, once for each triangle; sorted.
OSGSKINBIND_EXPORT std::vector<DirectedEdge>
edgesOf(const std::vector<std::array<std::uint32_t, 3>>& triangles);

/// Makes each vertex's list of neighbours.
///
/// \param vertices the number of vertices
/// \param edges sorted, each edge in both directions; duplicates count once
/// \param firstNeighbour is set to offsets into `neighbours`: one for each vertex, and the end
/// \param neighbours is set to the edges' ends, sorted for each vertex
OSGSKINBIND_EXPORT void listNeighbours(std::size_t vertices, const std::vector<DirectedEdge>& edges,
                                       std::vector<std::uint32_t>& firstNeighbour,
                                       std::vector<std::uint32_t>& neighbours);

/// The skin for binding: vertices at one position are merged, faces are triangles.
///
/// OSG splits vertices at texture and normal seams, where walking along edges would stop. Closed
/// pieces that touch, such as the boxes of a blocky figure, stay separate unless they share
/// vertices in the mesh as given.
struct OSGSKINBIND_EXPORT WeldedMesh {
    static constexpr std::uint32_t kNoShell = 0xffffffffu;

    std::vector<glm::dvec3> positions;
    std::vector<std::uint32_t> weldedOf; ///< welded vertex of each vertex of the mesh as given
    std::vector<std::array<std::uint32_t, 3>> triangles; ///< no corner twice, no triangle twice
    std::vector<glm::dvec3> normals;                     ///< unit, outwards; zero if undefined

    std::vector<std::uint32_t> firstNeighbour; ///< size: vertices + 1; offsets into `neighbours`
    std::vector<std::uint32_t> neighbours;     ///< sorted for each vertex

    std::vector<std::uint32_t>
        shellOf; ///< connected piece of each vertex; kNoShell if it has no face
    std::size_t shells = 0;
    std::size_t openEdges = 0; ///< edges with one triangle
    double size = 0.0;         ///< largest extent along x, y or z

    /// Vertices closer than this fraction of the mesh's size are merged. kRounded allows for single
    /// precision, which rounds by a tenth of it, and again where parts of a body have transforms of
    /// their own. kCopies is for painted weights: only copies of a vertex are merged.
    static constexpr double kRounded = 1e-6, kCopies = 1e-9;

    /// \pre mesh.validate() passes.
    explicit WeldedMesh(const SkinMesh& mesh, double same = kRounded);

    std::size_t vertexCount() const { return positions.size(); }
    IndexRange neighboursOf(std::uint32_t v) const {
        return {neighbours.data() + firstNeighbour[v], neighbours.data() + firstNeighbour[v + 1]};
    }

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
