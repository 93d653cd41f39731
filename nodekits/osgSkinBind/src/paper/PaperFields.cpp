// SPDX-License-Identifier: GPL-3.0-or-later
#include "paper/PaperFields.h"

#include "paper/PaperBoundaries.h"

#include <algorithm>

namespace osgSkin {
namespace {

/// What a region's skin does with a joint.
enum class Share { None, Planes, Full };

bool isBelow(const std::vector<PlannedJoint>& joints, std::size_t region, std::size_t joint) {
    for (int j = joints[region].parent; j >= 0; j = joints[static_cast<std::size_t>(j)].parent)
        if (static_cast<std::size_t>(j) == joint) return true;
    return false;
}

/// The region that continues the joint's chain; the joint itself where none does.
std::size_t regionBelow(const std::vector<PlannedJoint>& joints, std::size_t joint) {
    int below = joints[joint].child;
    while (below >= 0 && !joints[static_cast<std::size_t>(below)].holdsRegion)
        below = joints[static_cast<std::size_t>(below)].child;
    return below < 0 ? joint : static_cast<std::size_t>(below);
}

/// For each region its share in the joint.
std::vector<Share> sharesIn(const std::vector<PlannedJoint>& joints, std::size_t joint) {
    std::vector<Share> shares(joints.size(), Share::None);
    for (std::size_t r = 0; r < joints.size(); ++r)
        if (isBelow(joints, r, joint)) shares[r] = Share::Full;
    for (const std::size_t r : {regionAbove(joints, joint), joint, regionBelow(joints, joint)})
        shares[r] = Share::Planes;
    return shares;
}

void raise(std::vector<double>& field, const std::vector<double>& other) {
    for (std::size_t v = 0; v < field.size(); ++v) field[v] = std::max(field[v], other[v]);
}

} // namespace

PaperFields::PaperFields(const BinaryField& hard, const std::vector<double>& radii) {
    const std::vector<PlannedJoint>& joints = hard.joints;
    bend.assign(joints.size(), std::vector<double>(hard.mesh.vertexCount(), 0.0));
    bend[0].assign(hard.mesh.vertexCount(), 1.0);
    twist = bend;
    for (std::size_t j = 1; j < joints.size(); ++j) {
        if (!joints[j].holdsRegion) continue;
        const std::vector<Share> shares = sharesIn(joints, j);
        const PaperRegion bendAt = bendRegion(joints[j], radii[j]);
        const PaperRegion twistAt = twistRegion(joints[j], radii[j]);
        // By default skin twists with its own bone only: on the other side of the crotch a thigh's
        // planes mean nothing.
        const bool bounded = !joints[j].poleIsParent && !hasOwnTwistRegion(joints[j]);
        for (std::size_t v = 0; v < bend[j].size(); ++v) {
            const Share share = shares[hard.regions[v]];
            if (share == Share::None) continue;
            const bool full = share == Share::Full;
            bend[j][v] = full ? 1.0 : bendAt.ratio(hard.mesh.positions[v]);
            twist[j][v] = full ? 1.0 : twistAt.ratio(hard.mesh.positions[v]);
            if (bounded) twist[j][v] = std::min(twist[j][v], bend[j][v]);
        }
    }
    // No joint turns skin that its parent leaves behind; one without a region (of no length, or
    // skipped) turns what its children turn.
    for (std::size_t j = joints.size(); j-- > 1;) {
        if (joints[j].belowRigid(static_cast<int>(j))) continue;
        raise(bend[static_cast<std::size_t>(joints[j].parent)], bend[j]);
        raise(twist[static_cast<std::size_t>(joints[j].parent)], twist[j]);
    }
}

} // namespace osgSkin
