// SPDX-License-Identifier: GPL-3.0-or-later
#include "SkinFigures.h"

#include <osgSkin/GlmTypes>
#include <osgSkinBind/Bind>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Surface_mesh.h>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <numeric>
#include <set>

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
    for (std::size_t t = 0; t + 2 < corners.size(); t += 3) // a loop that does not fit is left out
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

NormalError normalError(const Subject& subject, const PosedSkin& posed) {
    std::vector<std::uint32_t> all(posed.points.size());
    std::iota(all.begin(), all.end(), 0u);
    return normalError(subject, posed, all);
}

NormalError normalError(const Subject& subject, const PosedSkin& posed,
                        const std::vector<std::uint32_t>& vertices) {
    const compare::Points shown = skinNormals(posed.points, subject.triangles);
    std::vector<double> angles;
    NormalError error;
    for (const std::uint32_t v : vertices) {
        if (shown[v] == glm::dvec3(0.0)) continue;
        const double cosine = glm::dot(shown[v], posed.normals[v]);
        const double sine = glm::length(glm::cross(shown[v], posed.normals[v]));
        angles.push_back(glm::degrees(std::atan2(sine, cosine)));
        error.mean += angles.back();
    }
    if (angles.empty()) return error;
    error.mean /= static_cast<double>(angles.size());
    const auto rank = static_cast<std::ptrdiff_t>(0.95 * static_cast<double>(angles.size()));
    std::nth_element(angles.begin(), angles.begin() + rank, angles.end());
    error.percentile95 = angles[static_cast<std::size_t>(rank)];
    return error;
}

LimbBulge::LimbBulge(const Subject& subject) : _subject(subject) {
    std::set<std::uint32_t> limbs;
    for (const std::string side : {"Left", "Right"})
        for (const char* name : {"Arm", "ForeArm", "UpLeg", "Leg"})
            if (const int joint = subject.joint(side + name); joint >= 0)
                limbs.insert(static_cast<std::uint32_t>(joint));
    for (std::uint32_t v = 0; v < subject.rest.size(); ++v)
        if (limbs.count(subject.dominantJoint(v)) > 0) _vertices.push_back(v);
    const auto& joints = subject.rig.joints;
    for (std::size_t j = 1; j < joints.size(); ++j) {
        const auto parent = static_cast<std::size_t>(joints[j].parent);
        _bones.push_back({joints[parent].centre, joints[j].centre});
        _jointOfBone.push_back(parent);
    }
}

double LimbBulge::of(const compare::Points& posed, const std::vector<glm::dmat4>& skinning) const {
    std::vector<compare::Segment> bones;
    for (std::size_t b = 0; b < _bones.size(); ++b) {
        const glm::dmat4& moved = skinning[_jointOfBone[b]];
        bones.push_back({glm::dvec3(moved * glm::dvec4(_bones[b].from, 1.0)),
                         glm::dvec3(moved * glm::dvec4(_bones[b].to, 1.0))});
    }
    return compare::bulge(_subject.rest, posed, _vertices, _bones, bones);
}

namespace {

using compare::Edge;

/// Maps each cut edge to the next edge of the cut. Within a triangle the cut runs from the edge
/// that goes below the plane to the edge that comes up, so on a closed skin each edge has one
/// successor.
std::map<Edge, Edge> cuts(const Subject& subject, const std::vector<double>& height) {
    std::map<Edge, Edge> next;
    for (std::size_t t = 0; t + 2 < subject.triangles.size(); t += 3) {
        Edge down{}, up{};
        bool cut = false;
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t a = subject.triangles[t + k];
            const std::uint32_t b = subject.triangles[t + (k + 1) % 3];
            if ((height[a] >= 0.0) == (height[b] >= 0.0)) continue;
            (height[a] >= 0.0 ? down : up) = Edge{std::min(a, b), std::max(a, b)};
            cut = true;
        }
        if (cut) next[down] = up;
    }
    return next;
}

/// Removes the loop that begins at the first edge from `next`; empty if it does not close.
std::vector<Edge> takeLoop(std::map<Edge, Edge>& next) {
    const Edge start = next.begin()->first;
    std::vector<Edge> loop;
    for (Edge edge = start; loop.empty() || edge != start;) {
        loop.push_back(edge);
        const auto found = next.find(edge);
        if (found == next.end()) return {}; // an open skin
        edge = found->second;
        next.erase(found);
    }
    return loop;
}

} // namespace

std::vector<EdgePoint> crossSection(const Subject& subject, const glm::dvec3& centre,
                                    const glm::dvec3& normal) {
    std::vector<double> height;
    for (const glm::dvec3& p : subject.rest) height.push_back(glm::dot(p - centre, normal));
    std::map<Edge, Edge> next = cuts(subject, height);
    std::vector<EdgePoint> result;
    double nearest = std::numeric_limits<double>::infinity();
    while (!next.empty()) {
        std::vector<EdgePoint> points;
        glm::dvec3 middle(0.0);
        for (const Edge& edge : takeLoop(next)) {
            const double share = height[edge[0]] / (height[edge[0]] - height[edge[1]]);
            points.push_back({edge[0], edge[1], share});
            middle += glm::mix(subject.rest[edge[0]], subject.rest[edge[1]], share);
        }
        if (points.size() < 3) continue;
        const double distance = glm::distance(middle / static_cast<double>(points.size()), centre);
        if (distance >= nearest) continue;
        nearest = distance;
        result = points;
    }
    return result;
}

namespace {

osgSkin::Influence ratiosOf(const osgSkin::Binding& binding, std::uint32_t vertex,
                            std::size_t joint) {
    for (std::uint32_t i = binding.firstInfluence[vertex]; i < binding.firstInfluence[vertex + 1];
         ++i)
        if (binding.influences[i].joint == joint) return binding.influences[i];
    return {static_cast<std::uint32_t>(joint), 0.0f, 0.0f};
}

/// The ratios of one joint, interpolated between the edges' ends; all other joints stay at rest, so
/// their ratios do not matter.
osgSkin::Binding bindingOf(const Subject& subject, std::size_t joint,
                           const std::vector<EdgePoint>& points) {
    osgSkin::Binding binding;
    binding.joints = subject.binding.joints;
    binding.regions.assign(points.size(), 0);
    binding.firstInfluence.push_back(0);
    for (const EdgePoint& point : points) {
        const osgSkin::Influence a = ratiosOf(subject.binding, point.from, joint);
        const osgSkin::Influence b = ratiosOf(subject.binding, point.to, joint);
        const auto share = static_cast<float>(point.share);
        binding.influences.push_back({0, 1.0f, 1.0f});
        binding.influences.push_back({static_cast<std::uint32_t>(joint),
                                      std::clamp(glm::mix(a.bend, b.bend, share), 0.0f, 1.0f),
                                      std::clamp(glm::mix(a.twist, b.twist, share), 0.0f, 1.0f)});
        binding.firstInfluence.push_back(static_cast<std::uint32_t>(binding.influences.size()));
    }
    return binding;
}

compare::SkinWeights weightsOf(const compare::SkinWeights& weights,
                               const std::vector<EdgePoint>& points) {
    compare::SkinWeights result;
    for (const EdgePoint& point : points) {
        std::vector<compare::JointWeight> entries;
        for (const bool end : {false, true}) {
            const std::uint32_t v = end ? point.to : point.from;
            const double share = end ? point.share : 1.0 - point.share;
            for (std::uint32_t i = weights.first[v]; i < weights.first[v + 1]; ++i)
                entries.push_back({weights.entries[i].joint, share * weights.entries[i].weight});
        }
        result.add(entries);
    }
    return result;
}

compare::Points onEdges(const compare::Points& vertices, const std::vector<EdgePoint>& points) {
    compare::Points result;
    for (const EdgePoint& point : points)
        result.push_back(glm::mix(vertices[point.from], vertices[point.to], point.share));
    return result;
}

} // namespace

CrossSections::CrossSections(const Subject& subject, std::size_t joint,
                             const std::vector<std::vector<EdgePoint>>& loops) {
    for (const std::vector<EdgePoint>& loop : loops) {
        _loops.emplace_back();
        for (const EdgePoint& point : loop) {
            _loops.back().push_back(static_cast<std::uint32_t>(_points.size()));
            _points.push_back(point);
        }
    }
    if (_points.empty()) return;
    _fine.rest = onEdges(subject.rest, _points);
    _fine.weights = weightsOf(subject.weights, _points);
    _fine.binding = bindingOf(subject, joint, _points);
    _fine.model = modelOf(_fine);
}

CrossSections::Least CrossSections::leastAreas(Method method,
                                               const std::vector<glm::dmat4>& skinning,
                                               const compare::Points& posed) const {
    Least least;
    if (_points.empty()) return least;
    const compare::Points fine = deform(_fine, method, skinning);
    const compare::Points coarse = onEdges(posed, _points);
    for (const std::vector<std::uint32_t>& loop : _loops) {
        const double area = compare::loopArea(_fine.rest, loop);
        if (!(area > 0.0)) continue;
        least.ofMethod = std::min(least.ofMethod, compare::loopArea(fine, loop) / area);
        least.ofMesh = std::min(least.ofMesh, compare::loopArea(coarse, loop) / area);
    }
    return least;
}

namespace {

double bendRatio(const osgSkin::Binding& binding, std::size_t vertex, std::size_t joint) {
    for (std::uint32_t i = binding.firstInfluence[vertex]; i < binding.firstInfluence[vertex + 1];
         ++i)
        if (binding.influences[i].joint == joint)
            return static_cast<double>(binding.influences[i].bend);
    return 0.0;
}

/// The painted equivalent of a ratio: the weight of the joint and all its descendants.
double paintedRatio(const Subject& subject, std::size_t vertex, int joint) {
    double sum = 0.0;
    for (std::uint32_t i = subject.weights.first[vertex]; i < subject.weights.first[vertex + 1];
         ++i) {
        const compare::JointWeight& entry = subject.weights.entries[i];
        if (subject.rig.isInSubtree(static_cast<int>(entry.joint), joint)) sum += entry.weight;
    }
    return sum;
}

LimbRigidity measure(const Subject& subject, int own, int next) {
    const auto a = static_cast<std::size_t>(own), b = static_cast<std::size_t>(next);
    LimbRigidity limb;
    limb.limb = subject.rig.joints[a].name;
    const glm::dvec3 from = subject.rig.joints[a].centre;
    const glm::dvec3 way = subject.rig.joints[b].centre - from;
    for (std::size_t v = 0; v < subject.rest.size(); ++v) {
        if (subject.dominantJoint(v) != a) continue;
        const double along = glm::dot(subject.rest[v] - from, way) / glm::dot(way, way);
        if (along < 1.0 / 3.0 || along > 2.0 / 3.0) continue;
        ++limb.vertices;
        limb.own += bendRatio(subject.binding, v, a);
        limb.next += bendRatio(subject.binding, v, b);
        limb.paintedOwn += paintedRatio(subject, v, own);
        limb.paintedNext += paintedRatio(subject, v, next);
    }
    const auto count = static_cast<double>(limb.vertices);
    for (double* sum : {&limb.own, &limb.next, &limb.paintedOwn, &limb.paintedNext}) *sum /= count;
    return limb;
}

} // namespace

std::vector<LimbRigidity> measureRigidity(const Subject& subject) {
    constexpr const char* kBones[][2] = {
        {"Arm", "ForeArm"}, {"ForeArm", "Hand"}, {"UpLeg", "Leg"}, {"Leg", "Foot"}};
    std::vector<LimbRigidity> limbs;
    for (const auto& [own, next] : kBones)
        for (const std::string side : {"Left", "Right"}) {
            const int a = subject.joint(side + own), b = subject.joint(side + next);
            if (a >= 0 && b >= 0) limbs.push_back(measure(subject, a, b));
            if (a >= 0 && b >= 0 && limbs.back().vertices == 0) limbs.pop_back();
        }
    return limbs;
}

namespace {

/// Skin closer to the axis than this share of the body's size hardly moves, and rounding would hide
/// the sweep.
constexpr double kAxisShare = 0.005;

/// Chord length of the rigid arc for one degree, for each vertex; 0 for vertices to skip.
std::vector<double> rigidSteps(const Subject& subject, const glm::dvec3& centre,
                               const glm::dvec3& axis) {
    const double least = kAxisShare * subject.mesh.size();
    std::vector<double> steps;
    for (const glm::dvec3& p : subject.rest) {
        const double radius = glm::length(glm::cross(axis, p - centre));
        steps.push_back(radius > least ? 2.0 * std::sin(glm::radians(0.5)) * radius : 0.0);
    }
    return steps;
}

void sweep(const Subject& subject, std::size_t joint, const glm::dvec3& axis,
           PerMethod<Sweep>& result) {
    const std::vector<double> rigid =
        rigidSteps(subject, subject.binding.joints[joint].centre, axis);
    PerMethod<compare::Points> last;
    for (int degrees = -179; degrees <= 179; ++degrees) {
        const auto skinning =
            singleTurn(subject, joint, axis, glm::radians(static_cast<double>(degrees)));
        for (const Method method : kMethods) {
            compare::Points posed = deform(subject, method, skinning);
            double worst = 0.0;
            for (std::size_t v = 0; v < last[method].size(); ++v)
                if (rigid[v] > 0.0)
                    worst = std::max(worst, glm::distance(posed[v], last[method][v]) / rigid[v]);
            if (worst > result[method].worst)
                result[method] = {worst, subject.rig.joints[joint].name};
            last[method] = std::move(posed);
        }
    }
}

/// The same for ours alone; updates `result` if it is worse.
void sweepOurs(const Subject& subject, std::size_t joint, const glm::dvec3& axis, Sweep& result) {
    const std::vector<double> rigid =
        rigidSteps(subject, subject.binding.joints[joint].centre, axis);
    compare::Points last;
    for (int degrees = -179; degrees <= 179; ++degrees) {
        compare::Points posed =
            deform(subject, Method::Ours,
                   singleTurn(subject, joint, axis, glm::radians(static_cast<double>(degrees))));
        for (std::size_t v = 0; v < last.size(); ++v) {
            if (!(rigid[v] > 0.0)) continue;
            const double step = glm::distance(posed[v], last[v]) / rigid[v];
            if (step > result.worst) result = {step, subject.rig.joints[joint].name};
        }
        last = std::move(posed);
    }
}

} // namespace

Continuity measureContinuity(const Subject& subject) {
    Continuity result;
    for (std::size_t j = 1; j < subject.rig.joints.size(); ++j) {
        const glm::dvec3& pole = subject.binding.joints[j].twistAxis;
        const glm::dvec3 side = osgSkin::anyPerpendicular(pole);
        sweep(subject, j, side, result.bend);
        sweep(subject, j, glm::cross(pole, side), result.bend);
        sweep(subject, j, pole, result.twist);
    }
    return result;
}

Sweep measureShapedBends(const Subject& subject) {
    Sweep result;
    for (const osgSkin::CorrectiveJoint& shaped : subject.binding.correctives.joints) {
        const glm::dvec3& pole = subject.binding.joints[shaped.joint].twistAxis;
        const glm::dvec3 other = glm::cross(pole, shaped.axis);
        for (const double share : {0.0, 0.5, 1.0, -0.5})
            sweepOurs(subject, shaped.joint,
                      glm::normalize((1.0 - std::abs(share)) * shaped.axis + share * other),
                      result);
    }
    return result;
}

namespace {

/// Maps each joint to the one that its region counts as.
std::vector<std::size_t> shownJoints(const osgSkin::RestSkeleton& rig) {
    const std::vector<std::string> rigid = osgSkin::automaticRigidJoints(rig);
    std::vector<std::size_t> shown(rig.joints.size(), 0);
    for (std::size_t j = 1; j < shown.size(); ++j) {
        const std::size_t above = shown[static_cast<std::size_t>(rig.joints[j].parent)];
        const bool inRigid = std::count(rigid.begin(), rigid.end(), rig.joints[above].name) > 0;
        const bool noLength = rig.joints[j].centre == rig.joints[above].centre;
        shown[j] = inRigid || noLength ? above : j;
    }
    return shown;
}

double farRegions(const Subject& subject) {
    const std::vector<std::size_t> shown = shownJoints(subject.rig);
    const auto parent = [&](std::size_t j) {
        return j == 0 ? j : shown[static_cast<std::size_t>(subject.rig.joints[j].parent)];
    };
    std::size_t far = 0;
    for (std::size_t v = 0; v < subject.rest.size(); ++v) {
        const std::size_t painted = shown[subject.dominantJoint(v)];
        const std::size_t ours = shown[subject.binding.regions[v]];
        if (ours != painted && parent(ours) != painted && parent(painted) != ours) ++far;
    }
    return static_cast<double>(far) / static_cast<double>(subject.rest.size());
}

} // namespace

BindFigures measureBinding(const Subject& subject) {
    BindFigures figures;
    figures.farRegions = farRegions(subject);
    const osgSkin::Binding& binding = subject.binding;
    std::size_t sum = 0;
    for (std::size_t v = 0; v < binding.vertexCount(); ++v) {
        const auto begin = binding.influences.begin() + binding.firstInfluence[v];
        const auto end = binding.influences.begin() + binding.firstInfluence[v + 1];
        const auto count = static_cast<std::size_t>(std::count_if(
            begin, end, [](const osgSkin::Influence& influence) { return influence.isPartial(); }));
        figures.mostInfluences = std::max(figures.mostInfluences, count);
        sum += count;
    }
    const auto vertices = static_cast<double>(binding.vertexCount());
    figures.meanInfluences = static_cast<double>(sum) / vertices;
    figures.cappedShare = static_cast<double>(subject.report.cappedVertices) / vertices;
    figures.seconds = subject.report.seconds;
    return figures;
}

} // namespace quality
