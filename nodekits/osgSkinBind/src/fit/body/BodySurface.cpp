// SPDX-License-Identifier: GPL-3.0-or-later
#include "fit/body/BodySurface.h"

#include "fit/surface/ClosedSurface.h"
#include "fit/surface/Contract.h"
#include "fit/surface/SurfaceMesh.h"

#include <osgSkin/Error>

#include <CGAL/AABB_face_graph_triangle_primitive.h>
#include <CGAL/AABB_halfedge_graph_segment_primitive.h>
#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/Polygon_mesh_slicer.h>
#include <CGAL/Side_of_triangle_mesh.h>
#include <glm/geometric.hpp>

#include <iterator>
#include <limits>
#include <list>

namespace osgSkin {
namespace {

using fit::Kernel;
using fit::Mesh;
using Primitive = CGAL::AABB_face_graph_triangle_primitive<Mesh>;
using Tree = CGAL::AABB_tree<CGAL::AABB_traits<Kernel, Primitive>>;
using EdgePrimitive = CGAL::AABB_halfedge_graph_segment_primitive<Mesh>;
using EdgeTree = CGAL::AABB_tree<CGAL::AABB_traits<Kernel, EdgePrimitive>>;
using Slicer = CGAL::Polygon_mesh_slicer<Mesh, Kernel>;
using Inside = CGAL::Side_of_triangle_mesh<Mesh, Kernel>;

} // namespace

struct BodySurface::Surface {
    Mesh mesh;
    std::vector<glm::dvec3> points;
    std::unique_ptr<Tree> tree;
    std::unique_ptr<EdgeTree> edges;
    std::unique_ptr<Inside> inside;

    void index() {
        inside.reset();
        points.clear();
        for (const auto v : mesh.vertices()) points.push_back(fit::vector(mesh.point(v)));
        tree = std::make_unique<Tree>(faces(mesh).begin(), faces(mesh).end(), mesh);
        tree->accelerate_distance_queries();
        edges =
            std::make_unique<EdgeTree>(CGAL::edges(mesh).begin(), CGAL::edges(mesh).end(), mesh);
        inside = std::make_unique<Inside>(*tree);
    }
};

BodySurface::BodySurface(const WeldedMesh& mesh, const fit::SolidGrid* filled,
                         std::vector<std::string>& notes)
    : _surface(std::make_unique<Surface>()) {
    _surface->mesh =
        filled ? fit::unionSurface(*filled, mesh, notes) : fit::largestSurface(mesh, notes);
    _surface->index();
}

BodySurface::~BodySurface() = default;

void BodySurface::transform(const glm::dmat3& rotation, const glm::dvec3& origin, double scale) {
    for (const auto v : _surface->mesh.vertices())
        _surface->mesh.point(v) =
            fit::point(scale * (rotation * (fit::vector(_surface->mesh.point(v)) - origin)));
    _surface->index();
}

const std::vector<glm::dvec3>& BodySurface::points() const {
    return _surface->points;
}

std::vector<Section> BodySurface::slice(const glm::dvec3& point, const glm::dvec3& normal) const {
    const Slicer slicer(_surface->mesh, *_surface->edges);
    std::list<std::vector<Kernel::Point_3>> curves;
    slicer(Kernel::Plane_3(fit::point(point), Kernel::Vector_3(normal.x, normal.y, normal.z)),
           std::back_inserter(curves));
    std::vector<Section> result;
    for (const auto& curve : curves) {
        if (curve.size() < 4 || curve.front() != curve.back()) continue; // a touched vertex or edge
        std::vector<glm::dvec3> corners;
        for (std::size_t i = 0; i + 1 < curve.size(); ++i) corners.push_back(fit::vector(curve[i]));
        result.emplace_back(std::move(corners), normal);
    }
    return result;
}

std::optional<Section> BodySurface::sectionAt(const glm::dvec3& point, const glm::dvec3& normal,
                                              double reach) const {
    std::optional<Section> best;
    double nearest = reach;
    for (Section& section : slice(point, normal)) {
        const double distance = section.distance(point, normal);
        if (distance >= nearest) continue;
        // Of two curves around the point (a mouth in a head) the outer one.
        if (best && nearest < 0.0 && distance < 0.0 && section.area < best->area) continue;
        nearest = distance;
        best = std::move(section);
    }
    return best;
}

bool BodySurface::isInside(const glm::dvec3& point) const {
    return (*_surface->inside)(fit::point(point)) == CGAL::ON_BOUNDED_SIDE;
}

glm::dvec3 BodySurface::nearest(const glm::dvec3& point) const {
    return fit::vector(_surface->tree->closest_point(fit::point(point)));
}

CurveSkeleton BodySurface::curveSkeleton(const std::function<void(double)>& tell) const {
    return fit::contract(_surface->mesh, tell);
}

} // namespace osgSkin
