// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapes/ShapedJoint.h"

#include "joints/BodyAxes.h"
#include "ratios/JointRatios.h"
#include "regions/HermiteRatio.h"
#include "shapes/BendRange.h"
#include "shapes/MainAxis.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace osgSkin {
namespace {

/// A limb's bones are at least this many radii long.
constexpr double kLimbLength = 2.2;

/// A limb begins beside another one where their joints are no farther apart, in radii.
constexpr double kBeside = 3.0;

/// Sines of a limb's angle over where it rests, away from the trunk, with which its pit is open,
/// and closed.
constexpr double kOpen = 0.75, kClosed = -0.25;

/// Sine of the angle up to which two directions count as one.
constexpr double kLeastAcross = 0.1;

/// Of a joint at the trunk, skin that follows it by less is taken for the trunk's.
constexpr double kTrunkFollows = 0.25;

/// Of fewer vertices no shape can be made.
constexpr std::size_t kLeastVertices = 16;

/// The limb's radius where it bends: the median distance to the bone's line of the edges that the
/// bend ratio 1/2 crosses; 0 where there is none.
double radiusAt(const PlannedJoint& planned, const WeldedMesh& mesh,
                const std::vector<double>& bend) {
    std::vector<double> radii;
    for (std::uint32_t v = 0; v < mesh.vertexCount(); ++v) {
        if (bend[v] < 0.5) continue;
        for (std::uint32_t i = mesh.firstNeighbour[v]; i < mesh.firstNeighbour[v + 1]; ++i) {
            const std::uint32_t next = mesh.neighbours[i];
            if (bend[next] >= 0.5) continue;
            const glm::dvec3 d = 0.5 * (mesh.positions[v] + mesh.positions[next]) - planned.centre;
            radii.push_back(glm::length(d - planned.boneAxis * glm::dot(d, planned.boneAxis)));
        }
    }
    if (radii.size() < 4) return 0.0;
    const auto middle = radii.begin() + static_cast<std::ptrdiff_t>(radii.size() / 2);
    std::nth_element(radii.begin(), middle, radii.end());
    return *middle;
}

/// For each joint whether it is a head, a hand or a foot, or below one. Fingers and toes are no
/// limbs, even where they are long for their radius.
std::vector<bool> withinExtremities(const std::vector<PlannedJoint>& joints) {
    std::vector<bool> within(joints.size());
    for (std::size_t j = 0; j < joints.size(); ++j)
        within[j] = joints[j].extremity ||
                    (joints[j].parent >= 0 && within[static_cast<std::size_t>(joints[j].parent)]);
    return within;
}

/// Whether faces look inwards: volumes count as if they did not.
bool isInsideOut(const WeldedMesh& mesh) {
    if (mesh.positions.empty()) return false;
    const glm::dvec3 from = mesh.positions.front();
    double volume = 0.0;
    for (const std::array<std::uint32_t, 3>& t : mesh.triangles)
        volume += glm::dot(mesh.positions[t[0]] - from,
                           glm::cross(mesh.positions[t[1]] - from, mesh.positions[t[2]] - from));
    return volume < 0.0;
}

/// A direction of the body's across a joint's twist axis: where the root lies, or where the bone
/// above comes from.
glm::dvec3 acrossOf(const std::vector<PlannedJoint>& joints, std::size_t joint) {
    const PlannedJoint& planned = joints[joint];
    const glm::dvec3 fromRoot = planned.centre - joints[0].centre;
    const bool isAlong =
        glm::length(glm::cross(fromRoot, planned.twistAxis)) < kLeastAcross * glm::length(fromRoot);
    return isAlong ? planned.comingFrom : fromRoot;
}

/// Whether another limb begins at the trunk beside a joint's.
bool isBesideLimb(const std::vector<ShapedJoint>& all, const ShapedJoint& shaped) {
    return std::any_of(all.begin(), all.end(), [&](const ShapedJoint& other) {
        return &other != &shaped && other.isAtTrunk() &&
               glm::distance(other.centre, shaped.centre) < kBeside * shaped.radius;
    });
}

/// The side of a limb that the root lies on, where it lies on one.
ShapePit pitOf(const glm::dvec3& root, const ShapedJoint& shaped, const ShapeReach& reach) {
    ShapePit pit{reach};
    const glm::dvec3 fromRoot = shaped.centre - root;
    const glm::dvec3 across = fromRoot - shaped.bone * glm::dot(fromRoot, shaped.bone);
    const double length = glm::length(across);
    if (length > kLeastAcross * glm::length(fromRoot)) pit.away = across / length;
    return pit;
}

/// Adds the vertices and triangles within reach, and in a pit within the pit's.
void addSkin(const WeldedMesh& mesh, const std::vector<PlannedJoint>& joints,
             const JointRatios& ratios, bool trunkToo, bool insideOut, const ShapeReach& reach,
             const ShapePit& pit, ShapedJoint& shaped) {
    constexpr std::uint32_t kNone = 0xffffffffu;
    std::vector<std::uint32_t> placeOf(mesh.vertexCount(), kNone);
    const auto above = static_cast<std::uint32_t>(regionAbove(joints, shaped.functions.joint));
    shaped.away = pit.away;
    const auto limbOf = [&](std::uint32_t v, const Influence& own) {
        if (shaped.isAtTrunk())
            return trunkToo ? 1.0 : hermiteRatio(static_cast<double>(own.bend) / kTrunkFollows);
        return above == 0 ? 1.0 : ratios.bend(v, above);
    };
    const auto add = [&](std::uint32_t v, bool withinReach) {
        const glm::dvec3 from = mesh.positions[v] - shaped.centre;
        const double r = glm::length(from) / shaped.radius;
        const Influence own = ratios.of(v, shaped.functions.joint);
        const double limb = limbOf(v, own);
        // Where skin meets a rigid part, nothing may move them apart.
        const double loose = 1.0 - ratios.rigid(v, joints);
        const double fade = reach.shareAt(r) * loose;
        const double fadeClosed = reachTowards(from, reach, pit).shareAt(r) * loose;
        if (withinReach && (limb <= 0.0 || fade <= 0.0)) return;
        placeOf[v] = static_cast<std::uint32_t>(shaped.vertices.size());
        shaped.vertices.push_back({v, from, static_cast<double>(own.bend),
                                   static_cast<double>(own.twist), limb, withinReach ? fade : 0.0,
                                   withinReach ? fadeClosed : 0.0});
    };
    for (std::uint32_t v = 0; v < mesh.vertexCount(); ++v) add(v, true);
    const auto within = static_cast<std::uint32_t>(shaped.vertices.size());
    for (const std::array<std::uint32_t, 3>& triangle : mesh.triangles) {
        if (std::none_of(triangle.begin(), triangle.end(),
                         [&](std::uint32_t v) { return placeOf[v] < within; }))
            continue;
        for (const std::uint32_t v : triangle)
            if (placeOf[v] == kNone) add(v, false);
        const std::uint32_t second = placeOf[triangle[insideOut ? 2 : 1]];
        const std::uint32_t third = placeOf[triangle[insideOut ? 1 : 2]];
        shaped.triangles.push_back({placeOf[triangle[0]], second, third});
    }
}

} // namespace

double ShapedJoint::pitClosedAt(const BendTwist& bend) const {
    const double raised = glm::dot(partialRotation(bend, twistAxis, 1.0, 1.0) * bone, away);
    return hermiteRatio((kOpen - raised) / (kOpen - kClosed));
}

std::vector<ShapedJoint> findShapedJoints(const RestSkeleton& skeleton,
                                          const std::vector<PlannedJoint>& joints,
                                          const WeldedMesh& mesh, const Binding& binding,
                                          const ShapeScope& scope) {
    const JointRatios ratios(mesh, binding);
    const std::vector<bool> trunk = trunkByShape(joints, mesh.size);
    const bool insideOut = isInsideOut(mesh);
    std::vector<ShapedJoint> result;
    const std::vector<bool> extremities = withinExtremities(joints);
    std::vector<double> bend(mesh.vertexCount());
    for (std::uint32_t j = 1; j < joints.size(); ++j) {
        const PlannedJoint& planned = joints[j];
        if (trunk[j] || extremities[j] || planned.rigid >= 0 || !planned.holdsRegion) continue;
        const auto above = static_cast<std::uint32_t>(regionAbove(joints, j));
        const bool atTrunk = trunk[above];
        for (std::uint32_t v = 0; v < bend.size(); ++v) bend[v] = ratios.bend(v, j);
        ShapedJoint shaped;
        shaped.radius = radiusAt(planned, mesh, bend);
        if (!(shaped.radius > 0.0) || planned.boneLength < kLimbLength * shaped.radius ||
            (!atTrunk && planned.lengthAbove < kLimbLength * shaped.radius))
            continue;
        shaped.centre = planned.centre;
        shaped.twistAxis = binding.joints[j].twistAxis;
        // What is above a shoulder or a hip is no limb: there the rest pose counts as straight.
        shaped.above = atTrunk ? planned.boneAxis : planned.comingFrom;
        shaped.bone = planned.boneAxis;
        shaped.functions.joint = j;
        if (atTrunk)
            setBallRange(acrossOf(joints, j), shaped, scope.mostSwing);
        else {
            const std::optional<glm::dvec3> mainAxis = findMainAxis(skeleton, joints, j);
            setBendRange(mainAxis, acrossOf(joints, j), shaped, scope.mostFlexion, scope.knotStep);
            if (mainAxis) shaped.hinge = findHinge(skeleton, joints, j, *mainAxis);
        }
        result.push_back(std::move(shaped));
    }
    for (ShapedJoint& shaped : result) {
        const bool beside = shaped.isAtTrunk() && isBesideLimb(result, shaped);
        const ShapeReach& reach = !shaped.isAtTrunk() ? scope.betweenLimbs
                                  : beside            ? scope.besideLimb
                                                      : scope.atTrunk;
        ShapePit pit{reach};
        if (shaped.isAtTrunk() && !beside) pit = pitOf(joints[0].centre, shaped, scope.inPit);
        addSkin(mesh, joints, ratios, scope.trunkToo, insideOut, reach, pit, shaped);
    }
    result.erase(std::remove_if(result.begin(), result.end(),
                                [](const ShapedJoint& shaped) {
                                    return shaped.vertices.size() < kLeastVertices;
                                }),
                 result.end());
    return result;
}

} // namespace osgSkin
