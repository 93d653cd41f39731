// SPDX-License-Identifier: GPL-3.0-or-later
#include "fit/surface/ClosedSurface.h"

#include "fit/solid/SurfaceNet.h"

#include <osgSkin/Error>

#include <CGAL/Polygon_mesh_processing/border.h>
#include <CGAL/Polygon_mesh_processing/connected_components.h>
#include <CGAL/Polygon_mesh_processing/measure.h>
#include <CGAL/Polygon_mesh_processing/orient_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/orientation.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polygon_mesh_processing/triangulate_hole.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <iterator>

namespace osgSkin::fit {
namespace {

namespace PMP = CGAL::Polygon_mesh_processing;

/// The shell with the largest area: eyes, teeth and buttons are small beside the skin.
std::uint32_t largestShell(const WeldedMesh& mesh) {
    std::vector<double> area(mesh.shells, 0.0);
    for (const auto& t : mesh.triangles)
        area[mesh.shellOf[t[0]]] +=
            glm::length(glm::cross(mesh.positions[t[1]] - mesh.positions[t[0]],
                                   mesh.positions[t[2]] - mesh.positions[t[0]]));
    return static_cast<std::uint32_t>(std::max_element(area.begin(), area.end()) - area.begin());
}

void closeHoles(Mesh& mesh, std::vector<std::string>& notes) {
    std::vector<Mesh::Halfedge_index> holes;
    PMP::extract_boundary_cycles(mesh, std::back_inserter(holes));
    for (const Mesh::Halfedge_index hole : holes) {
        std::vector<Mesh::Face_index> patch;
        PMP::triangulate_hole(mesh, hole, std::back_inserter(patch));
        if (patch.empty())
            throw Error("cannot fit a skeleton: expected a closed skin, found a hole that cannot "
                        "be closed");
    }
    if (!holes.empty()) notes.push_back("closed " + std::to_string(holes.size()) + " holes");
}

/// The soup's largest piece as a closed surface that faces outwards.
Mesh closedMesh(std::vector<Kernel::Point_3>& points,
                std::vector<std::array<std::size_t, 3>>& triangles,
                std::vector<std::string>& notes) {
    // Splits what is not manifold, so that a flawed mesh still gives a surface.
    PMP::orient_polygon_soup(points, triangles);
    Mesh result;
    PMP::polygon_soup_to_polygon_mesh(points, triangles, result);
    PMP::keep_largest_connected_components(result, 1);
    result.collect_garbage();
    closeHoles(result, notes);
    if (!PMP::is_outward_oriented(result)) PMP::reverse_face_orientations(result);
    return result;
}

} // namespace

Mesh largestSurface(const WeldedMesh& mesh, std::vector<std::string>& notes) {
    if (mesh.shells == 0) throw Error("cannot fit a skeleton: the mesh has no triangle with area");
    const std::uint32_t shell = largestShell(mesh);
    std::vector<Kernel::Point_3> points;
    std::vector<std::size_t> index(mesh.vertexCount(), 0);
    for (std::size_t v = 0; v < mesh.vertexCount(); ++v)
        if (mesh.shellOf[v] == shell) {
            index[v] = points.size();
            points.push_back(point(mesh.positions[v]));
        }
    std::vector<std::array<std::size_t, 3>> triangles;
    for (const auto& t : mesh.triangles)
        if (mesh.shellOf[t[0]] == shell)
            triangles.push_back({index[t[0]], index[t[1]], index[t[2]]});
    if (mesh.shells > 1)
        notes.push_back("measured the largest of " + std::to_string(mesh.shells) + " shells, " +
                        std::to_string(points.size()) + " vertices");
    return closedMesh(points, triangles, notes);
}

Mesh unionSurface(const SolidGrid& filled, const WeldedMesh& mesh,
                  std::vector<std::string>& notes) {
    SolidGrid grid = filled;
    const int bars = grid.join();
    if (grid.count() == 0)
        throw Error("cannot fit a skeleton: the mesh's shells enclose no volume");
    grid.thickenTouches();
    SurfaceNet net(grid);
    notes.push_back("measured the union of " + std::to_string(mesh.shells) + " shells" +
                    (bars > 0 ? ", " + std::to_string(bars) + " gaps between them bridged" : ""));
    std::vector<Kernel::Point_3> points;
    for (const glm::dvec3& p : net.points) points.push_back(point(p));
    return closedMesh(points, net.triangles, notes);
}

} // namespace osgSkin::fit
