// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "DetailMap.h"
#include "ImplicitBody.h"
#include "SkinMesh.h"

#include <cstddef>
#include <functional>
#include <vector>

namespace mannequin {

/// A curve on the skin, where `side` changes its sign; `applies` tells which part of the skin it
/// crosses.
struct SkinCurve {
    std::function<double(const glm::dvec3&)> side;
    std::function<bool(const glm::dvec3&)> applies;
};

/// Remeshes the skin in place to near-equilateral triangles of varying target edge length.
///
/// Incremental remeshing after Botsch & Kobbelt, *A remeshing approach to multiresolution modeling*
/// (SGP 2004): split long edges, collapse short ones, flip, relax along the surface, and project
/// onto the implicit body. CGAL 5.5's isotropic_remeshing supports only a uniform length.
class Remesher {
public:
    Remesher(const ImplicitBody& body, const DetailMap& detail, SkinMesh& mesh);

    /// Estimates the number of vertices for the target lengths times `scale`.
    double expectedVertices(double scale) const;

    void run(double scale, int rounds);

    /// Moves vertices near a curve onto it, so that edges follow it. From then on the vertices
    /// slide along the curve only. Call it after run().
    void follow(const SkinCurve& curve);

    /// Increases the smallest angles without changing the number of vertices.
    void polish(int rounds);

private:
    using Vertex = SkinMesh::Vertex_index;
    using Edge = SkinMesh::Edge_index;
    using Halfedge = SkinMesh::Halfedge_index;

    void splitLong();
    void collapseShort();
    void flipForValence();
    void flipForAngle();
    void relax();

    double wanted(const glm::dvec3& point) const { return _detail.edgeLength(point) * _scale; }
    glm::dvec3 at(Vertex v) const { return toGlm(_mesh.point(v)); }
    void settle(Vertex v, const glm::dvec3& point); ///< moves `v` to the skin near `point`
    void settleOn(const SkinCurve& curve, Vertex v, glm::dvec3 point);
    void collapseSlivers();
    bool onSameCurve(Vertex a, Vertex b) const;
    bool facesOutward(Vertex a, Vertex b, Vertex c) const;
    glm::dvec3 faceNormal(Halfedge h) const;
    /// Moves a point outward to the skin of a cut-off tip, where the closest skin is the side.
    glm::dvec3 lifted(glm::dvec3 point, const glm::dvec3& outward) const;
    bool mustSplit(double length, const glm::dvec3& middle) const;
    bool mayCollapse(Halfedge h) const; ///< true if its source may merge into its target
    bool strays(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) const;
    bool maySit(Vertex v) const; ///< true if the faces around `v` are good
    bool mayFlip(Edge e) const;
    double smallestAngle(Vertex a, Vertex b, Vertex c) const;

    const ImplicitBody& _body;
    const DetailMap& _detail;
    SkinMesh& _mesh;
    SkinMesh::Property_map<Vertex, glm::dvec3> _normal;
    SkinMesh::Property_map<Vertex, std::size_t> _curve; ///< 1 + index of a vertex's curve, or 0
    std::vector<SkinCurve> _curves;
    double _scale = 1;
};

} // namespace mannequin
