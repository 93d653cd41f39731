// SPDX-License-Identifier: GPL-3.0-or-later
#include "MeshReport.h"
#include "MannequinSkeleton.h"

#include <CGAL/AABB_face_graph_triangle_primitive.h>
#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/Polygon_mesh_processing/connected_components.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Side_of_triangle_mesh.h>

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <ostream>
#include <utility>

namespace mannequin {
namespace {

constexpr double kSliver = 20; // degrees

double smallestAngle(const SkinMesh& mesh, SkinMesh::Face_index face) {
    double smallest = 180;
    for (const auto h : mesh.halfedges_around_face(mesh.halfedge(face))) {
        const glm::dvec3 apex = toGlm(mesh.point(mesh.target(h)));
        const glm::dvec3 u = toGlm(mesh.point(mesh.source(h))) - apex;
        const glm::dvec3 v = toGlm(mesh.point(mesh.target(mesh.next(h)))) - apex;
        const double angle = std::atan2(glm::length(glm::cross(u, v)), glm::dot(u, v));
        smallest = std::min(smallest, glm::degrees(angle));
    }
    return smallest;
}

void inspectShape(const SkinMesh& mesh, MeshReport& report) {
    report.smallestAngle = 180;
    for (const auto face : mesh.faces()) {
        const double angle = smallestAngle(mesh, face);
        report.smallestAngle = std::min(report.smallestAngle, angle);
        report.smallAngles += angle < kSliver;
    }
    report.lowest = 1e9;
    report.highest = -1e9;
    for (const auto v : mesh.vertices()) {
        report.lowest = std::min(report.lowest, mesh.point(v).y());
        report.highest = std::max(report.highest, mesh.point(v).y());
    }
}

void inspectFidelity(const SkinMesh& mesh, const SkinMesh& model, MeshReport& report) {
    using Primitive = CGAL::AABB_face_graph_triangle_primitive<SkinMesh>;
    CGAL::AABB_tree<CGAL::AABB_traits<Kernel, Primitive>> tree(mesh.faces().begin(),
                                                               mesh.faces().end(), mesh);
    for (const auto v : model.vertices()) {
        const double distance = std::sqrt(tree.squared_distance(model.point(v)));
        if (distance <= report.deviation) continue;
        report.deviation = distance;
        report.worstPlace = toGlm(model.point(v));
    }
}

} // namespace

bool MeshReport::good(const MeshBounds& bounds) const {
    return vertices >= bounds.leastVertices && vertices <= bounds.mostVertices &&
           eulerCharacteristic == 2 && closed && intersections == 0 &&
           smallestAngle >= bounds.leastAngle && deviation < bounds.mostDeviation &&
           jointsOutside.empty();
}

MeshReport inspect(const SkinMesh& mesh, const SkinMesh& model) {
    namespace PMP = CGAL::Polygon_mesh_processing;
    MeshReport report;
    report.vertices = mesh.number_of_vertices();
    report.faces = mesh.number_of_faces();
    report.eulerCharacteristic =
        static_cast<int>(report.vertices + report.faces) - static_cast<int>(mesh.number_of_edges());
    SkinMesh copy(mesh);
    const auto component =
        copy.add_property_map<SkinMesh::Face_index, std::size_t>("f:component").first;
    report.closed = mesh.is_valid(false) && CGAL::is_closed(mesh) &&
                    PMP::connected_components(copy, component) == 1;
    std::vector<std::pair<SkinMesh::Face_index, SkinMesh::Face_index>> pairs;
    PMP::self_intersections(mesh, std::back_inserter(pairs));
    report.intersections = pairs.size();
    inspectShape(mesh, report);
    inspectFidelity(mesh, model, report);
    if (report.closed) {
        const CGAL::Side_of_triangle_mesh<SkinMesh, Kernel> side(mesh);
        for (const RestJoint& joint : restSkeleton())
            if (side(toCgal(joint.centre)) != CGAL::ON_BOUNDED_SIDE)
                report.jointsOutside.push_back(joint.name);
    }
    return report;
}

std::ostream& operator<<(std::ostream& out, const MeshReport& report) {
    out << "vertices             " << report.vertices << '\n'
        << "triangles            " << report.faces << '\n'
        << "Euler characteristic " << report.eulerCharacteristic << '\n'
        << "one closed manifold  " << (report.closed ? "yes" : "NO") << '\n'
        << "self-intersections   " << report.intersections << '\n'
        << "smallest angle       " << report.smallestAngle << " degrees, " << report.smallAngles
        << " triangles below " << kSliver << '\n'
        << "height               " << report.lowest << " to " << report.highest << " m\n"
        << "farthest from model  " << report.deviation << " m, at " << report.worstPlace.x << ' '
        << report.worstPlace.y << ' ' << report.worstPlace.z << '\n'
        << "joints outside       " << report.jointsOutside.size();
    for (const std::string& name : report.jointsOutside) out << ' ' << name;
    return out << '\n';
}

} // namespace mannequin
