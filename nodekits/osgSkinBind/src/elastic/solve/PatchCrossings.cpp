// SPDX-License-Identifier: GPL-3.0-or-later
#include "elastic/solve/PatchCrossings.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Surface_mesh.h>

#include <iterator>
#include <utility>
#include <vector>

namespace osgSkin::elastic {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Surface = CGAL::Surface_mesh<Kernel::Point_3>;

} // namespace

std::size_t countCrossings(const RestSkin::Triangles& triangles, const Points& positions) {
    Surface surface;
    for (Eigen::Index v = 0; v < positions.cols(); ++v)
        surface.add_vertex({positions(0, v), positions(1, v), positions(2, v)});
    for (const auto& [a, b, c] : triangles)
        surface.add_face(Surface::Vertex_index(a), Surface::Vertex_index(b),
                         Surface::Vertex_index(c));
    std::vector<std::pair<Surface::Face_index, Surface::Face_index>> pairs;
    CGAL::Polygon_mesh_processing::self_intersections(surface, std::back_inserter(pairs));
    return pairs.size();
}

} // namespace osgSkin::elastic
