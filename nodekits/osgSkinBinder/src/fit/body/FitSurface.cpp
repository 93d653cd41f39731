// SPDX-License-Identifier: GPL-3.0-or-later
#include "fit/body/FitSurface.h"

#include "fit/body/CurveSkeleton.h"
#include "fit/body/SolidGrid.h"
#include "fit/body/SurfaceMesh.h"
#include "mesh/SurfaceTree.h"
#include "mesh/WeldedMesh.h"

#include <osgSkin/Error>
#include <osgSkin/GlmTypes>

#include <CGAL/AABB_halfedge_graph_segment_primitive.h>
#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/Polygon_mesh_processing/border.h>
#include <CGAL/Polygon_mesh_processing/connected_components.h>
#include <CGAL/Polygon_mesh_processing/measure.h>
#include <CGAL/Polygon_mesh_processing/orient_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/orientation.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polygon_mesh_processing/triangulate_hole.h>
#include <CGAL/Polygon_mesh_slicer.h>
#include <CGAL/Surface_mesh_simplification/Edge_collapse_visitor_base.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Count_stop_predicate.h>
#include <CGAL/Surface_mesh_simplification/edge_collapse.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <limits>
#include <list>
#include <string>
#include <utility>
#include <vector>

namespace osgSkin {
Section::Section(std::vector<glm::dvec3> curve, const glm::dvec3& normal)
    : points(std::move(curve)) {
    const glm::dvec3 u = anyPerpendicular(normal), v = glm::cross(normal, u);
    const glm::dvec3 origin = points.front();
    // Moments of the enclosed area as a fan of triangles from the first corner.
    double sum = 0.0, su = 0.0, sv = 0.0;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const glm::dvec3 a = points[i] - origin;
        const glm::dvec3 b = points[(i + 1) % points.size()] - origin;
        girth += glm::distance(a, b);
        const double au = glm::dot(a, u), av = glm::dot(a, v);
        const double bu = glm::dot(b, u), bv = glm::dot(b, v);
        const double twice = au * bv - bu * av;
        sum += twice / 2.0;
        su += twice * (au + bu) / 6.0;
        sv += twice * (av + bv) / 6.0;
    }
    area = std::abs(sum);
    centre = area > 0.0 ? origin + su / sum * u + sv / sum * v : origin;
}

double Section::low(int axis) const {
    double result = std::numeric_limits<double>::infinity();
    for (const glm::dvec3& p : points) result = std::min(result, p[axis]);
    return result;
}

double Section::high(int axis) const {
    double result = -std::numeric_limits<double>::infinity();
    for (const glm::dvec3& p : points) result = std::max(result, p[axis]);
    return result;
}

double Section::distance(const glm::dvec3& point, const glm::dvec3& normal) const {
    double nearest = std::numeric_limits<double>::infinity();
    double winding = 0.0;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const glm::dvec3& a = points[i];
        const glm::dvec3& b = points[(i + 1) % points.size()];
        const glm::dvec3 edge = b - a;
        const double length2 = glm::dot(edge, edge);
        const double t =
            length2 > 0.0 ? std::clamp(glm::dot(point - a, edge) / length2, 0.0, 1.0) : 0.0;
        nearest = std::min(nearest, glm::distance(point, a + t * edge));
        const glm::dvec3 pa = a - point, pb = b - point;
        winding += std::atan2(glm::dot(normal, glm::cross(pa, pb)), glm::dot(pa, pb));
    }
    constexpr double kPi = 3.141592653589793;
    return std::abs(winding) > kPi ? -nearest : nearest;
}

} // namespace osgSkin

namespace osgSkin::fit {
namespace {

/// A solid's surface: a vertex where eight cubes meet that are not all solid or all empty, relaxed
/// within half a cube (S. Gibson, *Constrained elastic surface nets*, 1998). Closed, facing
/// outwards.
struct SurfaceNet {
    std::vector<glm::dvec3> points; ///< rest space
    std::vector<std::array<std::size_t, 3>> triangles;

    /// \pre the solid nowhere touches itself at an edge alone (SolidGrid::thickenTouches())
    explicit SurfaceNet(const SolidGrid& grid);

private:
    void relax(double reach);
};

SurfaceNet::SurfaceNet(const SolidGrid& grid) {
    const glm::ivec3 size = grid.size();
    const auto index = [&size](const glm::ivec3& c) {
        return (static_cast<std::size_t>(c.z) * static_cast<std::size_t>(size.y) +
                static_cast<std::size_t>(c.y)) *
                   static_cast<std::size_t>(size.x) +
               static_cast<std::size_t>(c.x);
    };
    constexpr std::uint32_t kNone = 0xffffffffu;
    std::vector<std::uint32_t> vertexOf(index({0, 0, size.z}), kNone);
    // The vertex between a cube and the seven beyond it.
    const auto vertex = [&](const glm::ivec3& c) {
        std::uint32_t& v = vertexOf[index(c)];
        if (v == kNone) {
            v = static_cast<std::uint32_t>(points.size());
            points.push_back(grid.centre(glm::dvec3(c) + 0.5));
        }
        return static_cast<std::size_t>(v);
    };
    const glm::ivec3 unit[] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    for (int z = 1; z + 1 < size.z; ++z)
        for (int y = 1; y + 1 < size.y; ++y)
            for (int x = 1; x + 1 < size.x; ++x)
                for (int axis = 0; axis < 3; ++axis) {
                    const glm::ivec3 c(x, y, z);
                    const bool in = grid.solid(c);
                    if (in == grid.solid(c + unit[axis])) continue;
                    const glm::ivec3 u = unit[(axis + 1) % 3], v = unit[(axis + 2) % 3];
                    std::array<std::size_t, 4> quad{vertex(c - u - v), vertex(c - v), vertex(c),
                                                    vertex(c - u)};
                    if (!in) std::swap(quad[1], quad[3]);
                    triangles.push_back({quad[0], quad[1], quad[2]});
                    triangles.push_back({quad[0], quad[2], quad[3]});
                }
    relax(0.5 * grid.edge());
}

void SurfaceNet::relax(double reach) {
    constexpr int kSteps = 8;
    const std::vector<glm::dvec3> start = points;
    std::vector<glm::dvec3> sum(points.size());
    std::vector<double> count(points.size());
    for (int step = 0; step < kSteps; ++step) {
        sum.assign(points.size(), glm::dvec3(0.0));
        count.assign(points.size(), 0.0);
        for (const auto& t : triangles)
            for (std::size_t k = 0; k < 3; ++k) {
                sum[t[k]] += points[t[(k + 1) % 3]];
                count[t[k]] += 1.0;
            }
        for (std::size_t p = 0; p < points.size(); ++p)
            points[p] = glm::clamp(sum[p] / count[p], start[p] - reach, start[p] + reach);
    }
}

namespace PMP = CGAL::Polygon_mesh_processing;

/// The shell with the largest area.
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
    // This splits edges and vertices that are not manifold, so that flawed meshes have a surface,
    // too.
    PMP::orient_polygon_soup(points, triangles);
    Mesh result;
    PMP::polygon_soup_to_polygon_mesh(points, triangles, result);
    PMP::keep_largest_connected_components(result, 1);
    result.collect_garbage();
    closeHoles(result, notes);
    if (!PMP::is_outward_oriented(result)) PMP::reverse_face_orientations(result);
    return result;
}

/// The shell with the largest area, oriented, its holes closed: eyes, teeth and buttons are
/// smaller.
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

/// The surface around the volume inside all shells; pieces that are near each other are joined.
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

/// Moves each vertex half-way to the mean of its neighbours.
void smooth(Mesh& mesh) {
    std::vector<glm::dvec3> moved(mesh.num_vertices());
    for (const auto v : mesh.vertices()) {
        glm::dvec3 sum(0.0);
        double count = 0.0;
        for (const auto neighbour : CGAL::vertices_around_target(v, mesh)) {
            sum += vector(mesh.point(neighbour));
            count += 1.0;
        }
        moved[v] =
            count > 0.0 ? 0.5 * (vector(mesh.point(v)) + sum / count) : vector(mesh.point(v));
    }
    for (const auto v : mesh.vertices()) mesh.point(v) = point(moved[v]);
}

/// Reports each twentieth of the edges to be collapsed.
class Collapses : public CGAL::Surface_mesh_simplification::Edge_collapse_visitor_base<Mesh> {
public:
    Collapses(std::size_t total, const std::function<void(double)>& tell)
        : _total(total), _tell(&tell) {}

    template <typename Profile, typename Cost>
    void OnSelected(const Profile&, const Cost&, std::size_t initial, std::size_t current) {
        const std::size_t part = 20 * (initial - current) / _total;
        if (part == _part || !*_tell) return;
        _part = part;
        (*_tell)(std::min(1.0, static_cast<double>(part) / 20.0));
    }

private:
    std::size_t _total;
    std::size_t _part = 0;
    const std::function<void(double)>* _tell; ///< the caller's: the visitor is copied
};

/// The surface with fewer triangles where it has many: the flow takes time for every vertex, and
/// medial curves need no detail.
/// \param tell called with the fraction that is done, 0 to 1; may be empty
Mesh simplified(const Mesh& mesh, const std::function<void(double)>& tell) {
    // Measured: bodies of 4,000 and of 13,000 vertices have the same medial curves at this size.
    constexpr std::size_t kEdges = 9000;
    // For rough scans: the flow loses a limb where faces point in all directions.
    constexpr int kSmoothings = 3;
    namespace Simplification = CGAL::Surface_mesh_simplification;
    Mesh result = mesh;
    if (result.number_of_edges() > kEdges)
        Simplification::edge_collapse(
            result, Simplification::Count_stop_predicate<Mesh>(kEdges),
            CGAL::parameters::visitor(Collapses(result.number_of_edges() - kEdges, tell)));
    result.collect_garbage();
    for (int i = 0; i < kSmoothings; ++i) smooth(result);
    return result;
}

} // namespace
} // namespace osgSkin::fit

namespace osgSkin {
namespace {

using fit::Kernel;
using fit::Mesh;
using EdgePrimitive = CGAL::AABB_halfedge_graph_segment_primitive<Mesh>;
using EdgeTree = CGAL::AABB_tree<CGAL::AABB_traits<Kernel, EdgePrimitive>>;
using Slicer = CGAL::Polygon_mesh_slicer<Mesh, Kernel>;

} // namespace

struct FitSurface::Surface {
    Mesh mesh;
    std::vector<glm::dvec3> points;
    std::optional<SurfaceTree> tree;
    std::optional<WindingTree> winding;
    std::unique_ptr<EdgeTree> edges;

    void index() {
        points.clear();
        for (const auto v : mesh.vertices()) points.push_back(fit::vector(mesh.point(v)));
        std::vector<std::array<std::uint32_t, 3>> triangles;
        for (const auto face : mesh.faces()) {
            auto& triangle = triangles.emplace_back();
            std::size_t k = 0;
            for (const auto v : mesh.vertices_around_face(mesh.halfedge(face)))
                triangle[k++] = static_cast<std::uint32_t>(v);
        }
        tree.emplace(points, triangles);
        winding.emplace(points, triangles);
        edges =
            std::make_unique<EdgeTree>(CGAL::edges(mesh).begin(), CGAL::edges(mesh).end(), mesh);
    }
};

FitSurface::FitSurface(const WeldedMesh& mesh, const fit::SolidGrid* filled,
                       std::vector<std::string>& notes)
    : _surface(std::make_unique<Surface>()) {
    _surface->mesh =
        filled ? fit::unionSurface(*filled, mesh, notes) : fit::largestSurface(mesh, notes);
    _surface->index();
}

FitSurface::~FitSurface() = default;

void FitSurface::transform(const glm::dmat3& rotation, const glm::dvec3& origin, double scale) {
    for (const auto v : _surface->mesh.vertices())
        _surface->mesh.point(v) =
            fit::point(scale * (rotation * (fit::vector(_surface->mesh.point(v)) - origin)));
    _surface->index();
}

const std::vector<glm::dvec3>& FitSurface::points() const {
    return _surface->points;
}

std::vector<Section> FitSurface::slice(const glm::dvec3& point, const glm::dvec3& normal) const {
    const Slicer slicer(_surface->mesh, *_surface->edges);
    std::list<std::vector<Kernel::Point_3>> curves;
    slicer(Kernel::Plane_3(fit::point(point), Kernel::Vector_3(normal.x, normal.y, normal.z)),
           std::back_inserter(curves));
    std::vector<Section> result;
    for (const auto& curve : curves) {
        if (curve.size() < 4 || curve.front() != curve.back()) continue; // touches a vertex or edge
        std::vector<glm::dvec3> corners;
        for (std::size_t i = 0; i + 1 < curve.size(); ++i) corners.push_back(fit::vector(curve[i]));
        result.emplace_back(std::move(corners), normal);
    }
    return result;
}

std::optional<Section> FitSurface::sectionAt(const glm::dvec3& point, const glm::dvec3& normal,
                                             double reach) const {
    std::optional<Section> best;
    double nearest = reach;
    for (Section& section : slice(point, normal)) {
        const double distance = section.distance(point, normal);
        if (distance >= nearest) continue;
        // Take the outer one of two curves around the point, such as a mouth in a head.
        if (best && nearest < 0.0 && distance < 0.0 && section.area < best->area) continue;
        nearest = distance;
        best = std::move(section);
    }
    return best;
}

bool FitSurface::isInside(const glm::dvec3& point) const {
    return _surface->winding->inside(point);
}

glm::dvec3 FitSurface::nearest(const glm::dvec3& point) const {
    return _surface->tree->nearest(point).position;
}

CurveSkeleton FitSurface::curveSkeleton(const std::function<void(double)>& tell) const {
    return fit::contract(fit::simplified(_surface->mesh, tell));
}

} // namespace osgSkin
