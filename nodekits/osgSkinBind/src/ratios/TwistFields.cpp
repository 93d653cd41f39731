// SPDX-License-Identifier: GPL-3.0-or-later
#include "ratios/TwistFields.h"

#include "limbs/HermiteRatio.h"
#include "limbs/LimbRadius.h"
#include "ratios/TwistProfile.h"

#include <glm/geometric.hpp>

#include <algorithm>

namespace osgSkin {
namespace {

/// How far beyond the elbow a forearm's twist begins, in lengths of the forearm; the more skin
/// takes part, the less of it is strained. Of the upper arm's skin none rotates more than it bends
/// with the elbow.
constexpr double kBeyondElbow = 0.2;

/// The boundaries of a twist region, along the pole bone.
BoundarySpan twistBoundaries(const PlannedJoint& joint, double radius) {
    // A forearm rotates with its hand one radius behind the wrist, where the hand's own bend ends
    // too.
    const double upper = joint.poleIsParent ? -1.0 - kBeyondElbow : 0.0;
    const double lower = joint.poleIsParent ? std::min(radius / joint.poleLength, 0.5) : 1.0;
    BoundarySpan region{joint.options.twistUpper.value_or(upper),
                        joint.options.twistLower.value_or(lower)};
    if (!(region.upper < region.lower)) { // one is given, beyond the other's default
        if (joint.options.twistUpper)
            region.lower = region.upper + (lower - upper);
        else
            region.upper = region.lower - (lower - upper);
    }
    return region;
}

/// True where the twist has a region of its own; elsewhere it goes with the bend. It builds up
/// along limbs, to the next joint or to a last bone's tip.
bool buildsUp(const PlannedJoint& joint, double radius) {
    if (!(joint.poleLength > 0.0) || joint.topmost || joint.digit) return false;
    if (joint.options.twistUpper || joint.options.twistLower || joint.poleIsParent) return true;
    return isLimb(joint, radius);
}

/// The field along the pole bone, which is the joint's own or the one above; its skin is what that
/// bone's joint bends. By eq. 5 (hermiteRatio()), but along a forearm, whose hand rotates far, at
/// uniform shear.
std::vector<double> alongBone(const WeldedMesh& mesh, const std::vector<PlannedJoint>& joints,
                              std::size_t j, double radius, const JointFields& bend) {
    const PlannedJoint& joint = joints[j];
    const BoundarySpan region = twistBoundaries(joint, radius);
    const std::vector<double> own = bend.values(j);
    const std::vector<double> onBone =
        joint.poleIsParent ? bend.values(regionAbove(joints, j)) : own;
    std::optional<TwistProfile> evenShear;
    if (joint.poleIsParent && !joint.options.twistUpper && !joint.options.twistLower)
        evenShear.emplace(mesh, joint, region, onBone, own);
    std::vector<double> field(mesh.vertexCount());
    for (std::size_t v = 0; v < field.size(); ++v) {
        const double along =
            glm::dot(mesh.positions[v] - joint.centre, joint.twistAxis) / joint.poleLength;
        const double t = (along - region.upper) / (region.lower - region.upper);
        field[v] = std::min(evenShear ? (*evenShear)(t) : hermiteRatio(t), onBone[v]);
        if (joint.poleIsParent) field[v] = std::max(field[v], own[v]);
    }
    return field;
}

} // namespace

std::optional<BoundarySpan> twistSpan(const PlannedJoint& joint, double radius) {
    if (!buildsUp(joint, radius)) return std::nullopt;
    return twistBoundaries(joint, radius);
}

JointFields twistFields(const WeldedMesh& mesh, const std::vector<PlannedJoint>& joints,
                        const std::vector<double>& radii, const JointFields& bend) {
    JointFields twist = bend;
    const std::vector<std::vector<std::uint32_t>> children = freeChildren(joints);
    for (std::size_t j = joints.size(); j-- > 1;) {
        if (joints[j].belowRigid(static_cast<int>(j))) continue;
        const bool isOwn = buildsUp(joints[j], radii[j]);
        if (!isOwn && children[j].empty()) continue;
        std::vector<double> values =
            isOwn ? alongBone(mesh, joints, j, radii[j], bend) : bend.values(j);
        // Where a child's rotation begins, this joint's twist must have got at least as far.
        for (const std::uint32_t child : children[j]) {
            raise(values, bend.entries(child));
            raise(values, twist.entries(child));
        }
        twist.set(j, values);
    }
    return twist;
}

} // namespace osgSkin
