// SPDX-License-Identifier: GPL-3.0-or-later
#include "paper/PaperFields.h"

#include "paper/PaperBoundaries.h"

#include <algorithm>

namespace osgSkin {
namespace {

/// How a region's skin follows a joint.
enum class Follows { Nothing, Planes, Fully };

/// The region that continues the joint's chain; the joint itself where none does.
std::size_t regionBelow(const std::vector<PlannedJoint>& joints, std::size_t joint) {
    int below = joints[joint].child;
    while (below >= 0 && !joints[static_cast<std::size_t>(below)].holdsRegion)
        below = joints[static_cast<std::size_t>(below)].child;
    return below < 0 ? joint : static_cast<std::size_t>(below);
}

/// For each region how it follows the joint.
std::vector<Follows> followersOf(const std::vector<PlannedJoint>& joints, std::size_t joint) {
    std::vector<Follows> regions(joints.size(), Follows::Nothing);
    const std::vector<bool> inside = subtreeOf(joints, joint);
    for (std::size_t r = 0; r < joints.size(); ++r)
        if (inside[r]) regions[r] = Follows::Fully;
    if (joints[joint].topmost) return regions;
    for (const std::size_t r : {regionAbove(joints, joint), joint, regionBelow(joints, joint)})
        regions[r] = Follows::Planes;
    return regions;
}

} // namespace

PaperFields::PaperFields(const BinaryField& binary, const std::vector<double>& radii) {
    const std::vector<PlannedJoint>& joints = binary.joints;
    const std::size_t vertices = binary.mesh.vertexCount();
    bend = JointFields(joints.size(), vertices);
    bend.set(0, std::vector<double>(vertices, 1.0));
    twist = bend;
    for (std::size_t j = 1; j < joints.size(); ++j) {
        if (!joints[j].holdsRegion) continue;
        const std::vector<Follows> regions = followersOf(joints, j);
        const PaperRegion bendAt = bendRegion(joints[j], radii[j]);
        const PaperRegion twistAt = twistRegion(joints[j], radii[j]);
        // By default skin twists with its own bone only: on the other side of the crotch a thigh's
        // planes mean nothing.
        const bool bounded = !joints[j].poleIsParent && !hasOwnTwistRegion(joints[j]);
        std::vector<double> bends(vertices, 0.0), twists(vertices, 0.0);
        for (std::size_t v = 0; v < vertices; ++v) {
            const Follows follows = regions[binary.regions[v]];
            if (follows == Follows::Nothing) continue;
            const bool full = follows == Follows::Fully;
            bends[v] = full ? 1.0 : bendAt.ratio(binary.mesh.positions[v]);
            twists[v] = full ? 1.0 : twistAt.ratio(binary.mesh.positions[v]);
            if (bounded) twists[v] = std::min(twists[v], bends[v]);
        }
        bend.set(j, bends);
        twist.set(j, twists);
    }
    raiseParents(joints, bend);
    raiseParents(joints, twist);
}

} // namespace osgSkin
