// SPDX-License-Identifier: GPL-3.0-or-later
#include "FastShapes.h"

#include "BendRange.h"
#include "FastTargets.h"
#include "PackShapes.h"
#include "ShapedJoint.h"

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include <cmath>

namespace osgSkin {
namespace {

/// Modes that are kept of a joint's shapes. A joint that may bend in any direction has as many
/// shapes as directions.
constexpr std::size_t kModes = 6;
constexpr std::size_t kRoundModes = CorrectiveJoint::kMostModes;

/// What makes no difference, in radii of the limb.
constexpr double kTolerance = 2e-3;

FoldShape foldAt(const ShapedJoint& joint, const glm::dquat& turn) {
    FoldShape fold{joint.above, joint.bone, turn * joint.bone, joint.radius, 0.0};
    fold.angle =
        std::atan2(glm::length(glm::cross(fold.above, fold.bone)), glm::dot(fold.above, fold.bone));
    return fold;
}

JointShapes shapesOf(const ShapedJoint& joint) {
    JointShapes shapes;
    shapes.functions = joint.functions;
    for (const ShapedJoint::Vertex& vertex : joint.vertices)
        shapes.vertices.push_back(vertex.index);
    shapes.samples = bendSamples(joint);
    for (const glm::dvec2& sample : shapes.samples) {
        const BendTwist bend = joint.bendAt(sample);
        const FoldShape fold = foldAt(joint, partialTurn(bend, joint.twistAxis, 1.0, 1.0));
        std::vector<glm::dvec3>& offsets = shapes.offsets.emplace_back();
        for (const ShapedJoint::Vertex& vertex : joint.vertices) {
            const glm::dquat turn = joint.turnOf(vertex, bend);
            const glm::dvec3 posed = turn * vertex.from;
            glm::dvec3 target = clampBulge(fold, vertex.from, posed);
            target = pressFold(fold, vertex.from, target);
            target = posed + vertex.limb * vertex.fade * (target - posed);
            offsets.push_back(glm::conjugate(turn) * target - vertex.from);
        }
    }
    return shapes;
}

} // namespace

Correctives makeFastShapes(const RestSkeleton& skeleton, const std::vector<PlannedJoint>& joints,
                           const WeldedMesh& mesh, const Binding& binding) {
    std::vector<FittedShapes> fitted;
    double tolerance = 0.0;
    for (const ShapedJoint& joint : findShapedJoints(skeleton, joints, mesh, binding)) {
        tolerance = kTolerance * joint.radius;
        const bool round = joint.functions.basis == CorrectiveJoint::Basis::Round;
        fitted.push_back(fitShapes(shapesOf(joint), round ? kRoundModes : kModes, tolerance));
    }
    return packShapes(fitted, mesh.weldedOf, tolerance);
}

} // namespace osgSkin
