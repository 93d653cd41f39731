// SPDX-License-Identifier: GPL-3.0-or-later
#include "elastic/solve/JointSolving.h"

#include "elastic/lattice/Unsolvable.h"
#include "elastic/solve/EachAtOnce.h"
#include "elastic/solve/PatchCrossings.h"

#include <algorithm>
#include <chrono>
#include <optional>
#include <utility>

namespace osgSkin::elastic {
namespace {

using Clock = std::chrono::steady_clock;

/// A shape penetrates where more pairs of triangles cut each other than this, and more than this
/// share of what the plain skin has. The end of a joint's range is worth having with a few pairs:
/// without it a fit brings back more.
constexpr std::size_t kFewCrossings = 8;
constexpr double kCrossingsShare = 0.25;

double since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

std::vector<Eigen::Quaterniond> rotationsOf(const ElasticJoint& joint) {
    std::vector<Eigen::Quaterniond> result;
    for (const glm::dquat& q : joint.samples)
        result.push_back(Eigen::Quaterniond(q.w, q.x, q.y, q.z).normalized());
    return result;
}

} // namespace

JointSolving::JointSolving(const ElasticSkin& skin, const ElasticJoint& joint,
                           SharedProgress& progress)
    : _skin(skin), _joint(joint), _progress(progress), _rotations(rotationsOf(joint)),
      _tree(_rotations) {}

ElasticShapes JointSolving::run() {
    const auto start = Clock::now();
    ElasticShapes shapes;
    shapes.joint = _joint.name;
    try {
        prepare(shapes);
    } catch (const Unsolvable& unsolvable) {
        shapes.reason = unsolvable.what();
        for (std::size_t i = 0; i < _rotations.size(); ++i) _progress.done(_joint.name);
        return shapes;
    }
    shapes.seconds = since(start);
    follow(SampleTree::kRest, _solid->rest(), shapes.samples);
    for (const ElasticSample& sample : shapes.samples) shapes.seconds += sample.seconds;
    return shapes;
}

Point JointSolving::toJoint(const glm::dvec3& point) const {
    const glm::dvec3 p = (point - _joint.centre) / _joint.radius;
    return {p.x, p.y, p.z};
}

glm::dvec3 JointSolving::fromJoint(const Point& point) const {
    return _joint.centre + _joint.radius * glm::dvec3(point.x(), point.y(), point.z());
}

void JointSolving::prepare(ElasticShapes& shapes) {
    if (!(_joint.radius > 0.0)) throw Unsolvable("its limb has no radius");
    if (_skin.triangles.empty()) throw Unsolvable("the skin has no triangles");
    if (_joint.ratios.size() != _skin.positions.size())
        throw Unsolvable("its ratios are not one for each vertex");
    Points skin(3, static_cast<Eigen::Index>(_skin.positions.size()));
    for (std::size_t v = 0; v < _skin.positions.size(); ++v)
        skin.col(static_cast<Eigen::Index>(v)) = toJoint(_skin.positions[v]);
    std::vector<Bone> bones;
    for (const ElasticBone& bone : _joint.bones)
        bones.push_back({toJoint(bone.from), toJoint(bone.to), bone.moves});
    SolidOptions options;
    options.reach = _joint.hinge ? ElasticJoint::kHingeReach : ElasticJoint::kBallReach;
    std::optional<HingeCore> hinge;
    if (_joint.hinge) hinge = hingeCore(skin, bones, _rotations, options.hinge);
    _solid = std::make_unique<const JointSolid>(std::move(skin), _skin.triangles, _joint.ratios,
                                                bones, hinge ? &*hinge : nullptr, options);

    const SkinPatch& patch = _solid->patch();
    const Points rest = patch.positions(_solid->rest().nodes);
    _crossingsAtRest = countCrossings(patch.triangles(), rest);
    shapes.vertices = patch.vertices();
    for (const std::uint32_t v : shapes.vertices) shapes.rest.push_back(_skin.positions[v]);
    shapes.reach = options.reach * _joint.radius;
    shapes.cells = _solid->lattice().cells().size();
    shapes.nodes = static_cast<std::size_t>(_solid->lattice().rest().cols());
    shapes.samples.resize(_rotations.size());
}

void JointSolving::follow(std::size_t from, const JointSolid::State& state,
                          std::vector<ElasticSample>& samples) const {
    const std::vector<std::size_t>& next = _tree.startingFrom(from);
    eachAtOnce(next.size(), [&](std::size_t i) {
        const auto start = Clock::now();
        const JointSolid::State there =
            _solid->bend(state, _rotations[next[i]], [this] { _progress.check(); });
        samples[next[i]] = sampleOf(there, next[i]);
        samples[next[i]].seconds = since(start);
        _progress.done(_joint.name);
        follow(next[i], there, samples);
    });
}

ElasticSample JointSolving::sampleOf(const JointSolid::State& state, std::size_t index) const {
    ElasticSample sample;
    sample.rotation = _joint.samples[index];
    sample.converged = state.converged && !state.tangled;
    sample.steps = state.steps;
    if (state.tangled) {
        sample.reason = "the solid tangles on the way";
        return sample;
    }
    const SkinPatch& patch = _solid->patch();
    const Points posed = patch.positions(state.nodes);
    for (Eigen::Index v = 0; v < posed.cols(); ++v)
        sample.positions.push_back(fromJoint(posed.col(v)));
    const ElasticBody::Volumes volumes = _solid->body().volumes(state.nodes);
    sample.leastJacobian = volumes.least;
    sample.volumeRatio = volumes.whole;

    const Points rest = patch.positions(_solid->rest().nodes);
    const Eigen::Map<const Eigen::VectorXd> ratios(
        patch.ratios().data(), static_cast<Eigen::Index>(patch.ratios().size()));
    sample.crossings = crossingsBeyondRest(posed);
    sample.plainCrossings = crossingsBeyondRest(turned(rest, ratios, _rotations[index]));
    const double share = kCrossingsShare * static_cast<double>(sample.plainCrossings);
    if (sample.crossings > kFewCrossings && static_cast<double>(sample.crossings) > share)
        sample.reason = std::to_string(sample.crossings) + " pairs of triangles cut each other";
    return sample;
}

std::size_t JointSolving::crossingsBeyondRest(const Points& posed) const {
    const std::size_t crossings = countCrossings(_solid->patch().triangles(), posed);
    return crossings > _crossingsAtRest ? crossings - _crossingsAtRest : 0;
}

} // namespace osgSkin::elastic
