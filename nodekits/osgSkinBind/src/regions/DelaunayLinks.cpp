// SPDX-License-Identifier: GPL-3.0-or-later
#include "regions/DelaunayLinks.h"

#include <CGAL/Delaunay_triangulation_3.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_vertex_base_with_info_3.h>

#include <algorithm>
#include <iterator>
#include <utility>

namespace osgSkin {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using VertexBase = CGAL::Triangulation_vertex_base_with_info_3<std::uint32_t, Kernel>;
using Structure = CGAL::Triangulation_data_structure_3<VertexBase>;
using Delaunay = CGAL::Delaunay_triangulation_3<Kernel, Structure>;
using Handle = Delaunay::Vertex_handle;

Kernel::Point_3 point(const glm::dvec3& p) {
    return {p.x, p.y, p.z};
}

} // namespace

std::vector<DelaunayLink> delaunayLinks(const std::vector<glm::dvec3>& vertices,
                                        const std::vector<glm::dvec3>& samples) {
    std::vector<std::pair<Kernel::Point_3, std::uint32_t>> points;
    points.reserve(vertices.size());
    for (std::size_t v = 0; v < vertices.size(); ++v)
        points.emplace_back(point(vertices[v]), static_cast<std::uint32_t>(v));
    Delaunay triangulation(points.begin(), points.end());

    const auto vertexCount = static_cast<std::uint32_t>(vertices.size());
    std::vector<Handle> handles;
    for (std::size_t c = 0; c < samples.size(); ++c) {
        const std::size_t before = triangulation.number_of_vertices();
        // The next sample of a bone is near the last one.
        const Handle handle = handles.empty()
                                  ? triangulation.insert(point(samples[c]))
                                  : triangulation.insert(point(samples[c]), handles.back());
        if (triangulation.number_of_vertices() != before)
            handle->info() = vertexCount + static_cast<std::uint32_t>(c);
        handles.push_back(handle);
    }
    if (triangulation.dimension() < 3) return {};

    std::vector<DelaunayLink> links;
    for (std::size_t c = 0; c < samples.size(); ++c) {
        std::vector<Handle> adjacent;
        triangulation.finite_adjacent_vertices(handles[c], std::back_inserter(adjacent));
        adjacent.push_back(handles[c]); // itself a vertex of the skin where the sample lies on one
        const std::size_t first = links.size();
        for (const Handle handle : adjacent)
            if (handle->info() < vertexCount)
                links.push_back({handle->info(), static_cast<std::uint32_t>(c)});
        std::sort(links.begin() + static_cast<std::ptrdiff_t>(first), links.end(),
                  [](const DelaunayLink& a, const DelaunayLink& b) { return a.vertex < b.vertex; });
    }
    return links;
}

} // namespace osgSkin
