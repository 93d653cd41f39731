// SPDX-License-Identifier: GPL-3.0-or-later
#include "regions/TrimRegions.h"

#include "limbs/LimbRadius.h"
#include "regions/FacesLimb.h"

#include <glm/geometric.hpp>

#include <limits>

namespace osgSkin {
namespace {

/// How far a region reaches above its joint's plane, in limb radii.
constexpr double kReachAbove = 0.35;

/// How far a collar bone's region reaches from the bone, in radii of the arm. Skin farther down the
/// chest hangs on the spine.
constexpr double kReachOfCollar = 1.1;

double reachFromBone(const PlannedJoint& joint, const std::vector<double>& radii) {
    const double arm = joint.collarBone ? radii[static_cast<std::size_t>(joint.child)] : 0.0;
    return arm > 0.0 ? kReachOfCollar * arm : std::numeric_limits<double>::infinity();
}

} // namespace

void trimRegions(const WeldedMesh& mesh, const std::vector<PlannedJoint>& joints,
                 std::vector<std::uint32_t>& jointOf) {
    const std::vector<double> radii = limbRadii({mesh, joints, jointOf});
    for (std::uint32_t j = static_cast<std::uint32_t>(joints.size()); j-- > 1;) {
        if (!joints[j].holdsRegion || joints[j].rigid >= 0 || joints[j].topmost) continue;
        const glm::dvec3 normal = planeNormal(joints[j]);
        const double reach = reachFromBone(joints[j], radii);
        const auto above = static_cast<std::uint32_t>(regionAbove(joints, j));
        const bool leavesTrunk = joints[above].trunk && isLimb(joints[j], radii[j]);
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

} // namespace osgSkin
