// SPDX-License-Identifier: GPL-3.0-or-later
#include "regions/SeedRegions.h"

#include "regions/DelaunayLinks.h"
#include "regions/RegionLabels.h"

#include <glm/geometric.hpp>

#include <limits>

namespace osgSkin {
namespace {

/// An edge may leave a vertex at most this far from the inward normal: the cosine of 45 degrees. A
/// limb is seen by its own joint head-on, by a neighbour's slantwise.
constexpr double kInwardCosine = 0.7;

/// Normal filtering, after Amenta, Bern & Kamvysselis (1998): the edge from the skin to a joint
/// that the skin belongs to runs inwards.
bool runsInwards(const WeldedMesh& mesh, std::uint32_t vertex, const glm::dvec3& sample) {
    const glm::dvec3 edge = sample - mesh.positions[vertex];
    const glm::dvec3& normal = mesh.normals[vertex];
    if (normal == glm::dvec3(0.0)) return true; // degenerate faces only: nothing to tell
    return -glm::dot(edge, normal) >= kInwardCosine * glm::length(edge);
}

} // namespace

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
        if (mesh.shellOf[link.vertex] == WeldedMesh::kNoShell) continue; // has no normal, no edge
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

} // namespace osgSkin
