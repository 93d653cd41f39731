// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapes/FastShapes.h"

#include "regions/HermiteRatio.h"
#include "shapes/BendRange.h"
#include "shapes/BentSkin.h"
#include "shapes/PackShapes.h"
#include "shapes/ShapedJoint.h"

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <optional>

namespace osgSkin {
namespace {

/// Modes that are kept of a joint's shapes. With two, knees at 120 degrees would still cut through
/// themselves; shoulders and hips gain next to nothing by a second one, which every vertex there
/// would pay for. A joint between limbs that may bend in any direction has as many shapes as
/// directions.
std::size_t modesOf(CorrectiveJoint::Basis basis) {
    return basis == CorrectiveJoint::Basis::TurnedHinge ? 3
           : basis == CorrectiveJoint::Basis::Ball      ? 1
                                                        : CorrectiveJoint::kMostModes;
}

/// What makes no difference, in radii of the limb: of a mode to all vertices, and of its last modes
/// to a vertex, where they are not as many as directions.
constexpr double kFitTolerance = 1e-2;
constexpr double kVertexTolerance = 2e-2;

/// Vertices between limbs whose largest offset is less are not touched; those with more are touched
/// fully from the second value on. Radii of the limb.
constexpr double kUntouched = 0.07;
constexpr double kTouched = 0.15;

std::vector<BendTwist> bendsOf(const ShapedJoint& joint) {
    if (joint.functions.basis == CorrectiveJoint::Basis::TurnedHinge) return turnedBends(joint);
    std::vector<BendTwist> bends;
    for (const glm::dvec2& sample : bendSamples(joint)) bends.push_back(joint.bendAt(sample));
    return bends;
}

ShapedJoint turnedWherePossible(ShapedJoint joint) {
    if (joint.functions.basis == CorrectiveJoint::Basis::Hinge) setTurnedHinge(joint);
    return joint;
}

JointShapes shapesOf(const ShapedJoint& joint) {
    JointShapes shapes;
    shapes.functions = joint.functions;
    std::vector<glm::dvec3> atRest;
    for (const ShapedJoint::Vertex& vertex : joint.vertices) {
        shapes.vertices.push_back(vertex.index);
        atRest.push_back(vertex.from);
    }
    const double volumeAtRest = BentSkin::volumeOf(joint, atRest);
    std::optional<JointSections> sections;
    if (!joint.isAtTrunk()) sections.emplace(joint);
    for (const BendTwist& bend : bendsOf(joint)) {
        shapes.samples.push_back(
            joint.functions.coordinates(bend.bendAxis, bend.bendAngle, joint.twistAxis));
        const BentSkin skin(joint, bend, sections ? sections->childDepth() : 0.5);
        // A hinge's splines meet all of its shapes.
        if (joint.functions.basis != CorrectiveJoint::Basis::TurnedHinge)
            shapes.weights.push_back(skin.weights());
        const std::vector<glm::dvec3> targets =
            skin.targets(volumeAtRest, sections ? &*sections : nullptr);
        std::vector<glm::dvec3>& offsets = shapes.offsets.emplace_back();
        for (std::size_t i = 0; i < targets.size(); ++i) {
            const ShapedJoint::Vertex& vertex = joint.vertices[i];
            offsets.push_back(glm::conjugate(joint.turnOf(vertex, bend)) * targets[i] -
                              vertex.from);
        }
    }
    return shapes;
}

/// Leaves alone vertices that hardly move: each of them would cost as much as the others.
void fadeSmallOffsets(double radius, JointShapes& shapes) {
    for (std::size_t v = 0; v < shapes.vertices.size(); ++v) {
        double largest = 0.0;
        for (const std::vector<glm::dvec3>& offsets : shapes.offsets)
            largest = std::max(largest, glm::length(offsets[v]));
        const double share =
            hermiteRatio((largest / radius - kUntouched) / (kTouched - kUntouched));
        for (std::vector<glm::dvec3>& offsets : shapes.offsets) offsets[v] *= share;
    }
}

} // namespace

FittedShapes fastShapesOf(const ShapedJoint& joint) {
    JointShapes shapes = shapesOf(turnedWherePossible(joint));
    const CorrectiveJoint::Basis basis = shapes.functions.basis;
    if (basis == CorrectiveJoint::Basis::TurnedHinge) fadeSmallOffsets(joint.radius, shapes);
    FittedShapes result = fitShapes(shapes, {modesOf(basis), kFitTolerance * joint.radius});
    if (basis != CorrectiveJoint::Basis::Round) result.tolerance = kVertexTolerance * joint.radius;
    return result;
}

Correctives makeFastShapes(const RestSkeleton& skeleton, const std::vector<PlannedJoint>& joints,
                           const WeldedMesh& mesh, const Binding& binding) {
    std::vector<FittedShapes> all;
    for (const ShapedJoint& joint : findShapedJoints(skeleton, joints, mesh, binding))
        all.push_back(fastShapesOf(joint));
    return packShapes(all, mesh.weldedOf);
}

} // namespace osgSkin
