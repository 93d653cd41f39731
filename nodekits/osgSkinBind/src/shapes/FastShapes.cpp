// SPDX-License-Identifier: GPL-3.0-or-later
#include "shapes/FastShapes.h"

#include "limbs/HermiteRatio.h"
#include "shapes/BendRange.h"
#include "shapes/FastTargets.h"
#include "shapes/PackShapes.h"
#include "shapes/ShapedJoint.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <cmath>

namespace osgSkin {
namespace {

/// Modes that are kept of a joint's shapes. A joint that may bend in any direction has as many
/// shapes as directions.
constexpr std::size_t kModes = 6;
constexpr std::size_t kRoundModes = CorrectiveJoint::kMostModes;

/// What makes no difference, in radii of the limb.
constexpr double kTolerance = 2e-3;

/// By how much a limb swells at most to keep its volume.
constexpr double kMostSwelling = 0.03;

/// How far from the joint it does so, in radii: fully, and at all. Further up a thigh there is
/// another one beside it.
constexpr double kSwellsFully = 2.0;
constexpr double kSwellsNoMore = 4.0;

/// What the skin inside a fold counts against the outer one, which everybody sees, where there are
/// too many shapes to meet all.
constexpr double kHidden = 0.1;

using Points = std::vector<glm::dvec3>;

double degreesBetween(const glm::dvec3& a, const glm::dvec3& b) {
    return glm::degrees(std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b)));
}

FoldShape foldAt(const ShapedJoint& joint, const glm::dquat& turn) {
    const glm::dvec3 bone = turn * joint.bone;
    return {joint.above,
            joint.bone,
            bone,
            joint.radius,
            degreesBetween(joint.above, bone),
            degreesBetween(joint.above, joint.bone)};
}

/// Six times what lies between the skin and the joint's centre.
double volumeOf(const ShapedJoint& joint, const Points& points) {
    double volume = 0.0;
    for (const std::array<std::uint32_t, 3>& t : joint.triangles)
        volume += glm::dot(points[t[0]], glm::cross(points[t[1]], points[t[2]]));
    return volume;
}

/// The joint's skin in one bend, from its centre.
class BentSkin {
public:
    BentSkin(const ShapedJoint& joint, const BendTwist& bend)
        : _joint(joint), _fold(foldAt(joint, partialRotation(bend, joint.twistAxis, 1.0, 1.0))) {
        for (const ShapedJoint::Vertex& vertex : joint.vertices)
            _posed.push_back(joint.turnOf(vertex, bend) * vertex.from);
    }

    /// \param swelling see kMostSwelling
    Points targets(double swelling) const {
        Points targets;
        for (std::size_t i = 0; i < _posed.size(); ++i) {
            const ShapedJoint::Vertex& vertex = _joint.vertices[i];
            glm::dvec3 target = clampBulge(_fold, vertex.from, _posed[i]);
            const double r = glm::length(vertex.from) / _joint.radius;
            target = swell(_fold, target,
                           swelling * (1.0 - hermiteRatio((r - kSwellsFully) /
                                                          (kSwellsNoMore - kSwellsFully))));
            target = pressFold(_fold, vertex.from, target);
            targets.push_back(_posed[i] + vertex.limb * vertex.fade * (target - _posed[i]));
        }
        return targets;
    }

    /// See kHidden.
    std::vector<double> weights() const {
        std::vector<double> weights;
        for (const glm::dvec3& x : _posed)
            weights.push_back(glm::mix(1.0, kHidden, hermiteRatio(0.5 + depthIn(_fold, x))));
        return weights;
    }

private:
    const ShapedJoint& _joint;
    FoldShape _fold;
    Points _posed;
};

/// What the clamp and the press take from the limb, and the bend itself, comes back as far as
/// swelling can give it: flesh does not vanish.
Points targetsOf(const ShapedJoint& joint, const BentSkin& skin, double volumeAtRest) {
    Points lean = skin.targets(0.0);
    const double missing = volumeAtRest - volumeOf(joint, lean);
    if (!(missing > 0.0)) return lean;
    Points full = skin.targets(kMostSwelling);
    const double gained = volumeOf(joint, full) - volumeOf(joint, lean);
    if (!(gained > 0.0)) return lean;
    const double share = std::min(1.0, missing / gained);
    for (std::size_t i = 0; i < lean.size(); ++i) lean[i] += share * (full[i] - lean[i]);
    return lean;
}

JointShapes shapesOf(const ShapedJoint& joint) {
    JointShapes shapes;
    shapes.functions = joint.functions;
    Points atRest;
    for (const ShapedJoint::Vertex& vertex : joint.vertices) {
        shapes.vertices.push_back(vertex.index);
        atRest.push_back(vertex.from);
    }
    const double volumeAtRest = volumeOf(joint, atRest);
    shapes.samples = bendSamples(joint);
    for (const glm::dvec2& sample : shapes.samples) {
        const BendTwist bend = joint.bendAt(sample);
        const BentSkin skin(joint, bend);
        if (joint.functions.basis == CorrectiveJoint::Basis::Round)
            shapes.weights.push_back(skin.weights());
        const Points targets = targetsOf(joint, skin, volumeAtRest);
        Points& offsets = shapes.offsets.emplace_back();
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
    return fitShapes(shapesOf(joint), round ? kRoundModes : kModes, kTolerance * joint.radius);
}

Correctives makeFastShapes(const RestSkeleton& skeleton, const std::vector<PlannedJoint>& joints,
                           const WeldedMesh& mesh, const Binding& binding) {
    std::vector<FittedShapes> fitted;
    for (const ShapedJoint& joint : findShapedJoints(skeleton, joints, mesh, binding))
        fitted.push_back(fastShapesOf(joint));
    return packShapes(fitted, mesh.weldedOf);
}

} // namespace osgSkin
