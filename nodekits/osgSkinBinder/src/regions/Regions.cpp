// SPDX-License-Identifier: GPL-3.0-or-later
#include "regions/Regions.h"

#include "mesh/NearestPoints.h"
#include "mesh/SurfaceQueries.h"
#include "regions/BinaryField.h"
#include "regions/SpreadRegions.h"

#include <CGAL/Delaunay_triangulation_3.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_vertex_base_with_info_3.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <iterator>
#include <limits>
#include <map>
#include <utility>

namespace osgSkin {
namespace {

/// Fractions of findRegions()' time at which steps begin, measured at 280,000 vertices.
constexpr double kFloodingBegins = 0.3;
constexpr double kBordersBegin = 0.9;

/// An edge may deviate from the inward normal by at most 45 degrees (this is the cosine). A limb's
/// own joint sees it head-on, a neighbouring joint at a slant.
constexpr double kInwardCosine = 0.7;

/// How far a region reaches above its joint's plane, in limb radii.
constexpr double kReachAbove = 0.35;

/// How far a collar bone's region reaches from the bone, in radii of the arm. Skin farther down the
/// chest belongs to the spine.
constexpr double kReachOfCollar = 1.1;

/// Skin farther from a limb's bone than this, in limb radii, and turned towards it is not the
/// limb's.
constexpr double kFacing = 1.5;

/// The share of the samples in a shell that a joint needs to own the shell; the bone that leads to
/// the joint may end in the shell, too.
constexpr double kOwnShare = 0.7;

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using VertexBase = CGAL::Triangulation_vertex_base_with_info_3<std::uint32_t, Kernel>;
using Structure = CGAL::Triangulation_data_structure_3<VertexBase>;
using Delaunay = CGAL::Delaunay_triangulation_3<Kernel, Structure>;
using Handle = Delaunay::Vertex_handle;

Kernel::Point_3 point(const glm::dvec3& p) {
    return {p.x, p.y, p.z};
}

/// An edge of the Delaunay triangulation between a vertex of the skin and a sample of the skeleton.
struct DelaunayLink {
    std::uint32_t vertex = 0;
    std::uint32_t sample = 0;
};

/// Triangulates vertices and samples of the skeleton together (paper, section 1, Delaunay step) and
/// returns the edges that join one of each kind, sorted by sample, then vertex.
///
/// The result is empty if all points lie in one plane. A sample that lies exactly on a vertex is
/// linked to it and to that vertex's neighbours.
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
        adjacent.push_back(handles[c]); // a vertex of the skin if the sample lies on one
        const std::size_t first = links.size();
        for (const Handle handle : adjacent)
            if (handle->info() < vertexCount)
                links.push_back({handle->info(), static_cast<std::uint32_t>(c)});
        std::sort(links.begin() + static_cast<std::ptrdiff_t>(first), links.end(),
                  [](const DelaunayLink& a, const DelaunayLink& b) { return a.vertex < b.vertex; });
    }
    return links;
}

/// Normal filtering, after Amenta, Bern & Kamvysselis (1998): the edge from a vertex to its own
/// joint must run inwards.
bool runsInwards(const WeldedMesh& mesh, std::uint32_t vertex, const glm::dvec3& sample) {
    const glm::dvec3 edge = sample - mesh.positions[vertex];
    const glm::dvec3& normal = mesh.normals[vertex];
    if (normal == glm::dvec3(0.0)) return true; // only degenerate faces
    return -glm::dot(edge, normal) >= kInwardCosine * glm::length(edge);
}

/// The Delaunay step: labels the seeds; all other vertices are kNone.
Regions seedRegions(const WeldedMesh& mesh, const std::vector<PlannedJoint>& joints) {
    std::vector<glm::dvec3> samples;
    std::vector<std::uint32_t> jointOf;
    for (std::size_t j = 0; j < joints.size(); ++j)
        for (const glm::dvec3& sample : joints[j].samples) {
            samples.push_back(sample);
            jointOf.push_back(static_cast<std::uint32_t>(j));
        }

    Regions regions;
    regions.jointOf.assign(mesh.vertexCount(), Regions::kNone);
    regions.seeds.assign(joints.size(), 0);
    std::vector<double> nearest(mesh.vertexCount(), std::numeric_limits<double>::infinity());
    for (const DelaunayLink& link : delaunayLinks(mesh.positions, samples)) {
        if (mesh.shellOf[link.vertex] == WeldedMesh::kNoShell) continue;
        const glm::dvec3& sample = samples[link.sample];
        if (!runsInwards(mesh, link.vertex, sample)) {
            ++regions.rejectedEdges;
            continue;
        }
        const double distance = glm::distance(sample, mesh.positions[link.vertex]);
        if (distance < nearest[link.vertex]) {
            nearest[link.vertex] = distance;
            regions.jointOf[link.vertex] = jointOf[link.sample];
        }
    }
    for (const std::uint32_t joint : regions.jointOf)
        if (joint != Regions::kNone) ++regions.seeds[joint];
    return regions;
}

double reachFromBone(const PlannedJoint& joint, const std::vector<double>& radii) {
    const double arm = joint.isCollarBone() ? radii[static_cast<std::size_t>(joint.child)] : 0.0;
    return arm > 0.0 ? kReachOfCollar * arm : std::numeric_limits<double>::infinity();
}

/// Moves skin that a joint should not bend to the region above: skin well above the joint's plane
/// (the side of the torso below a shoulder), skin far from a collar bone (the chest below it), and
/// skin that faces a limb from a distance (the torso beside an arm that hangs down).
void trimRegions(const WeldedMesh& mesh, const std::vector<PlannedJoint>& joints,
                 std::vector<std::uint32_t>& jointOf) {
    const std::vector<double> radii = limbRadii({mesh, joints, jointOf});
    for (std::uint32_t j = static_cast<std::uint32_t>(joints.size()); j-- > 1;) {
        if (!joints[j].holdsRegion() || joints[j].rigid >= 0 || joints[j].topmost) continue;
        const glm::dvec3 normal = planeNormal(joints[j]);
        const double reach = reachFromBone(joints[j], radii);
        const auto above = static_cast<std::uint32_t>(regionAbove(joints, j));
        const bool leavesTrunk = joints[above].isOfTrunk() && isLimb(joints[j], radii[j]);
        for (std::size_t v = 0; v < jointOf.size(); ++v) {
            if (jointOf[v] != j) continue;
            const glm::dvec3& p = mesh.positions[v];
            if (distanceToBone(joints[j], p) > reach ||
                glm::dot(p - joints[j].centre, normal) < -kReachAbove * radii[j] ||
                (leavesTrunk && facesLimb(joints[j], radii[j], p, mesh.normals[v])))
                jointOf[v] = above;
        }
    }
}

struct NearBone {
    std::uint32_t joint = 0; ///< the root if no joint may hold a region
    double distance = std::numeric_limits<double>::infinity();
};

NearBone nearestBone(const glm::dvec3& p, const std::vector<PlannedJoint>& joints) {
    NearBone best;
    for (std::uint32_t j = 0; j < joints.size(); ++j) {
        if (!joints[j].holdsRegion()) continue;
        const double distance = distanceToBone(joints[j], p);
        if (distance < best.distance) best = {j, distance};
    }
    return best;
}

/// Labels vertices that flooding cannot reach, after the nearest labelled vertex or the nearest
/// bone, whichever is nearer. So a button follows the skin below it, and an empty lined coat the
/// bones.
void assignUnreached(const WeldedMesh& mesh, const std::vector<PlannedJoint>& joints,
                     std::vector<std::uint32_t>& jointOf) {
    std::vector<std::uint32_t> labelled, unreached;
    for (std::uint32_t v = 0; v < jointOf.size(); ++v)
        (jointOf[v] == Regions::kNone ? unreached : labelled).push_back(v);
    if (unreached.empty()) return;

    std::vector<std::uint32_t> nearest;
    if (!labelled.empty()) nearest = nearestPoints(mesh.positions, labelled, unreached);
    for (std::size_t i = 0; i < unreached.size(); ++i) {
        const glm::dvec3& p = mesh.positions[unreached[i]];
        const NearBone bone = nearestBone(p, joints);
        const bool isSkinNearer =
            !nearest.empty() && glm::distance(p, mesh.positions[nearest[i]]) < bone.distance;
        jointOf[unreached[i]] = isSkinNearer ? jointOf[nearest[i]] : bone.joint;
    }
}

/// Gives joints with `claims` the vertices that are nearer to them than to the neighbouring joint
/// of the chain that has them so far.
void claimRegions(const WeldedMesh& mesh, const std::vector<PlannedJoint>& joints,
                  std::vector<std::uint32_t>& jointOf) {
    for (std::uint32_t j = 0; j < joints.size(); ++j) {
        if (joints[j].region != RegionSource::Nearest) continue;
        const std::size_t above = regionAbove(joints, j);
        for (std::size_t v = 0; v < jointOf.size(); ++v) {
            const std::uint32_t owner = jointOf[v];
            if (owner != above && (owner == j || regionAbove(joints, owner) != j)) continue;
            if (glm::distance(mesh.positions[v], joints[j].centre) <
                glm::distance(mesh.positions[v], joints[owner].centre))
                jointOf[v] = j;
        }
    }
}

/// Gives a closed shell to the joint that has nearly all the samples in it: a box of a blocky
/// figure, an eye. A joint whose samples are all in such shells gets no other skin.
void giveShells(const WeldedMesh& mesh, const std::vector<PlannedJoint>& joints, Regions& regions) {
    if (mesh.shells < 2) return;
    std::vector<std::map<std::uint32_t, std::size_t>> samplesIn(mesh.shells); // of each joint
    std::vector<bool> hasShell(joints.size(), false), hasOther(joints.size(), false);
    for (std::uint32_t j = 0; j < joints.size(); ++j) {
        const std::uint32_t joint =
            joints[j].rigid >= 0 ? static_cast<std::uint32_t>(joints[j].rigid) : j;
        for (const glm::dvec3& sample : joints[j].samples) {
            const std::vector<std::uint32_t> around = shellsAround(mesh, sample);
            if (around.empty()) hasOther[joint] = true; // in an open shell, as a face with a neck
            for (const std::uint32_t shell : around) ++samplesIn[shell][joint];
        }
    }
    std::vector<std::uint32_t> owner(mesh.shells, Regions::kNone);
    for (std::uint32_t shell = 0; shell < mesh.shells; ++shell) {
        std::size_t all = 0;
        for (const auto& [joint, count] : samplesIn[shell]) all += count;
        for (const auto& [joint, count] : samplesIn[shell]) {
            const bool isOwn = double(count) >= kOwnShare * double(all);
            if (isOwn) owner[shell] = joint;
            (isOwn ? hasShell : hasOther)[joint] = true;
        }
    }
    regions.isWhole.assign(regions.jointOf.size(), false);
    for (std::size_t v = 0; v < regions.jointOf.size(); ++v) {
        if (mesh.shellOf[v] == WeldedMesh::kNoShell) continue;
        const std::uint32_t joint = owner[mesh.shellOf[v]], now = regions.jointOf[v];
        regions.isWhole[v] = joint != Regions::kNone;
        if (joint != Regions::kNone)
            regions.jointOf[v] = regions.seedOf[v] = joint;
        else if (hasShell[now] && !hasOther[now])
            regions.jointOf[v] = regions.seedOf[v] = Regions::kNone;
    }
    spreadRegions(mesh, regions.jointOf);
    assignUnreached(mesh, joints, regions.jointOf);
}

/// Distance of a point to a bone; a last bone extends to its last sample.
double distanceToDigit(const PlannedJoint& joint, const glm::dvec3& point) {
    PlannedJoint bone = joint;
    if (bone.child < 0 && !bone.samples.empty())
        bone.boneLength =
            std::max(bone.boneLength, glm::distance(bone.centre, bone.samples.back()));
    return distanceToBone(bone, point);
}

/// Gives the joints of fingers and toes skin beyond them that belongs to joints above, if it is
/// farther from the bones of those. A rig may have one finger for four.
void extendDigits(const WeldedMesh& mesh, const std::vector<PlannedJoint>& joints,
                  std::vector<std::uint32_t>& jointOf) {
    std::vector<std::vector<std::uint32_t>> digitsBelow(joints.size());
    for (std::uint32_t j = 0; j < joints.size(); ++j) {
        if (!joints[j].isDigit() || !joints[j].holdsRegion()) continue;
        for (std::size_t above = j; joints[above].isDigit();) {
            above = static_cast<std::size_t>(joints[above].parent);
            digitsBelow[above].push_back(j);
        }
    }
    for (std::size_t v = 0; v < jointOf.size(); ++v) {
        const glm::dvec3& p = mesh.positions[v];
        const std::uint32_t owner = jointOf[v];
        double nearest = distanceToBone(joints[owner], p);
        for (const std::uint32_t j : digitsBelow[owner]) {
            if (glm::dot(p - joints[j].centre, planeNormal(joints[j])) <= 0.0) continue;
            const double distance = distanceToDigit(joints[j], p);
            if (distance >= nearest) continue;
            nearest = distance;
            jointOf[v] = j;
        }
    }
}

/// Makes `beyond` all that a joint has of its shell; the rest of its skin there goes to the
/// adjacent regions. Changes nothing on a shell that belongs to the joint wholly or not at all.
///
/// Where most of that shell's other skin would go, a chain runs back past the extremity, as a
/// snake's tail that hangs on its head: clears `beyond`.
void giveBeyond(const WeldedMesh& mesh, std::vector<PlannedJoint>& joints, std::uint32_t joint,
                std::vector<std::uint32_t>& jointOf) {
    const std::vector<std::uint32_t>& beyond = joints[joint].beyond;
    const std::vector<bool> isBelow = subtreeOf(joints, joint);
    const std::uint32_t shell = mesh.shellOf[beyond.front()];
    const auto isToGo = [&](std::size_t v) {
        return mesh.shellOf[v] == shell && isBelow[jointOf[v]] &&
               !std::binary_search(beyond.begin(), beyond.end(), v);
    };
    std::size_t own = 0, rest = 0, toGo = 0;
    for (std::size_t v = 0; v < jointOf.size(); ++v) {
        if (mesh.shellOf[v] == shell) ++(isBelow[jointOf[v]] ? own : rest);
        toGo += isToGo(v);
    }
    if (own == 0 || rest == 0) return;
    if (toGo > rest) return joints[joint].beyond.clear();

    std::vector<std::uint32_t> others = jointOf; // the regions outside the extremity
    for (const std::uint32_t v : beyond) {
        others[v] = Regions::kNone;
        if (!isBelow[jointOf[v]]) jointOf[v] = joint;
    }
    for (std::size_t v = 0; v < jointOf.size(); ++v)
        if (isToGo(v)) others[v] = Regions::kNone;
    spreadRegions(mesh, others);
    for (std::size_t v = 0; v < jointOf.size(); ++v)
        if (isToGo(v) && others[v] != Regions::kNone) jointOf[v] = others[v];
}

} // namespace

bool facesLimb(const PlannedJoint& limb, double radius, const glm::dvec3& position,
               const glm::dvec3& normal) {
    const glm::dvec3 d = position - limb.centre;
    const double along = std::clamp(glm::dot(d, limb.boneAxis), 0.0, limb.boneLength);
    const glm::dvec3 off = d - along * limb.boneAxis;
    return glm::length(off) > kFacing * radius && glm::dot(normal, off) < 0.0;
}

Regions findRegions(const WeldedMesh& mesh, std::vector<PlannedJoint>& joints,
                    const Progress& progress) {
    const auto tell = [&progress](const char* what, double fraction) {
        if (progress) progress({what, fraction});
    };
    tell("Delaunay step", 0.0);
    Regions regions = seedRegions(mesh, joints);
    regions.seedOf = regions.jointOf;
    std::vector<bool> isSeed(mesh.vertexCount());
    for (std::size_t v = 0; v < isSeed.size(); ++v)
        isSeed[v] = regions.jointOf[v] != Regions::kNone;

    tell("flooding", kFloodingBegins);
    floodRegions(mesh, regions.jointOf);
    tell("borders of regions", kBordersBegin);
    assignUnreached(mesh, joints, regions.jointOf);
    claimRegions(mesh, joints, regions.jointOf);
    // All joints at and below a rigid joint share its region.
    for (std::uint32_t& joint : regions.jointOf)
        if (joints[joint].rigid >= 0) joint = static_cast<std::uint32_t>(joints[joint].rigid);
    trimRegions(mesh, joints, regions.jointOf);
    giveShells(mesh, joints, regions);
    for (std::uint32_t j = 0; j < joints.size(); ++j)
        if (!joints[j].beyond.empty()) giveBeyond(mesh, joints, j, regions.jointOf);
    removeIslands(mesh, isSeed, regions.jointOf);
    extendDigits(mesh, joints, regions.jointOf); // last, as a digit's region may have islands
    return regions;
}

} // namespace osgSkin
