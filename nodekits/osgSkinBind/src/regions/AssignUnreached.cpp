// SPDX-License-Identifier: GPL-3.0-or-later
#include "regions/AssignUnreached.h"

#include "mesh/NearestPoints.h"
#include "regions/RegionLabels.h"

#include <limits>

namespace osgSkin {
namespace {

std::uint32_t nearestBone(const glm::dvec3& p, const std::vector<PlannedJoint>& joints) {
    std::uint32_t best = 0; // the root, where no joint may hold a region
    double nearest = std::numeric_limits<double>::infinity();
    for (std::uint32_t j = 0; j < joints.size(); ++j) {
        if (!joints[j].holdsRegion) continue;
        const double distance = distanceToBone(joints[j], p);
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
    const std::vector<std::uint32_t> nearest = nearestPoints(mesh.positions, labelled, unreached);
    for (std::size_t i = 0; i < unreached.size(); ++i) jointOf[unreached[i]] = jointOf[nearest[i]];
}

} // namespace osgSkin
