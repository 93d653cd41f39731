// SPDX-License-Identifier: GPL-3.0-or-later
#include "elastic/MakeElasticShapes.h"

#include "elastic/LayeredShapes.h"
#include "elastic/PlanElastic.h"
#include "elastic/SolveElastic.h"
#include "shapes/FastShapes.h"
#include "shapes/PackShapes.h"
#include "shapes/steps/LimitSteps.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

namespace osgSkin {
namespace {

constexpr std::size_t kHingeModes = 8;
constexpr std::size_t kBallModes = 6;

/// RMS error that fewer modes may add: at hinges in radii of the limb, as their functions meet
/// straight bends well; at balls of what their few functions leave, which more modes do not mend.
constexpr double kHingeEnough = 5.5e-3;
constexpr double kBallEnough = 0.45;

/// What makes no difference, in radii of the limb: of a mode to all vertices, and of all modes to a
/// vertex.
constexpr double kTolerance = 2e-3;
constexpr double kVertexTolerance = 6e-3;

/// What a sample counts that is not good: enough that functions do not run away there, too little
/// to spoil the bends beside it.
constexpr double kBadCounts = 0.1;

/// What a hinge's bend counts that is turned sideways: its functions have few terms for those, and
/// would blur the fold of straight bends for them.
constexpr double kSidewaysCounts = 0.2;
constexpr double kSideways = 0.02; ///< sine of half the angle from the main axis

/// Of a joint with fewer good samples than this share no shapes are made.
constexpr double kEnoughSamples = 0.5;

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

/// Whose shape a sample takes: its own where that is good, or penetrates less than the plain skin.
/// Else of the good sample that comes nearest to it and bends less; nothing where the rest pose
/// does.
/// \param at the samples' coordinates
std::optional<std::size_t> standInFor(const std::vector<glm::dvec2>& at,
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

/// A joint's solved shapes as offsets of the vertices that correctives may move.
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
            // Where it cannot be solved the joint tends to the shape of the way there: functions
            // that nothing holds would run away.
            const std::optional<std::size_t> taken = standInFor(result.samples, _solved, i);
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
        const double closed = _plan.shaped.pitClosedAt(bend);
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

/// Why shapes cannot be made of what was solved; empty where they can.
std::string reasonAgainst(const ElasticPlan& plan, const ElasticShapes& solved) {
    if (!solved.reason.empty()) return solved.reason;
    const std::size_t asked = plan.joint.samples.size();
    const auto good = static_cast<std::size_t>(
        std::count_if(solved.samples.begin(), solved.samples.begin() + std::ptrdiff_t(asked),
                      [](const ElasticSample& sample) { return sample.reason.empty(); }));
    if (static_cast<double>(good) >= kEnoughSamples * static_cast<double>(asked)) return {};
    return "only " + std::to_string(good) + " of " + std::to_string(asked) + " bends can be solved";
}

/// A line on the samples that others stand in for, where there are any.
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
                    " bends are guessed from others, as " + reason);
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
        limitSteps(shaped, fitted[joint]);
        if (layers) followBelow(*layers, mesh.vertexCount(), fitted[joint]);
    }
    for (const ShapedJoint& shaped : findShapedJoints(skeleton, joints, mesh, binding)) {
        const std::uint32_t joint = shaped.functions.joint;
        if (fitted.count(joint) != 0) continue;
        fitted[joint] = fastShapesOf(shaped);
        unsolved.try_emplace(joint, "which way it bends is not known");
    }
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
