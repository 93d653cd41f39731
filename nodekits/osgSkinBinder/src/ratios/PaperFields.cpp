// SPDX-License-Identifier: GPL-3.0-or-later
#include "ratios/PaperFields.h"

#include "regions/HermiteRatio.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace osgSkin {
namespace {

/// Newton's method with bisection as a fallback; few steps are needed without it.
constexpr int kMaxSteps = 100;
constexpr double kStepTolerance = 1e-14;

/// A point whose distance to one plane is less than this share of the sum is on that plane. In a
/// wide wedge the root grows without limit towards the plane.
constexpr double kTinyShare = 1e-60;

/// Largest default distance of a bend boundary from the joint, in bone lengths.
constexpr double kBendShare = 0.3;

/// A bone at least this long, in radii, is a limb's: its boundaries are perpendicular to it.
constexpr double kSlenderLength = 2.8;

/// The condition on x, the cotangent of the angle at which the segment meets the upper plane.
///
/// A segment at that angle A has the length a / sin A + b / sin(A + angle), with the distances a
/// and b to the upper and lower plane. It is convex in A, so there is one minimum. Setting the
/// derivative to zero and substituting x gives
///
///     a x (x s + c)^2 + b (x c - s) = 0,    s = sin(angle), c = cos(angle),
///
/// a cubic with one root where x >= 0 and x s + c > 0 (the segment meets both planes).
struct Cubic {
    double a, b, s, c;

    double value(double x) const {
        const double m = x * s + c;
        return a * x * m * m + b * (x * c - s);
    }
    double slope(double x) const {
        const double m = x * s + c;
        return a * m * (m + 2.0 * x * s) + b * c;
    }
};

double root(const Cubic& cubic) {
    // The value is negative below the root and positive above it.
    double low = std::max(0.0, -cubic.c / cubic.s);
    double high = 2.0 * low + 1.0;
    while (cubic.value(high) < 0.0) high *= 2.0;
    double x = 0.5 * (low + high);
    for (int step = 0; step < kMaxSteps; ++step) {
        const double value = cubic.value(x);
        (value < 0.0 ? low : high) = x;
        const double slope = cubic.slope(x);
        double next = slope > 0.0 ? x - value / slope : low;
        if (!(next > low && next < high)) next = 0.5 * (low + high);
        if (std::abs(next - x) <= kStepTolerance * (1.0 + x)) return next;
        x = next;
    }
    return x;
}

double reach(double length, double radius) {
    return radius > 0.0 ? std::min(kBendShare * length, radius) : kBendShare * length;
}

/// The unit of a joint's boundaries; a last joint may have no bone of its own.
double unitLength(const PlannedJoint& joint) {
    return joint.boneLength > 0.0 ? joint.boneLength : joint.lengthAbove;
}

/// True if the author set a boundary of the twist region.
bool hasOwnTwistRegion(const PlannedJoint& joint) {
    return joint.options.twistUpper || joint.options.twistLower;
}

/// A boundary of a bend or twist region (paper, section 3, Fig. 3).
struct BoundaryPlane {
    glm::dvec3 point{0.0};
    glm::dvec3 normal{0.0}; ///< unit, towards the child
};

/// The plane at `along` (in `unit`s) from the joint: negative on the bone above, else on its own.
BoundaryPlane bendPlane(const PlannedJoint& joint, double radius, double along, double unit) {
    const bool above = along < 0.0;
    const glm::dvec3& bone = above ? joint.comingFrom : joint.boneAxis;
    const double length = above ? joint.lengthAbove : joint.boneLength;
    const bool limb = length > kSlenderLength * radius;
    return {joint.centre + along * unit * bone, limb && along != 0.0 ? bone : planeNormal(joint)};
}

/// A bend or twist region as in the paper: the skin between an upper boundary, towards the parent,
/// and a lower one, towards the child.
struct PaperRegion {
    BoundaryPlane upper, lower;

    /// The fraction of the joint's angle that skin at `p` takes: exactly 0 above the upper
    /// boundary, exactly 1 below the lower one, eq. 5 in between.
    ///
    /// Inclined planes intersect on the inner side of the bend. Beyond their intersection a point
    /// is above one plane and below the other; there the ratio is interpolated, so that it is
    /// continuous all around the line of intersection.
    double ratio(const glm::dvec3& p) const {
        const double belowUpper = glm::dot(p - upper.point, upper.normal);
        const double aboveLower = glm::dot(lower.point - p, lower.normal);
        if (belowUpper <= 0.0 && aboveLower >= 0.0) return 0.0;
        if (belowUpper >= 0.0 && aboveLower <= 0.0) return 1.0;
        if (belowUpper < 0.0) return hermiteRatio(aboveLower / (belowUpper + aboveLower));
        // The arc tangent is precise for the nearly parallel planes of a straight limb.
        const double angle = std::atan2(glm::length(glm::cross(upper.normal, lower.normal)),
                                        glm::dot(upper.normal, lower.normal));
        return hermiteRatio(philoShare(belowUpper, aboveLower, angle)); // eq. 5
    }
};

/// A joint's bend region (paper, section 3, Fig. 3): up to a limb's radius, and at most 0.3 bone
/// lengths, to both sides of the joint, unless the author set boundaries. Each boundary cuts its
/// own bone at a right angle, so those of a limb that is bent at rest form a wedge. In the trunk,
/// whose bones are shorter than it is thick, they bisect the angle between the two bones.
PaperRegion bendRegion(const PlannedJoint& joint, double radius) {
    const double unit = unitLength(joint);
    const BoundarySpan span = paperBendSpan(joint, radius);
    return {bendPlane(joint, radius, span.upper, unit), bendPlane(joint, radius, span.lower, unit)};
}

/// A joint's twist region: along the whole pole bone, with boundaries perpendicular to it; a twist
/// about the bone above ends as far beyond the joint as the bend does. A rigid joint, and a joint
/// that leads to no other, twists where it bends.
PaperRegion twistRegion(const PlannedJoint& joint, double radius) {
    const std::optional<BoundarySpan> span = paperTwistSpan(joint, radius);
    if (!span) return bendRegion(joint, radius);
    const glm::dvec3 bone = joint.poleLength * joint.twistAxis;
    return {{joint.centre + span->upper * bone, joint.twistAxis},
            {joint.centre + span->lower * bone, joint.twistAxis}};
}

/// How a region's skin follows a joint.
enum class Follows { Nothing, Planes, Fully };

/// The region that continues the joint's chain; the joint itself if there is none.
std::size_t regionBelow(const std::vector<PlannedJoint>& joints, std::size_t joint) {
    int below = joints[joint].child;
    while (below >= 0 && !joints[static_cast<std::size_t>(below)].holdsRegion())
        below = joints[static_cast<std::size_t>(below)].child;
    return below < 0 ? joint : static_cast<std::size_t>(below);
}

/// For each region, how it follows the joint.
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

double philoShare(double toUpper, double toLower, double angle) {
    const double sum = toUpper + toLower;
    if (!(toUpper > kTinyShare * sum)) return 0.0;
    if (!(toLower > kTinyShare * sum)) return 1.0;
    const double sine = std::sin(angle), cosine = std::cos(angle);
    if (!(sine > 1e-9)) return toUpper / sum;
    const Cubic cubic{toUpper / sum, toLower / sum, sine, cosine};
    // The ratio of the segment's parts is a to b / (x s + c).
    const double lower = cubic.b / (root(cubic) * sine + cosine);
    return cubic.a / (cubic.a + lower);
}

BoundarySpan paperBendSpan(const PlannedJoint& joint, double radius) {
    const double unit = unitLength(joint);
    return chosenSpan(joint.options.bendUpper, joint.options.bendLower,
                      {-reach(joint.lengthAbove, radius) / unit, reach(unit, radius) / unit});
}

std::optional<BoundarySpan> paperTwistSpan(const PlannedJoint& joint, double radius) {
    const bool alongBone = joint.poleIsParent || (!joint.isExtremity() && joint.rigid < 0);
    if (!(joint.poleLength > 0.0) || (!alongBone && !hasOwnTwistRegion(joint))) return std::nullopt;
    const BoundarySpan defaults =
        joint.poleIsParent ? BoundarySpan{-1.0, reach(unitLength(joint), radius) / joint.poleLength}
                           : BoundarySpan{0.0, 1.0};
    return chosenSpan(joint.options.twistUpper, joint.options.twistLower, defaults);
}

PaperFields::PaperFields(const BinaryField& binary, const std::vector<double>& radii) {
    const std::vector<PlannedJoint>& joints = binary.joints;
    const std::size_t vertices = binary.mesh.vertexCount();
    bend = JointFields(joints.size(), vertices);
    bend.set(0, std::vector<double>(vertices, 1.0));
    twist = bend;
    for (std::size_t j = 1; j < joints.size(); ++j) {
        if (!joints[j].holdsRegion()) continue;
        const std::vector<Follows> regions = followersOf(joints, j);
        const PaperRegion bendAt = bendRegion(joints[j], radii[j]);
        const PaperRegion twistAt = twistRegion(joints[j], radii[j]);
        // By default skin twists with its own bone only: a thigh's planes must not reach across the
        // crotch.
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
