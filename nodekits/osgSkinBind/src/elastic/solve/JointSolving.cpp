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

/// With more than this, and more than the plain skin has, a shape is hopeless: deeper bends will
/// not mend it.
constexpr std::size_t kManyCrossings = 32;

/// Bends that are tried between a bad one and the good one before it, each halfway to where the
/// last one did not do.
constexpr int kHalvings = 2;

double since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

bool areHopeless(std::size_t crossings, std::size_t plainCrossings) {
    return crossings > kManyCrossings && crossings > plainCrossings;
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
    std::vector<Solved> solved(_rotations.size());
    follow(SampleTree::kRest, _solid->rest(), solved);
    for (Solved& each : solved) shapes.samples.push_back(std::move(each.sample));
    for (Solved& each : solved)
        for (ElasticSample& sample : each.before) shapes.samples.push_back(std::move(sample));
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
}

void JointSolving::follow(std::size_t from, const JointSolid::State& state,
                          std::vector<Solved>& samples) const {
    const bool good = from == SampleTree::kRest || samples[from].sample.reason.empty();
    const std::vector<std::size_t>& next = _tree.startingFrom(from);
    eachAtOnce(next.size(), [&](std::size_t i) {
        Solved& solved = samples[next[i]];
        const Eigen::Quaterniond& rotation = _rotations[next[i]];
        const JointSolid::State there = bend(state, rotation, solved.sample);
        if (good && !solved.sample.reason.empty()) solved.before = approach(state, rotation);
        _progress.done(_joint.name);
        if (there.tangled || there.stopped ||
            areHopeless(solved.sample.crossings, solved.sample.plainCrossings))
            leaveOut(next[i], samples);
        else
            follow(next[i], there, samples);
    });
}

/// Bends beyond a hopeless one are hopeless, too, and the dearest of all: their flesh never comes
/// to rest.
void JointSolving::leaveOut(std::size_t from, std::vector<Solved>& samples) const {
    for (const std::size_t next : _tree.startingFrom(from)) {
        ElasticSample& sample = samples[next].sample;
        sample.rotation = _joint.samples[next];
        sample.reason = samples[from].sample.reason;
        _progress.done(_joint.name);
        leaveOut(next, samples);
    }
}

/// How far towards a bad bend the solid can be bent: what functions are fitted to there is its own
/// shape then. Arms that rest raised and hang at the sides come to lie on that way.
std::vector<ElasticSample> JointSolving::approach(JointSolid::State from,
                                                  const Eigen::Quaterniond& bad) const {
    std::vector<ElasticSample> samples;
    Eigen::Quaterniond end = bad;
    for (int i = 0; i < kHalvings; ++i) {
        const Eigen::Quaterniond halfway = from.turn.slerp(0.5, end);
        ElasticSample sample;
        JointSolid::State there = bend(from, halfway, sample);
        if (sample.reason.empty()) {
            samples.push_back(std::move(sample));
            from = std::move(there);
        } else {
            end = halfway;
        }
    }
    return samples;
}

/// Bends on to a rotation, and looks at what that gives.
JointSolid::State JointSolving::bend(const JointSolid::State& from, const Eigen::Quaterniond& to,
                                     ElasticSample& sample) const {
    const auto start = Clock::now();
    JointSolid::State there = _solid->bend(from, to, [this](const JointSolid::State& state) {
        _progress.check();
        return state.converged || !isHopeless(state);
    });
    sample = sampleOf(there, to);
    sample.seconds = since(start);
    return there;
}

ElasticSample JointSolving::sampleOf(const JointSolid::State& state,
                                     const Eigen::Quaterniond& rotation) const {
    ElasticSample sample;
    sample.rotation = {rotation.w(), rotation.x(), rotation.y(), rotation.z()};
    sample.converged = state.converged && !state.tangled && !state.stopped;
    sample.steps = state.steps;
    if (state.tangled) {
        sample.reason = "the solid tangles on the way";
        return sample;
    }
    if (state.stopped) {
        sample.reason = "the solid penetrates itself on the way";
        return sample;
    }
    const SkinPatch& patch = _solid->patch();
    const Points posed = patch.positions(state.nodes);
    for (Eigen::Index v = 0; v < posed.cols(); ++v)
        sample.positions.push_back(fromJoint(posed.col(v)));
    const ElasticBody::Volumes volumes = _solid->body().volumes(state.nodes);
    sample.leastJacobian = volumes.least;
    sample.volumeRatio = volumes.whole;

    sample.crossings = crossings(posed);
    sample.plainCrossings = plainCrossings(rotation);
    const double share = kCrossingsShare * static_cast<double>(sample.plainCrossings);
    if (sample.crossings > kFewCrossings && static_cast<double>(sample.crossings) > share)
        sample.reason = std::to_string(sample.crossings) + " pairs of triangles cut each other";
    return sample;
}

std::size_t JointSolving::crossings(const Points& posed) const {
    const std::size_t all = countCrossings(_solid->patch().triangles(), posed);
    return all > _crossingsAtRest ? all - _crossingsAtRest : 0;
}

std::size_t JointSolving::plainCrossings(const Eigen::Quaterniond& rotation) const {
    const SkinPatch& patch = _solid->patch();
    const Eigen::Map<const Eigen::VectorXd> ratios(
        patch.ratios().data(), static_cast<Eigen::Index>(patch.ratios().size()));
    return crossings(turned(patch.positions(_solid->rest().nodes), ratios, rotation));
}

bool JointSolving::isHopeless(const JointSolid::State& state) const {
    const std::size_t own = crossings(_solid->patch().positions(state.nodes));
    return areHopeless(own, plainCrossings(state.turn));
}

} // namespace osgSkin::elastic
