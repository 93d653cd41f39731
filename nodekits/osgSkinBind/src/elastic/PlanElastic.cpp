// SPDX-License-Identifier: GPL-3.0-or-later
#include "elastic/PlanElastic.h"

#include "elastic/ElasticSamples.h"
#include "ratios/JointRatios.h"

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include <cmath>

namespace osgSkin {
namespace {

using Basis = CorrectiveJoint::Basis;

/// Beyond this a knee's solid begins to tangle; degrees from the straight limb.
constexpr double kMostFlexion = 139.0;

/// Of a ball joint, degrees from the rest pose: beyond it limbs meet what is not their fold's.
constexpr double kMostSwing = 90.0;

/// How far shapes reach, in radii. A hinge's fold needs as much as is solved. At the trunk other
/// limbs are near, which the flesh that is solved does not know of: hands beside thighs above all,
/// and in armpits, while the arm is not raised, the trunk itself.
constexpr ShapeReach kBetweenLimbs{0.75 * ElasticJoint::kHingeReach, ElasticJoint::kHingeReach};
constexpr ShapeReach kAtTrunk{2.0, ElasticJoint::kBallReach};
constexpr ShapeReach kBesideLimb{2.0, 3.0};
constexpr ShapeReach kInPit{1.5, 2.25};

/// Of a hinge's functions, degrees: farther apart, they blur where flesh meets flesh; nearer than
/// the samples, nothing would hold them.
constexpr double kKnotStep = 20.0;

std::vector<ElasticBone> bonesOf(const RestSkeleton& skeleton, int joint) {
    std::vector<ElasticBone> bones;
    for (std::size_t j = 0; j < skeleton.joints.size(); ++j) {
        const RestJoint& each = skeleton.joints[j];
        if (each.tip)
            bones.push_back(
                {each.centre, *each.tip, skeleton.isInSubtree(static_cast<int>(j), joint)});
        if (each.parent >= 0)
            bones.push_back({skeleton.joints[static_cast<std::size_t>(each.parent)].centre,
                             each.centre, skeleton.isInSubtree(each.parent, joint)});
    }
    return bones;
}

double angleOf(double sineOfHalf) {
    return 2.0 * std::asin(sineOfHalf);
}

std::vector<glm::dquat> samplesOf(const ShapedJoint& shaped) {
    const CorrectiveJoint& functions = shaped.functions;
    if (functions.basis != Basis::Hinge)
        return ballSamples(shaped.twistAxis, angleOf(functions.high.x));
    HingeRange range;
    range.axis = functions.axis;
    range.restFlexion = std::atan2(glm::dot(glm::cross(shaped.above, shaped.bone), functions.axis),
                                   glm::dot(shaped.above, shaped.bone));
    range.leastFlexion = range.restFlexion + angleOf(functions.low.x);
    range.mostFlexion = range.restFlexion + angleOf(functions.high.x);
    return hingeSamples(range, shaped.twistAxis);
}

} // namespace

glm::dvec2 ElasticPlan::coordinatesOf(const glm::dquat& rotation) const {
    const glm::dvec3 sine(rotation.x, rotation.y, rotation.z);
    return {glm::dot(sine, shaped.functions.axis),
            glm::dot(sine, glm::cross(shaped.twistAxis, shaped.functions.axis))};
}

std::vector<ElasticPlan> planElastic(const RestSkeleton& skeleton,
                                     const std::vector<PlannedJoint>& joints,
                                     const WeldedMesh& mesh, const Binding& binding) {
    ShapeScope scope;
    scope.betweenLimbs = kBetweenLimbs;
    scope.atTrunk = kAtTrunk;
    scope.besideLimb = kBesideLimb;
    scope.inPit = kInPit;
    scope.trunkToo = true;
    scope.mostFlexion = kMostFlexion;
    scope.knotStep = kKnotStep;
    scope.mostSwing = kMostSwing;
    const JointRatios ratios(mesh, binding);
    std::vector<ElasticPlan> plans;
    for (ShapedJoint& shaped : findShapedJoints(skeleton, joints, mesh, binding, scope)) {
        const CorrectiveJoint& functions = shaped.functions;
        if (functions.basis == Basis::Round) continue;
        ElasticPlan& plan = plans.emplace_back();
        plan.joint.name = skeleton.joints[functions.joint].name;
        plan.joint.centre = shaped.centre;
        plan.joint.radius = shaped.radius;
        plan.joint.hinge = functions.basis == Basis::Hinge;
        plan.joint.bones = bonesOf(skeleton, static_cast<int>(functions.joint));
        for (std::uint32_t v = 0; v < mesh.vertexCount(); ++v)
            plan.joint.ratios.push_back(ratios.bend(v, functions.joint));
        plan.joint.samples = samplesOf(shaped);
        plan.shaped = std::move(shaped);
    }
    return plans;
}

} // namespace osgSkin
