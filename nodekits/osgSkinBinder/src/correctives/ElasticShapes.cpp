// SPDX-License-Identifier: GPL-3.0-or-later
#include "correctives/MakeShapes.h"

#include "correctives/LimitVelocity.h"
#include "correctives/ShapeFit.h"
#include "correctives/ShapedJoint.h"
#include "elastic/SolveElastic.h"
#include "garments/SkinLayers.h"
#include "ratios/JointRatios.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <optional>
#include <utility>
#include <vector>

namespace osgSkin {
namespace {

/// A joint to solve, and to fit shapes to.
struct ElasticPlan {
    ShapedJoint shaped;
    ElasticJoint joint;

    /// The coordinates of a rotation without twist.
    glm::dvec2 coordinatesOf(const glm::dquat& rotation) const;
};

using Basis = CorrectiveJoint::Basis;

/// Beyond this flexion a knee's solid begins to tangle; degrees from the straight limb.
constexpr double kMaxFlexion = 139.0;

/// How far shoulders and hips bend from the rest pose, degrees.
constexpr double kMaxSwing = 150.0, kMaxHipSwing = 120.0;

/// How far shapes reach, in radii. A hinge's fold needs all that is solved. At the trunk other
/// limbs are near that the solved flesh does not include: mainly hands beside thighs and, in
/// armpits while the arm is not raised, the trunk itself.
constexpr ShapeReach kBetweenLimbs{0.75 * ElasticJoint::kHingeReach, ElasticJoint::kHingeReach};
constexpr ShapeReach kAtTrunk{2.0, ElasticJoint::kBallReach};
constexpr ShapeReach kBesideLimb{2.0, 3.0};
constexpr ShapeReach kInPit{1.5, 2.25};

/// Distance of a hinge's knots, degrees. Farther apart, functions blur where flesh meets flesh;
/// nearer than the samples, they would be undetermined.
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
        return ballSamples(shaped.twistAxis, functions.axis, angleOf(functions.high.x));
    HingeRange range;
    range.axis = functions.axis;
    range.restFlexion = std::atan2(glm::dot(glm::cross(shaped.above, shaped.bone), functions.axis),
                                   glm::dot(shaped.above, shaped.bone));
    range.leastFlexion = range.restFlexion + angleOf(functions.low.x);
    range.mostFlexion = range.restFlexion + angleOf(functions.high.x);
    return hingeSamples(range, shaped.twistAxis);
}

glm::dvec2 ElasticPlan::coordinatesOf(const glm::dquat& rotation) const {
    const glm::dvec3 sine(rotation.x, rotation.y, rotation.z);
    return {glm::dot(sine, shaped.functions.axis),
            glm::dot(sine, glm::cross(shaped.twistAxis, shaped.functions.axis))};
}

/// The joints to solve: those between two limbs that have a main axis, and those at the trunk.
/// \param binding of the mesh before welding
std::vector<ElasticPlan> planElastic(const RestSkeleton& skeleton,
                                     const std::vector<PlannedJoint>& joints,
                                     const WeldedMesh& mesh, const Binding& binding) {
    ShapeScope scope;
    scope.betweenLimbs = kBetweenLimbs;
    scope.atTrunk = kAtTrunk;
    scope.besideLimb = kBesideLimb;
    scope.inPit = kInPit;
    scope.trunkToo = true;
    scope.mostFlexion = kMaxFlexion;
    scope.knotStep = kKnotStep;
    scope.mostSwing = kMaxSwing;
    scope.mostSwingBeside = kMaxHipSwing;
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

/// Moves clothes by the joint's shapes of the skin below them: solved by themselves they would
/// separate from it.
/// \param welded the number of welded vertices
void followBelow(const SkinLayers& layers, std::size_t welded, FittedShapes& shapes) {
    const std::size_t modes = shapes.functions.modes;
    if (layers.size() == 0 || modes == 0) return;
    std::vector<std::vector<glm::dvec3>> moves(modes, std::vector<glm::dvec3>(welded));
    for (std::size_t k = 0; k < modes; ++k) {
        for (std::size_t i = 0; i < shapes.vertices.size(); ++i)
            moves[k][shapes.vertices[i]] = shapes.vectors[i * modes + k];
        layers.follow(moves[k]);
    }
    shapes.vertices.clear();
    shapes.vectors.clear();
    for (std::uint32_t v = 0; v < welded; ++v) {
        bool moved = false;
        for (const std::vector<glm::dvec3>& mode : moves) moved = moved || mode[v] != glm::dvec3(0);
        if (!moved) continue;
        shapes.vertices.push_back(v);
        for (const std::vector<glm::dvec3>& mode : moves) shapes.vectors.push_back(mode[v]);
    }
}

constexpr std::size_t kHingeModes = 8;
constexpr std::size_t kBallModes = 6;

/// RMS error that fewer modes may add: at hinges in radii of the limb, as their functions meet
/// straight bends well; at balls as a share of the error of their few functions, which more modes
/// do not reduce.
constexpr double kHingeEnough = 5.5e-3;
constexpr double kBallEnough = 0.45;

/// Negligible displacement, in radii of the limb: of all vertices by a mode, and of a vertex.
constexpr double kTolerance = 2e-3;
constexpr double kVertexTolerance = 6e-3;

/// Weight of a bad sample: enough that functions do not run away there, too little to spoil the
/// bends beside it.
constexpr double kBadCounts = 0.1;

/// Weight of a hinge's sideways bends: its functions have few terms for them, and would blur the
/// fold of straight bends.
constexpr double kSidewaysCounts = 0.2;
constexpr double kSideways = 0.02; ///< sine of half the angle from the main axis

/// The least share of good samples with which shapes are made.
constexpr double kEnoughSamples = 0.25;

ModeLimits limitsOf(bool hinge, double radius) {
    ModeLimits limits;
    limits.most = hinge ? kHingeModes : kBallModes;
    limits.tolerance = kTolerance * radius;
    if (hinge)
        limits.enough = kHingeEnough * radius;
    else
        limits.enoughOfResidual = kBallEnough;
    return limits;
}

/// The sample whose shape a sample takes: itself if its shape is good, or intersects itself no more
/// than the plain skin does; else the nearest good sample that bends less; none if the rest pose is
/// nearer.
/// \param at the samples' coordinates
std::optional<std::size_t> substituteSample(const std::vector<glm::dvec2>& at,
                                            const ElasticShapes& shapes, std::size_t sample) {
    const ElasticSample& own = shapes.samples[sample];
    if (own.reason.empty() || (!own.positions.empty() && own.crossings <= own.plainCrossings))
        return sample;
    const double length = glm::length(at[sample]);
    std::optional<std::size_t> best;
    double nearest = length;
    for (std::size_t i = 0; i < at.size(); ++i) {
        const double away = glm::distance(at[i], at[sample]);
        if (!shapes.samples[i].reason.empty() || glm::length(at[i]) >= length || away >= nearest)
            continue;
        nearest = away;
        best = i;
    }
    return best;
}

/// A joint's solved shapes as offsets of the vertices that correctives move.
class ElasticOffsets {
public:
    ElasticOffsets(const ElasticPlan& plan, const ElasticShapes& solved)
        : _plan(plan), _solved(solved) {
        for (const ShapedJoint::Vertex& vertex : plan.shaped.vertices) {
            const auto found =
                std::lower_bound(solved.vertices.begin(), solved.vertices.end(), vertex.index);
            if (vertex.limb * vertex.fade > 0.0 && found != solved.vertices.end() &&
                *found == vertex.index)
                _moved.push_back(
                    {&vertex, static_cast<std::size_t>(found - solved.vertices.begin())});
        }
    }

    JointShapes shapes() const {
        JointShapes result;
        result.functions = _plan.shaped.functions;
        for (const Moved& moved : _moved) result.vertices.push_back(moved.vertex->index);
        for (const ElasticSample& sample : _solved.samples)
            result.samples.push_back(_plan.coordinatesOf(sample.rotation));
        const bool hinge = result.functions.basis == CorrectiveJoint::Basis::Hinge;
        for (std::size_t i = 0; i < result.samples.size(); ++i) {
            // A bend that cannot be solved takes the shape of a smaller one: undetermined functions
            // would run away.
            const std::optional<std::size_t> taken = substituteSample(result.samples, _solved, i);
            result.offsets.push_back(taken
                                         ? offsetsAt(result.samples[*taken], *taken)
                                         : std::vector<glm::dvec3>(_moved.size(), glm::dvec3(0.0)));
            const bool sideways = hinge && std::abs(result.samples[i].y) > kSideways;
            result.weights.emplace_back(_moved.size(),
                                        (_solved.samples[i].reason.empty() ? 1.0 : kBadCounts) *
                                            (sideways ? kSidewaysCounts : 1.0));
        }
        return result;
    }

private:
    struct Moved {
        const ShapedJoint::Vertex* vertex;
        std::size_t solved; ///< index in ElasticShapes::vertices
    };

    std::vector<glm::dvec3> offsetsAt(const glm::dvec2& xy, std::size_t sample) const {
        const BendTwist bend = _plan.shaped.bendAt(xy);
        const double closed = _plan.shaped.armpitClosure(bend);
        std::vector<glm::dvec3> offsets;
        offsets.reserve(_moved.size());
        for (const Moved& moved : _moved) {
            const ShapedJoint::Vertex& vertex = *moved.vertex;
            const glm::dvec3 target =
                _solved.samples[sample].positions[moved.solved] - _plan.shaped.centre;
            const glm::dvec3 unbent =
                glm::conjugate(_plan.shaped.turnOf(vertex, bend)) * target - vertex.from;
            const double fade = glm::mix(vertex.fade, vertex.fadeClosed, closed);
            offsets.push_back(vertex.limb * fade * unbent);
        }
        return offsets;
    }

    const ElasticPlan& _plan;
    const ElasticShapes& _solved;
    std::vector<Moved> _moved;
};

/// Why no shapes can be made; empty if they can.
std::string reasonAgainst(const ElasticPlan& plan, const ElasticShapes& solved) {
    if (!solved.reason.empty()) return solved.reason;
    const std::size_t asked = plan.joint.samples.size();
    const auto good = static_cast<std::size_t>(
        std::count_if(solved.samples.begin(), solved.samples.begin() + std::ptrdiff_t(asked),
                      [](const ElasticSample& sample) { return sample.reason.empty(); }));
    if (static_cast<double>(good) >= kEnoughSamples * static_cast<double>(asked)) return {};
    return "only " + std::to_string(good) + " of " + std::to_string(asked) + " bends can be solved";
}

/// Notes the samples that take the shapes of others, if there are any.
void noteBadSamples(const ElasticPlan& plan, const ElasticShapes& solved,
                    std::vector<std::string>& notes) {
    std::size_t bad = 0;
    std::string reason;
    for (const ElasticSample& sample : solved.samples) {
        if (sample.reason.empty()) continue;
        ++bad;
        reason = sample.reason;
    }
    if (bad == 0) return;
    notes.push_back("elastic shapes of \"" + solved.joint + "\": " + std::to_string(bad) + " of " +
                    std::to_string(plan.joint.samples.size()) +
                    " bends are guessed from others, because " + reason);
}

} // namespace

Correctives makeElasticShapes(const RestSkeleton& skeleton, const std::vector<PlannedJoint>& joints,
                              const WeldedMesh& mesh, const SkinLayers* layers,
                              const Binding& binding, const Progress& progress,
                              std::vector<std::string>& notes) {
    const std::vector<ElasticPlan> plans = planElastic(skeleton, joints, mesh, binding);
    std::vector<ElasticJoint> toSolve;
    toSolve.reserve(plans.size());
    for (const ElasticPlan& plan : plans) toSolve.push_back(plan.joint);
    const std::vector<ElasticShapes> solved =
        solveElasticJoints({mesh.positions, mesh.triangles}, toSolve, progress);

    std::map<std::uint32_t, FittedShapes> fitted; // by joint
    std::map<std::uint32_t, std::string> unsolved;
    for (std::size_t i = 0; i < plans.size(); ++i) {
        const ShapedJoint& shaped = plans[i].shaped;
        const std::uint32_t joint = shaped.functions.joint;
        if (std::string reason = reasonAgainst(plans[i], solved[i]); !reason.empty()) {
            unsolved[joint] = std::move(reason);
            continue;
        }
        noteBadSamples(plans[i], solved[i], notes);
        fitted[joint] = fitShapes(ElasticOffsets(plans[i], solved[i]).shapes(),
                                  limitsOf(plans[i].joint.hinge, shaped.radius));
        fitted[joint].tolerance = kVertexTolerance * shaped.radius;
        limitVelocity(shaped, fitted[joint]);
        if (layers) followBelow(*layers, mesh.vertexCount(), fitted[joint]);
    }
    for (const ShapedJoint& shaped : findShapedJoints(skeleton, joints, mesh, binding)) {
        const std::uint32_t joint = shaped.functions.joint;
        if (fitted.count(joint) != 0) continue;
        fitted[joint] = fastShapesOf(shaped);
        unsolved.try_emplace(joint, "its bend axis is not known");
    }
    for (const ShapedJoint& soft : findSoftJoints(joints, mesh, binding))
        if (fitted.count(soft.functions.joint) == 0)
            fitted[soft.functions.joint] = fastShapesOf(soft);
    for (const auto& [joint, reason] : unsolved)
        notes.push_back("joint \"" + skeleton.joints[joint].name + "\" has " +
                        (fitted.count(joint) != 0 ? "fast" : "no") +
                        " shapes, not elastic ones: " + reason);
    std::vector<FittedShapes> all;
    all.reserve(fitted.size());
    for (auto& [joint, shapes] : fitted) all.push_back(std::move(shapes));
    return packShapes(all, mesh.weldedOf);
}

} // namespace osgSkin
