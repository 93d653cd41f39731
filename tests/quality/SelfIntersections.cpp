// SPDX-License-Identifier: GPL-3.0-or-later
#include "SelfIntersections.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Surface_mesh.h>

#include <algorithm>
#include <iterator>

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
    _atRest = pairs(subject.rest).size();
}

SelfIntersections::~SelfIntersections() = default;

std::size_t SelfIntersections::beyondRest(const compare::Points& posed) {
    const std::size_t count = pairs(posed).size();
    return count > _atRest ? count - _atRest : 0;
}

std::vector<std::pair<std::size_t, std::size_t>>
SelfIntersections::pairs(const compare::Points& posed) {
    for (std::uint32_t v = 0; v < posed.size(); ++v)
        _mesh->surface.point(Surface::Vertex_index(v)) = {posed[v].x, posed[v].y, posed[v].z};
    std::vector<std::pair<Surface::Face_index, Surface::Face_index>> found;
    CGAL::Polygon_mesh_processing::self_intersections(_mesh->surface, std::back_inserter(found));
    std::vector<std::pair<std::size_t, std::size_t>> result;
    result.reserve(found.size());
    for (const auto& [a, b] : found) result.push_back(std::minmax<std::size_t>(a, b));
    std::sort(result.begin(), result.end());
    return result;
}

} // namespace quality
