// SPDX-License-Identifier: GPL-3.0-or-later
#include "regions/AssignUnreached.h"

#include "mesh/NearestPoints.h"
#include "regions/RegionLabels.h"

#include <glm/geometric.hpp>

#include <limits>

namespace osgSkin {
namespace {

struct NearBone {
    std::uint32_t joint = 0; ///< the root, where no joint may hold a region
    double distance = std::numeric_limits<double>::infinity();
};

NearBone nearestBone(const glm::dvec3& p, const std::vector<PlannedJoint>& joints) {
    NearBone best;
    for (std::uint32_t j = 0; j < joints.size(); ++j) {
        if (!joints[j].holdsRegion) continue;
        const double distance = distanceToBone(joints[j], p);
        if (distance < best.distance) best = {j, distance};
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

} // namespace osgSkin
