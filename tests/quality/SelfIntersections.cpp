// SPDX-License-Identifier: GPL-3.0-or-later
#include "SelfIntersections.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Surface_mesh.h>

namespace quality {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Surface = CGAL::Surface_mesh<Kernel::Point_3>;

} // namespace

struct SelfIntersections::Mesh {
    Surface surface;
};

SelfIntersections::SelfIntersections(const Subject& subject) : _mesh(std::make_unique<Mesh>()) {
    for (const glm::dvec3& p : subject.rest) _mesh->surface.add_vertex({p.x, p.y, p.z});
    const std::vector<std::uint32_t>& corners = subject.triangles;
    for (std::size_t t = 0; t + 2 < corners.size(); t += 3) // one that does not fit is left out
        _mesh->surface.add_face(Surface::Vertex_index(corners[t]),
                                Surface::Vertex_index(corners[t + 1]),
                                Surface::Vertex_index(corners[t + 2]));
    _atRest = count(subject.rest);
}

SelfIntersections::~SelfIntersections() = default;

std::size_t SelfIntersections::beyondRest(const compare::Points& posed) {
    const std::size_t pairs = count(posed);
    return pairs > _atRest ? pairs - _atRest : 0;
}

std::size_t SelfIntersections::count(const compare::Points& points) {
    for (std::uint32_t v = 0; v < points.size(); ++v)
        _mesh->surface.point(Surface::Vertex_index(v)) = {points[v].x, points[v].y, points[v].z};
    std::vector<std::pair<Surface::Face_index, Surface::Face_index>> pairs;
    CGAL::Polygon_mesh_processing::self_intersections(_mesh->surface, std::back_inserter(pairs));
    return pairs.size();
}

} // namespace quality
