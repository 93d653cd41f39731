// SPDX-License-Identifier: GPL-3.0-or-later
#include "HardField.h"
#include "LimbRadius.h"
#include "Regions.h"

#include <glm/geometric.hpp>

namespace osgSkin {
namespace {

/// How far a region reaches above its joint's plane, in limb radii.
constexpr double kReachAbove = 0.35;

} // namespace

void trimRegions(const WeldedMesh& mesh, const std::vector<PlannedJoint>& joints,
                 std::vector<std::uint32_t>& jointOf) {
    const std::vector<double> radii = limbRadii({mesh, joints, jointOf});
    for (std::uint32_t j = static_cast<std::uint32_t>(joints.size()); j-- > 1;) {
        if (!joints[j].holdsRegion || joints[j].rigid >= 0) continue;
        const glm::dvec3 normal = planeNormal(joints[j]);
        const auto above = static_cast<std::uint32_t>(regionAbove(joints, j));
        for (std::size_t v = 0; v < jointOf.size(); ++v)
            if (jointOf[v] == j &&
                glm::dot(mesh.positions[v] - joints[j].centre, normal) < -kReachAbove * radii[j])
                jointOf[v] = above;
    }
}

} // namespace osgSkin
