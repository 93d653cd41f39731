// SPDX-License-Identifier: GPL-3.0-or-later
#include "BendRegion.h"
#include "RatioFields.h"

#include <glm/geometric.hpp>

#include <algorithm>

namespace osgSkin {

JointFields twistFields(const WeldedMesh& mesh, const RestSkeleton& skeleton,
                        const std::vector<PlannedJoint>& joints, const JointFields& bend,
                        const BindOptions& options) {
    JointFields twist = bend;
    for (std::size_t j = 1; j < joints.size(); ++j) {
        const PlannedJoint& joint = joints[j];
        if (joint.belowRigid(static_cast<int>(j)) || !(joint.poleLength > 0.0)) continue;
        const auto found = options.joints.find(skeleton.joints[j].name);
        const JointBindOptions own =
            found == options.joints.end() ? JointBindOptions() : found->second;
        const bool asked = own.twistUpper || own.twistLower;
        if (!joint.poleIsParent && !asked) continue;

        // Section 3: skin near the end of the bone follows the twist more fully. The bone is the
        // joint's own or, for a parent pole, the one above; its skin is what its joint bends.
        const double upper = own.twistUpper.value_or(joint.poleIsParent ? -1.0 : 0.0);
        const double lower = own.twistLower.value_or(joint.poleIsParent ? 0.0 : 1.0);
        const std::size_t carrier = joint.poleIsParent ? static_cast<std::size_t>(joint.parent) : j;
        for (std::size_t v = 0; v < mesh.vertexCount(); ++v) {
            const double along =
                glm::dot(mesh.positions[v] - joint.centre, joint.twistAxis) / joint.poleLength;
            const double built = hermite((along - upper) / (lower - upper));
            const double onBone = std::min(built, bend[carrier][v]);
            twist[j][v] = joint.poleIsParent ? std::max(bend[j][v], onBone) : onBone;
        }
    }
    return twist;
}

} // namespace osgSkin
