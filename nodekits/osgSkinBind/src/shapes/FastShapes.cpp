// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapes/FastShapes.h"

#include "shapes/BendRange.h"
#include "shapes/BentSkin.h"
#include "shapes/PackShapes.h"
#include "shapes/ShapedJoint.h"

#include <glm/gtc/quaternion.hpp>

namespace osgSkin {
namespace {

/// Modes that are kept of a joint's shapes. A joint between limbs that may bend in any direction
/// has as many shapes as directions.
constexpr std::size_t kModes = 3;
constexpr std::size_t kRoundModes = CorrectiveJoint::kMostModes;

/// What makes no difference, in radii of the limb.
constexpr double kFitTolerance = 1e-2;

JointShapes shapesOf(const ShapedJoint& joint) {
    JointShapes shapes;
    shapes.functions = joint.functions;
    std::vector<glm::dvec3> atRest;
    for (const ShapedJoint::Vertex& vertex : joint.vertices) {
        shapes.vertices.push_back(vertex.index);
        atRest.push_back(vertex.from);
    }
    const double volumeAtRest = BentSkin::volumeOf(joint, atRest);
    shapes.samples = bendSamples(joint);
    for (const glm::dvec2& sample : shapes.samples) {
        const BendTwist bend = joint.bendAt(sample);
        const BentSkin skin(joint, bend);
        // A hinge's splines meet all of its shapes.
        if (joint.functions.basis != CorrectiveJoint::Basis::Hinge)
            shapes.weights.push_back(skin.weights());
        const std::vector<glm::dvec3> targets = skin.targets(volumeAtRest);
        std::vector<glm::dvec3>& offsets = shapes.offsets.emplace_back();
        for (std::size_t i = 0; i < targets.size(); ++i) {
            const ShapedJoint::Vertex& vertex = joint.vertices[i];
            offsets.push_back(glm::conjugate(joint.turnOf(vertex, bend)) * targets[i] -
                              vertex.from);
        }
    }
    return shapes;
}

} // namespace

FittedShapes fastShapesOf(const ShapedJoint& joint) {
    const bool round = joint.functions.basis == CorrectiveJoint::Basis::Round;
    return fitShapes(shapesOf(joint), round ? kRoundModes : kModes, kFitTolerance * joint.radius);
}

Correctives makeFastShapes(const RestSkeleton& skeleton, const std::vector<PlannedJoint>& joints,
                           const WeldedMesh& mesh, const Binding& binding) {
    std::vector<FittedShapes> fitted;
    for (const ShapedJoint& joint : findShapedJoints(skeleton, joints, mesh, binding))
        fitted.push_back(fastShapesOf(joint));
    return packShapes(fitted, mesh.weldedOf);
}

} // namespace osgSkin
