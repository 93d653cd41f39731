// SPDX-License-Identifier: GPL-3.0-or-later
#include "regions/AssignUnreached.h"

#include "mesh/NearestPoint.h"
#include "regions/RegionLabels.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <limits>

namespace osgSkin {
namespace {

double distanceToBone(const glm::dvec3& p, const PlannedJoint& joint) {
    const double along = glm::dot(p - joint.centre, joint.boneAxis);
    return glm::distance(p,
                         joint.centre + joint.boneAxis * glm::clamp(along, 0.0, joint.boneLength));
}

std::uint32_t nearestBone(const glm::dvec3& p, const std::vector<PlannedJoint>& joints) {
    std::uint32_t best = 0; // the root, where no joint may hold a region
    double nearest = std::numeric_limits<double>::infinity();
    for (std::uint32_t j = 0; j < joints.size(); ++j) {
        if (!joints[j].holdsRegion) continue;
        const double distance = distanceToBone(p, joints[j]);
        if (distance < nearest) {
            nearest = distance;
            best = j;
        }
    }
    return best;
}

} // namespace

void assignUnreached(const WeldedMesh& mesh, const std::vector<PlannedJoint>& joints,
                     std::vector<std::uint32_t>& jointOf) {
    std::vector<std::uint32_t> labelled, unreached;
    for (std::uint32_t v = 0; v < jointOf.size(); ++v)
        (jointOf[v] == Regions::kNone ? unreached : labelled).push_back(v);
    if (unreached.empty()) return;

    if (labelled.empty()) {
        for (const std::uint32_t v : unreached) jointOf[v] = nearestBone(mesh.positions[v], joints);
        return;
    }
    const NearestPoint nearest(mesh.positions, labelled);
    for (const std::uint32_t v : unreached) jointOf[v] = jointOf[nearest.find(mesh.positions[v])];
}

} // namespace osgSkin
