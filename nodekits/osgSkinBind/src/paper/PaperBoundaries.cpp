// SPDX-License-Identifier: GPL-3.0-or-later
#include "paper/PaperBoundaries.h"

#include <glm/geometric.hpp>

#include <algorithm>

namespace osgSkin {
namespace {

/// Largest default distance of a bend boundary from the joint, in bone lengths.
constexpr double kBendShare = 0.3;

/// From this many radii a bone is a limb's, whose boundaries stand square to it.
constexpr double kSlenderLength = 2.8;

/// The author's boundaries, else the defaults. One that was set beyond the other's default pushes
/// that one on.
BoundarySpan chosen(const std::optional<double>& upper, const std::optional<double>& lower,
                    const BoundarySpan& defaults) {
    BoundarySpan span{upper.value_or(defaults.upper), lower.value_or(defaults.lower)};
    if (span.upper < span.lower) return span;
    const double width = defaults.lower - defaults.upper;
    if (upper)
        span.lower = span.upper + width;
    else
        span.upper = span.lower - width;
    return span;
}

double reach(double length, double radius) {
    return radius > 0.0 ? std::min(kBendShare * length, radius) : kBendShare * length;
}

/// What boundaries are measured in; a last joint may have no bone of its own.
double unitLength(const PlannedJoint& joint) {
    return joint.boneLength > 0.0 ? joint.boneLength : joint.lengthAbove;
}

/// The plane at `along` (in `unit`s) from the joint: negative on the bone above, else on its own.
BoundaryPlane bendPlane(const PlannedJoint& joint, double radius, double along, double unit) {
    const bool above = along < 0.0;
    const glm::dvec3& bone = above ? joint.comingFrom : joint.boneAxis;
    const double length = above ? joint.lengthAbove : joint.boneLength;
    const bool limb = length > kSlenderLength * radius;
    return {joint.centre + along * unit * bone, limb && along != 0.0 ? bone : planeNormal(joint)};
}

} // namespace

BoundarySpan paperBendSpan(const PlannedJoint& joint, double radius) {
    const double unit = unitLength(joint);
    return chosen(joint.options.bendUpper, joint.options.bendLower,
                  {-reach(joint.lengthAbove, radius) / unit, reach(unit, radius) / unit});
}

std::optional<BoundarySpan> paperTwistSpan(const PlannedJoint& joint, double radius) {
    const bool alongBone = joint.poleIsParent || (!joint.extremity && joint.rigid < 0);
    if (!(joint.poleLength > 0.0) || (!alongBone && !hasOwnTwistRegion(joint))) return std::nullopt;
    const BoundarySpan defaults =
        joint.poleIsParent ? BoundarySpan{-1.0, reach(unitLength(joint), radius) / joint.poleLength}
                           : BoundarySpan{0.0, 1.0};
    return chosen(joint.options.twistUpper, joint.options.twistLower, defaults);
}

PaperRegion bendRegion(const PlannedJoint& joint, double radius) {
    const double unit = unitLength(joint);
    const BoundarySpan span = paperBendSpan(joint, radius);
    return {bendPlane(joint, radius, span.upper, unit), bendPlane(joint, radius, span.lower, unit)};
}

PaperRegion twistRegion(const PlannedJoint& joint, double radius) {
    const std::optional<BoundarySpan> span = paperTwistSpan(joint, radius);
    if (!span) return bendRegion(joint, radius);
    const glm::dvec3 bone = joint.poleLength * joint.twistAxis;
    return {{joint.centre + span->upper * bone, joint.twistAxis},
            {joint.centre + span->lower * bone, joint.twistAxis}};
}

bool hasOwnTwistRegion(const PlannedJoint& joint) {
    return joint.options.twistUpper || joint.options.twistLower;
}

} // namespace osgSkin
