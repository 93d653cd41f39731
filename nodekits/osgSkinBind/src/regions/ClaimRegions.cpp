// SPDX-License-Identifier: GPL-3.0-or-later
#include "regions/ClaimRegions.h"

#include <glm/geometric.hpp>

namespace osgSkin {

void claimRegions(const WeldedMesh& mesh, const std::vector<PlannedJoint>& joints,
                  std::vector<std::uint32_t>& jointOf) {
    for (std::uint32_t j = 0; j < joints.size(); ++j) {
        if (!joints[j].claims) continue;
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

} // namespace osgSkin
