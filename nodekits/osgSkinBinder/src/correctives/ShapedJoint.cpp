// SPDX-License-Identifier: GPL-3.0-or-later
#include "correctives/ShapedJoint.h"

#include "joints/BodyAxes.h"
#include "mesh/CoarseGraph.h"
#include "mesh/Parallel.h"
#include "ratios/JointRatios.h"
#include "regions/HermiteRatio.h"

#include <osgSkin/GlmTypes>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace osgSkin {
namespace {

/// A limb's bones are at least this many radii long.
constexpr double kLimbLength = 2.2;

/// Sine of the angle up to which two directions count as parallel.
constexpr double kMinAcross = 0.1;

/// Skin that follows a joint at the trunk by less counts as the trunk's.
constexpr double kTrunkFollows = 0.25;

/// Joints with fewer vertices are not shaped.
constexpr std::size_t kMinVertices = 16;

/// The limb's radius where it bends: the median distance from the bone's line of edges at which the
/// bend ratio crosses 1/2; 0 if there are none.
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
/// limbs, even if they are long for their radius.
std::vector<bool> withinExtremities(const std::vector<PlannedJoint>& joints) {
    std::vector<bool> within(joints.size());
    for (std::size_t j = 0; j < joints.size(); ++j)
        within[j] = joints[j].isExtremity() ||
                    (joints[j].parent >= 0 && within[static_cast<std::size_t>(joints[j].parent)]);
    return within;
}

/// Whether faces look inwards.
bool isInsideOut(const WeldedMesh& mesh) {
    if (mesh.positions.empty()) return false;
    const glm::dvec3 from = mesh.positions.front();
    double volume = 0.0;
    for (const std::array<std::uint32_t, 3>& t : mesh.triangles)
        volume += glm::dot(mesh.positions[t[0]] - from,
                           glm::cross(mesh.positions[t[1]] - from, mesh.positions[t[2]] - from));
    return volume < 0.0;
}

/// A direction of the body across a joint's twist axis: from the root, or that of the bone above.
glm::dvec3 acrossOf(const std::vector<PlannedJoint>& joints, std::size_t joint) {
    const PlannedJoint& planned = joints[joint];
    const glm::dvec3 fromRoot = planned.centre - joints[0].centre;
    const bool isAlong =
        glm::length(glm::cross(fromRoot, planned.twistAxis)) < kMinAcross * glm::length(fromRoot);
    return isAlong ? planned.comingFrom : fromRoot;
}

/// Adds the vertices and triangles within reach.
void addSkin(const WeldedMesh& mesh, const std::vector<PlannedJoint>& joints,
             const JointRatios& ratios, bool insideOut, const ShapeReach& reach,
             ShapedJoint& shaped) {
    constexpr std::uint32_t kNone = 0xffffffffu;
    std::vector<std::uint32_t> placeOf(mesh.vertexCount(), kNone);
    const auto above = static_cast<std::uint32_t>(regionAbove(joints, shaped.functions.joint));
    const bool isShoulder =
        shaped.isAtTrunk() && carries(joints, shaped.functions.joint, JointPart::Hand);
    const double trunkWithin = isShoulder ? ShapedJoint::kTissueReach : 0.0;
    const auto limbOf = [&](std::uint32_t v, const Influence& own) {
        if (shaped.isAtTrunk())
            return shaped.isSoft ? 1.0
                                 : hermiteRatio(static_cast<double>(own.bend) / kTrunkFollows);
        return above == 0 ? 1.0 : ratios.bend(v, above);
    };
    const auto add = [&](std::uint32_t v, bool withinReach) {
        const glm::dvec3 from = mesh.positions[v] - shaped.centre;
        const double r = glm::length(from) / shaped.radius;
        if (withinReach && r >= reach.end) return;
        const Influence own = ratios.of(v, shaped.functions.joint);
        const double limb = limbOf(v, own);
        // Nothing may separate the skin from a rigid part that it meets.
        const double loose = 1.0 - ratios.rigid(v, joints);
        const double fade = reach.shareAt(r) * loose;
        if (withinReach && ((limb <= 0.0 && r >= trunkWithin) || fade <= 0.0)) return;
        placeOf[v] = static_cast<std::uint32_t>(shaped.vertices.size());
        shaped.vertices.push_back({v, from, static_cast<double>(own.bend),
                                   static_cast<double>(own.twist), limb, withinReach ? fade : 0.0});
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

/// The reach of joints of limbs.
constexpr ShapeReach kReach{4.5, 6.0};

/// Angles are in degrees. How far a hinge bends beyond straight and sideways.
constexpr double kBeyondStraight = 12.0;
constexpr double kMaxSideways = 30.0;
/// Between the flexions at which a hinge is also bent sideways.
constexpr double kSidewaysStep = 30.0;
/// How far a hinge rotates about the limb, and between samples of that.
constexpr double kTurn = 32.0;
constexpr double kTurnStep = 16.0;
/// The share of a coordinate's range in which it is not clamped.
constexpr double kNotClamped = 0.9;
constexpr double kKnotStep = 30.0; ///< at most
constexpr double kRoundKnotStep = 20.0;
constexpr double kSampleStep = 15.0;
constexpr double kRoundSampleStep = 10.0;
constexpr double kBallSampleStep = 15.0;
constexpr int kDirections = 12;

/// How the skin of people's joints moves, fitted to captured people (README.md, "Like captured
/// people"): ShapedJoint::slide and ShapedJoint::relaxation.
struct SkinMotion {
    double slide, relaxation;
};
constexpr double kCrease = 0.35; ///< relaxation of joints between limbs, and of those at the trunk
constexpr SkinMotion kShoulder{0.33, kCrease}, kElbow{0.18, kCrease}, kWrist{0.45, 0.5};
constexpr SkinMotion kHip{0.19, kCrease}, kKnee{0.10, kCrease}, kAnkle{0.2, 1.0};
constexpr SkinMotion kNeck{0.5, 0.5}, kCollarBone{0.0, 0.8};
constexpr SkinMotion kNone{0.0, 0.0};

/// The slide of an arm grows to the whole between these lengths of its bone, in radii. Captured
/// adults' arms are longer than that. A baby's skin would slide over the whole shoulder and fold.
constexpr double kStubbyArm = 2.0, kSlenderArm = 4.3;

SkinMotion motionOfLimb(const std::vector<PlannedJoint>& joints, std::size_t joint, bool atTrunk) {
    if (carries(joints, joint, JointPart::Hand)) return atTrunk ? kShoulder : kElbow;
    if (carries(joints, joint, JointPart::Foot)) return atTrunk ? kHip : kKnee;
    return kNone;
}

SkinMotion softMotion(const std::vector<PlannedJoint>& joints, std::size_t joint) {
    const PlannedJoint& planned = joints[joint];
    if (planned.isCollarBone()) return kCollarBone;
    if (planned.isExtremity())
        return planned.part == JointPart::Hand   ? kWrist
               : planned.part == JointPart::Foot ? kAnkle
                                                 : kNone;
    const bool isNeck = planned.kind == JointKind::Limb && carries(joints, joint, JointPart::Head);
    return isNeck ? kNeck : kNone;
}

/// The reach of soft joints, how far they bend in degrees, and the share of a rigid part from which
/// skin follows it unchanged.
constexpr ShapeReach kSoftReach{3.5, 4.5};
constexpr double kMaxSoftSwing = 90.0;
constexpr double kRigidFrom = 0.85;

double sineOfHalf(double degrees) {
    return std::sin(glm::radians(0.5 * degrees));
}

double degreesOf(double sineOfHalfAngle) {
    return glm::degrees(2.0 * std::asin(sineOfHalfAngle));
}

/// Even values from `from` to `to`, at most `step` apart.
std::vector<double> steps(double from, double to, double step) {
    const int count = std::max(1, static_cast<int>(std::ceil((to - from) / step - 1e-9)));
    std::vector<double> result;
    for (int i = 0; i <= count; ++i) result.push_back(from + (to - from) * i / count);
    return result;
}

void setHinge(const glm::dvec3& axis, double mostFlexion, ShapedJoint& joint) {
    const double atRest = glm::degrees(std::atan2(
        glm::dot(glm::cross(joint.above, joint.bone), axis), glm::dot(joint.above, joint.bone)));
    const double most = std::clamp(mostFlexion - atRest, 30.0, 170.0);
    const double least = -std::clamp(kBeyondStraight + atRest, 15.0, 90.0);
    CorrectiveJoint& functions = joint.functions;
    functions.basis = CorrectiveJoint::Basis::Hinge;
    functions.axis = axis;
    functions.low = {sineOfHalf(least), -sineOfHalf(kMaxSideways)};
    functions.high = {sineOfHalf(most), sineOfHalf(kMaxSideways)};
    for (const double angle : steps(least, most, kKnotStep))
        functions.knots.push_back(sineOfHalf(angle));
}

glm::dvec3 perpendicular(const glm::dvec3& across, const glm::dvec3& w) {
    const glm::dvec3 result = across - glm::dot(across, w) * w;
    const double length = glm::length(result);
    return length > 1e-3 * glm::length(across) ? result / length : anyPerpendicular(w);
}

void setRound(double mostFlexion, const glm::dvec3& across, ShapedJoint& joint) {
    CorrectiveJoint& functions = joint.functions;
    const double most = sineOfHalf(mostFlexion);
    functions.basis = CorrectiveJoint::Basis::Round;
    functions.axis = perpendicular(across, joint.twistAxis);
    functions.low = glm::dvec2(-most);
    functions.high = glm::dvec2(most);
    for (const double angle : steps(0.0, mostFlexion, kRoundKnotStep))
        functions.knots.push_back(sineOfHalf(angle) * sineOfHalf(angle));
}

/// Sines of the rest pose's bend beyond which it gives the main axis: always (12 degrees), and if
/// nothing better is known (3 degrees).
constexpr double kPlain = 0.21;
constexpr double kFaint = 0.052;

/// Cosine of the largest angle between a knee's axis and its main axis.
constexpr double kMinAlong = 0.9;

enum class End { None, Hand, Foot };

/// The first hand or foot below the joint.
End endOf(const RestSkeleton& skeleton, const std::vector<PlannedJoint>& joints,
          std::size_t joint) {
    for (std::size_t j = joint + 1; j < skeleton.joints.size(); ++j) {
        if (!skeleton.isInSubtree(static_cast<int>(j), static_cast<int>(joint))) continue;
        if (joints[j].part == JointPart::Hand) return End::Hand;
        if (joints[j].part == JointPart::Foot) return End::Foot;
    }
    return End::None;
}

double bendAtRest(const PlannedJoint& joint) {
    return glm::length(glm::cross(joint.comingFrom, joint.boneAxis));
}

/// Whether a joint between a trunk and a hand or foot is straight and the limb bends elsewhere: at
/// the joint that is bent at rest or, if none is, at the middle. Bones that share a limb's twist
/// begin at such joints.
bool isTwistBone(const std::vector<PlannedJoint>& joints, std::size_t joint) {
    if (bendAtRest(joints[joint]) > kFaint) return false;
    const auto isLimb = [&](int j) {
        return j >= 0 && joints[static_cast<std::size_t>(j)].kind == JointKind::Limb;
    };
    int j = static_cast<int>(joint);
    while (isLimb(joints[static_cast<std::size_t>(j)].parent))
        j = joints[static_cast<std::size_t>(j)].parent;
    std::vector<std::size_t> limb;
    std::vector<double> begins;
    double length = 0.0;
    for (; isLimb(j); j = joints[limb.back()].child) {
        limb.push_back(static_cast<std::size_t>(j));
        begins.push_back(length);
        length += joints[limb.back()].boneLength;
    }
    if (j < 0 || limb.size() < 3) return false; // no hand or foot, or one joint in between
    std::size_t bends = 1;
    const bool isBent = std::any_of(limb.begin() + 1, limb.end(), [&](std::size_t each) {
        return bendAtRest(joints[each]) > kPlain;
    });
    for (std::size_t i = 2; i < limb.size(); ++i)
        if (isBent ? bendAtRest(joints[limb[i]]) > bendAtRest(joints[limb[bends]])
                   : std::abs(begins[i] - 0.5 * length) < std::abs(begins[bends] - 0.5 * length))
            bends = i;
    return joint != limb.front() && joint != limb[bends];
}

} // namespace

double ShapeReach::shareAt(double radii) const {
    return 1.0 - hermiteRatio((radii - whole) / (end - whole));
}

std::vector<glm::dquat> ShapedJoint::turnsOf(const BendTwist& bend) const {
    const glm::dquat none(1.0, 0.0, 0.0, 0.0);
    const glm::dquat whole = partialRotation(bend, twistAxis, 1.0, 1.0);
    const bool twists = std::abs(bend.twistAngle) > 1e-9;
    std::vector<glm::dquat> turns;
    turns.reserve(vertices.size());
    for (const Vertex& vertex : vertices) {
        const auto takes = [&](double share) { // most vertices take all of it or nothing
            return vertex.bend == share && (!twists || vertex.twist == share);
        };
        turns.push_back(takes(0.0) ? none : takes(1.0) ? whole : turnOf(vertex, bend));
    }
    return turns;
}

std::vector<ShapedJoint> findShapedJoints(const RestSkeleton& skeleton,
                                          const std::vector<PlannedJoint>& joints,
                                          const WeldedMesh& mesh, const Binding& binding) {
    const JointRatios ratios(mesh, binding);
    const std::vector<bool> trunk = trunkByShape(joints, mesh.size);
    const bool insideOut = isInsideOut(mesh);
    std::vector<ShapedJoint> result;
    const std::vector<bool> extremities = withinExtremities(joints);
    std::vector<double> bend(mesh.vertexCount());
    for (std::uint32_t j = 1; j < joints.size(); ++j) {
        const PlannedJoint& planned = joints[j];
        if (trunk[j] || extremities[j] || planned.rigid >= 0 || !planned.holdsRegion()) continue;
        const auto above = static_cast<std::uint32_t>(regionAbove(joints, j));
        const bool atTrunk = trunk[above];
        if (!atTrunk && isTwistBone(joints, j)) continue;
        for (std::uint32_t v = 0; v < bend.size(); ++v) bend[v] = ratios.bend(v, j);
        ShapedJoint shaped;
        shaped.radius = radiusAt(planned, mesh, bend);
        if (!(shaped.radius > 0.0) || planned.boneLength < kLimbLength * shaped.radius ||
            (!atTrunk && planned.lengthAbove < kLimbLength * shaped.radius))
            continue;
        shaped.centre = planned.centre;
        shaped.twistAxis = binding.joints[j].twistAxis;
        // No limb is above a shoulder or a hip: there the rest pose counts as straight.
        shaped.above = atTrunk ? planned.boneAxis : planned.comingFrom;
        shaped.bone = planned.boneAxis;
        shaped.functions.joint = j;
        const SkinMotion motion = motionOfLimb(joints, j, atTrunk);
        shaped.slide = motion.slide;
        if (atTrunk && carries(joints, j, JointPart::Hand))
            shaped.slide *= hermiteRatio((planned.boneLength / shaped.radius - kStubbyArm) /
                                         (kSlenderArm - kStubbyArm));
        shaped.relaxation = motion.relaxation;
        if (atTrunk) {
            setBallRange(acrossOf(joints, j), shaped);
        } else {
            const std::optional<glm::dvec3> mainAxis = findMainAxis(skeleton, joints, j);
            setBendRange(mainAxis, acrossOf(joints, j), shaped);
            if (mainAxis) shaped.hinge = findHinge(skeleton, joints, j, *mainAxis);
        }
        result.push_back(std::move(shaped));
    }
    parallelFor(result.size(), [&](std::size_t i) {
        addSkin(mesh, joints, ratios, insideOut, kReach, result[i]);
    });
    result.erase(std::remove_if(result.begin(), result.end(),
                                [](const ShapedJoint& shaped) {
                                    return shaped.vertices.size() < kMinVertices;
                                }),
                 result.end());
    return result;
}

std::vector<ShapedJoint> findSoftJoints(const std::vector<PlannedJoint>& joints,
                                        const WeldedMesh& mesh, const Binding& binding) {
    const JointRatios ratios(mesh, binding);
    const bool insideOut = isInsideOut(mesh);
    std::vector<ShapedJoint> result;
    std::vector<double> bend(mesh.vertexCount());
    for (std::uint32_t j = 1; j < joints.size(); ++j) {
        const PlannedJoint& planned = joints[j];
        if (!planned.holdsRegion()) continue;
        const SkinMotion motion = softMotion(joints, j);
        if (!(motion.relaxation > 0.0)) continue;
        for (std::uint32_t v = 0; v < bend.size(); ++v) bend[v] = ratios.bend(v, j);
        ShapedJoint shaped;
        shaped.radius = radiusAt(planned, mesh, bend);
        if (!(shaped.radius > 0.0)) continue;
        shaped.isSoft = true;
        shaped.slide = motion.slide;
        shaped.relaxation = motion.relaxation;
        shaped.centre = planned.centre;
        shaped.twistAxis = binding.joints[j].twistAxis;
        shaped.above = shaped.bone = planned.boneAxis;
        shaped.functions.joint = j;
        setBallRange(acrossOf(joints, j), shaped, kMaxSoftSwing);
        addSkin(mesh, joints, ratios, insideOut, kSoftReach, shaped);
        for (ShapedJoint::Vertex& vertex : shaped.vertices) {
            // addSkin() lets go of rigid parts already where they begin, which here is halfway.
            // Heads, hands and feet may be split off later.
            double rigid = ratios.rigid(vertex.index, joints);
            if (planned.isExtremity()) rigid = std::max(rigid, vertex.bend);
            if (vertex.fade > 0.0)
                vertex.fade = kSoftReach.shareAt(glm::length(vertex.from) / shaped.radius) *
                              hermiteRatio((1.0 - rigid) / (1.0 - kRigidFrom));
        }
        if (shaped.vertices.size() >= kMinVertices) result.push_back(std::move(shaped));
    }
    return result;
}

ShapedJoint coarserJoint(const ShapedJoint& joint, const CoarseGraph& coarser) {
    ShapedJoint result = joint;
    result.vertices.clear();
    result.triangles = coarser.graph().triangles;
    const auto restricted = [&](double ShapedJoint::Vertex::*member) {
        std::vector<double> field;
        for (const ShapedJoint::Vertex& vertex : joint.vertices) field.push_back(vertex.*member);
        return coarser.restricted(field);
    };
    using Vertex = ShapedJoint::Vertex;
    const std::vector<double> bend = restricted(&Vertex::bend), twist = restricted(&Vertex::twist),
                              limb = restricted(&Vertex::limb), fade = restricted(&Vertex::fade);
    for (std::uint32_t v = 0; v < bend.size(); ++v)
        result.vertices.push_back(
            {v, coarser.graph().positions[v], bend[v], twist[v], limb[v], fade[v]});
    for (ShapedJoint::Tissue& tissue : result.tissues) {
        const std::vector<glm::dvec3> fine = std::move(tissue.moves);
        tissue.moves.assign(bend.size(), glm::dvec3(0.0));
        std::vector<double> field(fine.size());
        for (int axis = 0; axis < 3; ++axis) {
            for (std::size_t v = 0; v < field.size(); ++v) field[v] = fine[v][axis];
            const std::vector<double> coarse = coarser.restricted(field);
            for (std::size_t v = 0; v < coarse.size(); ++v) tissue.moves[v][axis] = coarse[v];
        }
    }
    return result;
}

void setBendRange(const std::optional<glm::dvec3>& mainAxis, const glm::dvec3& across,
                  ShapedJoint& joint, double mostFlexion) {
    if (mainAxis)
        setHinge(*mainAxis, mostFlexion, joint);
    else
        setRound(mostFlexion, across, joint);
}

void setBallRange(const glm::dvec3& across, ShapedJoint& joint, double mostSwing) {
    CorrectiveJoint& functions = joint.functions;
    functions.basis = CorrectiveJoint::Basis::Ball;
    functions.axis = perpendicular(across, joint.twistAxis);
    functions.low = glm::dvec2(-sineOfHalf(mostSwing));
    functions.high = -functions.low;
}

void setTurnedHinge(ShapedJoint& joint) {
    CorrectiveJoint& functions = joint.functions;
    functions.basis = CorrectiveJoint::Basis::TurnedHinge;
    double low = functions.low.y, high = functions.high.y;
    for (const BendTwist& bend : turnedBends(joint)) {
        const double y = functions.coordinates(bend.bendAxis, bend.bendAngle, joint.twistAxis).y;
        low = std::min(low, y / kNotClamped);
        high = std::max(high, y / kNotClamped);
    }
    functions.low.y = low;
    functions.high.y = high;
}

std::vector<BendTwist> turnedBends(const ShapedJoint& joint) {
    const CorrectiveJoint& functions = joint.functions;
    std::vector<BendTwist> bends;
    for (const double angle :
         steps(degreesOf(functions.low.x), degreesOf(functions.high.x), kSampleStep)) {
        if (std::abs(angle) < 1.0) continue;
        const glm::dquat bent = glm::angleAxis(glm::radians(angle), joint.hinge);
        for (const double turn : steps(-kTurn, kTurn, kTurnStep))
            bends.push_back(splitBendTwist(glm::angleAxis(glm::radians(turn), joint.above) * bent *
                                               glm::angleAxis(glm::radians(-turn), joint.bone),
                                           joint.twistAxis));
    }
    return bends;
}

std::vector<glm::dvec2> bendSamples(const ShapedJoint& joint) {
    const CorrectiveJoint& functions = joint.functions;
    std::vector<glm::dvec2> samples;
    if (functions.basis == CorrectiveJoint::Basis::Hinge) {
        const double least = degreesOf(functions.low.x), most = degreesOf(functions.high.x);
        for (const double angle : steps(least, most, kSampleStep))
            if (std::abs(angle) > 1.0) samples.emplace_back(sineOfHalf(angle), 0.0);
        for (const double angle : steps(least, most, kSidewaysStep))
            for (const double side : {functions.low.y, functions.high.y}) {
                const glm::dvec2 xy(sineOfHalf(angle), 0.75 * side);
                samples.push_back(xy * std::min(1.0, 0.99 / glm::length(xy)));
            }
        return samples;
    }
    const double step =
        functions.basis == CorrectiveJoint::Basis::Ball ? kBallSampleStep : kRoundSampleStep;
    for (const double angle : steps(0.0, degreesOf(functions.high.x), step))
        for (int i = 0; angle > 0.0 && i < kDirections; ++i) {
            const double direction = 2.0 * glm::pi<double>() * i / kDirections;
            samples.push_back(sineOfHalf(angle) *
                              glm::dvec2(std::cos(direction), std::sin(direction)));
        }
    return samples;
}

std::optional<glm::dvec3> findMainAxis(const RestSkeleton& skeleton,
                                       const std::vector<PlannedJoint>& joints, std::size_t joint) {
    const PlannedJoint& planned = joints[joint];
    const auto acrossTwist = [&planned](const glm::dvec3& axis) {
        return glm::normalize(axis - planned.twistAxis * glm::dot(axis, planned.twistAxis));
    };
    const glm::dvec3 atRest = glm::cross(planned.comingFrom, planned.boneAxis);
    const double sine = glm::length(atRest);
    if (sine > kPlain) return acrossTwist(atRest);
    const End end = endOf(skeleton, joints, joint);
    const glm::dvec3 front = facing(joints);
    if (end != End::None && glm::length(front) > 1e-6) {
        const glm::dvec3 axis = glm::cross(planned.boneAxis, end == End::Hand ? front : -front);
        if (glm::length(axis) > 0.3 * glm::length(front)) return acrossTwist(axis);
    }
    if (end != End::None && sine > kFaint) return acrossTwist(atRest);
    return std::nullopt;
}

glm::dvec3 findHinge(const RestSkeleton& skeleton, const std::vector<PlannedJoint>& joints,
                     std::size_t joint, const glm::dvec3& mainAxis) {
    const std::optional<BodyAxes> body = bodyAxes(joints);
    if (!body || endOf(skeleton, joints, joint) != End::Foot) return mainAxis;
    const glm::dvec3 across = glm::cross(body->up, body->front);
    const double along = glm::dot(across, mainAxis);
    if (std::abs(along) < kMinAlong) return mainAxis;
    return glm::normalize(mainAxis + std::copysign(1.0, along) * across);
}

} // namespace osgSkin
