// SPDX-License-Identifier: GPL-3.0-or-later
#include "elastic/JointSolid.h"

#include "elastic/CountCrossings.h"
#include "elastic/Preconditioner.h"
#include "elastic/solid/Energies.h"
#include "elastic/solid/FoldContact.h"
#include "elastic/solid/SkinPatch.h"
#include "elastic/solid/VoxelLattice.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <deque>
#include <iterator>
#include <memory>
#include <numeric>
#include <optional>
#include <utility>
#include <vector>

namespace osgSkin::elastic {
namespace {

/// A step whose first guess inverts a cell is halved, but not below this, radians.
constexpr double kSmallestTurn = 0.02;

/// The share of a step's change that the next step's first guess has: wholly, rounding errors would
/// grow from step to step. Less than kMaxLonger as long, and about nearly the same axis (cosine).
constexpr double kExtrapolated = 0.5, kMaxLonger = 1.5, kSameAxis = 0.9;

/// Bones are ignored that are farther from the joint, in reaches.
constexpr double kBonesWithin = 1.5;

/// Tolerance of a state's rotation, radians.
constexpr double kThere = 1e-9;

/// Parameters of the solid, in units of the limb's radius and the flesh's mu.
struct SolidOptions {
    double edge = 1.0 / 3.0;     ///< of the cells
    double reach = 4.0;          ///< of the lattice
    double largestTurn = 0.5236; ///< of one step, radians: 30 degrees
    Flesh flesh;
    double fascia =
        1.0; ///< mu / r^2 per volume; if less, deep folds slide; if more, they stay plain
    CoreSizes cores;
    HingeSizes hinge;
    ContactSizes contact;
    OuterSizes outer;
    MinimiseLimits limits;
};

/// The body around a joint as an elastic solid. Thread-safe: const after construction.
class JointSolid {
public:
    /// \param skin in joint space
    /// \param ratios the joint's bend ratio at each vertex
    /// \param hinge null for other joints
    /// \throw Unsolvable
    JointSolid(Points skin, RestSkin::Triangles triangles, const std::vector<double>& ratios,
               const std::vector<Bone>& bones, const HingeCore* hinge, const SolidOptions& options);

    /// Shape at one rotation of the joint.
    struct State {
        Eigen::Quaterniond turn = Eigen::Quaterniond::Identity();
        Points nodes;
        /// The last step's rotation, and how far the shape is from the one before, rotated.
        Eigen::AngleAxisd lastTurn = Eigen::AngleAxisd::Identity();
        Points missed;
        bool tangled = false; ///< further bending would invert a cell
        int steps = 0;        ///< of the minimiser
    };

    State rest() const;

    /// Bends to another rotation in small steps.
    State bend(const State& from, const Eigen::Quaterniond& to) const;

    const VoxelLattice& lattice() const { return _lattice; }
    const SkinPatch& patch() const { return _patch; }
    const ElasticBody& body() const { return _body; }

private:
    Points rotated(const State& from, const Eigen::Quaterniond& to) const;
    Points extrapolated(const State& from, const Eigen::Quaterniond& step) const;
    bool defined(const Points& nodes) const;

    SolidOptions _options;
    RestSkin _skin;
    VoxelLattice _lattice;
    SkinPatch _patch;
    Eigen::VectorXd _ratios; ///< of the nodes
    ElasticBody _body;
    BoneCores _cores;
    Fascia _fascia;
    OuterSkin _outer;
    FoldSkin _fold;
    Preconditioner _preconditioner;
};

/// Bends a joint's solid to all of its samples.
class JointSolving {
public:
    /// The arguments must outlive this object.
    JointSolving(const ElasticSkin& skin, const ElasticJoint& joint, SharedProgress& progress);

    ElasticShapes run();

private:
    Point toJoint(const glm::dvec3& point) const;
    glm::dvec3 fromJoint(const Point& point) const;
    std::vector<Eigen::Quaterniond> rotations() const;
    void prepare(ElasticShapes& shapes);
    /// A sample, and additional ones that replace it if it is bad.
    struct Solved {
        ElasticSample sample;
        std::vector<ElasticSample> before;
    };
    void follow(std::size_t from, const JointSolid::State& state,
                std::vector<Solved>& samples) const;
    void leaveOut(std::size_t from, std::vector<Solved>& samples) const;
    std::vector<ElasticSample> approach(JointSolid::State from,
                                        const Eigen::Quaterniond& bad) const;
    JointSolid::State bend(const JointSolid::State& from, const Eigen::Quaterniond& to,
                           ElasticSample& sample) const;
    ElasticSample sampleOf(const JointSolid::State& state,
                           const Eigen::Quaterniond& rotation) const;
    /// Pairs of intersecting triangles beyond those at rest.
    std::size_t crossings(const Points& posed) const;
    std::size_t plainCrossings(const Eigen::Quaterniond& rotation) const;

    const ElasticSkin& _skin;
    const ElasticJoint& _joint;
    SharedProgress& _progress;
    Eigen::Quaterniond _axes;                   ///< from the axes of rest space to joint space's
    std::vector<Eigen::Quaterniond> _rotations; ///< the samples', joint space, unit
    SampleTree _tree;
    std::unique_ptr<const JointSolid> _solid;
    std::size_t _crossingsAtRest = 0;
};

using Clock = std::chrono::steady_clock;

/// A shape is bad if it has more pairs of intersecting triangles than this, and more than this
/// share of the plain skin's. The end of a joint's range is useful even with a few pairs: without
/// it, the fit would have more.
constexpr std::size_t kFewCrossings = 8;
constexpr double kCrossingsShare = 0.25;

/// A shape with more pairs than this, and more than the plain skin, is hopeless: deeper bends will
/// not be better.
constexpr std::size_t kManyCrossings = 32;

/// Number of bisections between a bad bend and the good one before it.
constexpr int kHalvings = 2;

double since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

bool areHopeless(std::size_t crossings, std::size_t plainCrossings) {
    return crossings > kManyCrossings && crossings > plainCrossings;
}

/// The axes of joint space: y along the bone that moves, x across it along the first sample's axis.
/// So a rotated body has the same cells.
Eigen::Quaterniond axesOf(const ElasticJoint& joint) {
    Point along = Point::Zero(), across = Point::Zero();
    for (const ElasticBone& bone : joint.bones)
        if (bone.moves && glm::distance(bone.from, joint.centre) < kAtCentre * joint.radius &&
            glm::distance(bone.to, joint.centre) > along.norm())
            along = toEigen(bone.to - joint.centre);
    for (const glm::dquat& q : joint.samples)
        if (across.isZero(kThere)) across = (q.w < 0.0 ? -1.0 : 1.0) * Point(q.x, q.y, q.z);
    if (!(along.norm() > 0.0)) return Eigen::Quaterniond::Identity();
    Eigen::Matrix3d rows;
    rows.row(1) = along.normalized();
    across -= across.dot(rows.row(1)) * rows.row(1).transpose();
    rows.row(0) = across.isZero(kThere) ? along.unitOrthogonal() : across.normalized();
    rows.row(2) = rows.row(0).cross(rows.row(1));
    return Eigen::Quaterniond(rows);
}

JointSolid::JointSolid(Points skin, RestSkin::Triangles triangles,
                       const std::vector<double>& ratios, const std::vector<Bone>& bones,
                       const HingeCore* hinge, const SolidOptions& options)
    : _options(options), _skin(std::move(skin), std::move(triangles)),
      _lattice(_skin, options.edge, options.reach), _patch(_lattice, _skin, ratios),
      _ratios(ratioField(_lattice, _patch)), _body(_lattice, options.flesh),
      _cores(_lattice, _skin, bones, hinge, options.cores), _fascia(_lattice, options.fascia),
      _outer(_patch, _skin.positions(), bones, hinge, options.outer),
      _fold(_lattice, _skin, _patch, _ratios, _options.contact), _preconditioner(_lattice, _cores) {
}

JointSolid::State JointSolid::rest() const {
    State state;
    state.nodes = _lattice.rest();
    state.missed = Points::Zero(3, state.nodes.cols());
    return state;
}

bool JointSolid::defined(const Points& nodes) const {
    Points gradient = Points::Zero(3, nodes.cols());
    return std::isfinite(_body.value(nodes, gradient));
}

/// A state's nodes, rotated on by their ratios.
Points JointSolid::rotated(const State& from, const Eigen::Quaterniond& to) const {
    Points nodes = turned(from.nodes, _ratios, to * from.turn.conjugate());
    // Steps about different axes do not add up, so rotate pinned nodes by the whole rotation.
    const Eigen::Index pinned = nodes.cols() - _lattice.freeNodes();
    nodes.rightCols(pinned) = turned(_lattice.rest().rightCols(pinned), _ratios.tail(pinned), to);
    return nodes;
}

/// How far the shape will be from rotated() after a step, judged by the last one.
Points JointSolid::extrapolated(const State& from, const Eigen::Quaterniond& step) const {
    const Eigen::AngleAxisd next(step);
    if (!(from.lastTurn.angle() > 0.0) || from.lastTurn.axis().dot(next.axis()) < kSameAxis)
        return Points::Zero(3, from.nodes.cols());
    const double share = kExtrapolated * std::min(kMaxLonger, next.angle() / from.lastTurn.angle());
    return share * turned(from.missed, _ratios, step);
}

JointSolid::State JointSolid::bend(const State& from, const Eigen::Quaterniond& to) const {
    FoldContact contact(_fold);
    State state = from;
    state.steps = 0;
    double left = state.turn.angularDistance(to);
    double largest = _options.largestTurn;
    while (left > kThere) {
        const double step = left / std::ceil(left / largest - 1e-9);
        const Eigen::Quaterniond next = state.turn.slerp(step / left, to);
        const Eigen::Quaterniond turn = next * state.turn.conjugate();
        const Points start = rotated(state, next);
        Points nodes = start + extrapolated(state, turn);
        if (!defined(nodes)) nodes = start;
        if (!defined(nodes)) {
            largest = 0.5 * step;
            if (largest >= kSmallestTurn) continue;
            state.tangled = true;
            return state;
        }
        const Points goals = _cores.goals(next);
        const std::vector<Bone> bones = _outer.posed(next);
        const Points plain = turned(_lattice.rest(), _ratios, next);
        Points pull(3, static_cast<Eigen::Index>(_patch.vertices().size()));
        Energy energy;
        energy.value = [&](const Points& at, Points& gradient) {
            gradient.setZero();
            double value = _body.value(at, gradient);
            if (!std::isfinite(value)) return value;
            pull.setZero();
            const Points skin = _patch.positions(at);
            value += _cores.value(at, goals, gradient) + _fascia.value(at, plain, gradient) +
                     _outer.value(skin, bones, pull) + contact.value(skin, pull);
            _patch.spread(pull, gradient);
            gradient.rightCols(at.cols() - _lattice.freeNodes()).setZero();
            return value;
        };
        energy.precondition = [this](const Directions& gradient) {
            return _preconditioner.solve(gradient);
        };
        energy.renew = [&contact](const Points& at) { contact.detect(at); };
        state.steps += minimise(energy, nodes, _options.limits);
        state.missed = nodes - start;
        state.lastTurn = turn;
        state.nodes = std::move(nodes);
        state.turn = next;
        left = state.turn.angularDistance(to);
    }
    return state;
}

JointSolving::JointSolving(const ElasticSkin& skin, const ElasticJoint& joint,
                           SharedProgress& progress)
    : _skin(skin), _joint(joint), _progress(progress), _axes(axesOf(joint)),
      _rotations(rotations()), _tree(_rotations) {}

std::vector<Eigen::Quaterniond> JointSolving::rotations() const {
    std::vector<Eigen::Quaterniond> result;
    for (const glm::dquat& q : _joint.samples)
        result.push_back(
            (_axes * Eigen::Quaterniond(q.w, q.x, q.y, q.z) * _axes.conjugate()).normalized());
    return result;
}

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
    return _axes * toEigen((point - _joint.centre) / _joint.radius);
}

glm::dvec3 JointSolving::fromJoint(const Point& point) const {
    return _joint.centre + _joint.radius * toGlm(_axes.conjugate() * point);
}

void JointSolving::prepare(ElasticShapes& shapes) {
    if (!(_joint.radius > 0.0)) throw Unsolvable("its limb has no radius");
    if (_skin.triangles.empty()) throw Unsolvable("the skin has no triangles");
    if (_joint.ratios.size() != _skin.positions.size())
        throw Unsolvable("it needs one ratio for each vertex");
    Points skin(3, static_cast<Eigen::Index>(_skin.positions.size()));
    for (std::size_t v = 0; v < _skin.positions.size(); ++v)
        skin.col(static_cast<Eigen::Index>(v)) = toJoint(_skin.positions[v]);
    std::vector<Bone> bones;
    SolidOptions options;
    options.reach = _joint.hinge ? ElasticJoint::kHingeReach : ElasticJoint::kBallReach;
    for (const ElasticBone& bone : _joint.bones) {
        const Bone near{toJoint(bone.from), toJoint(bone.to), bone.moves};
        if (nearestOn(near, Point::Zero()).norm() < kBonesWithin * options.reach)
            bones.push_back(near);
    }
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
    parallelFor(next.size(), [&](std::size_t i) {
        Solved& solved = samples[next[i]];
        const Eigen::Quaterniond& rotation = _rotations[next[i]];
        const JointSolid::State there = bend(state, rotation, solved.sample);
        if (good && !solved.sample.reason.empty()) solved.before = approach(state, rotation);
        _progress.done(_joint.name);
        if (there.tangled || areHopeless(solved.sample.crossings, solved.sample.plainCrossings))
            leaveOut(next[i], samples);
        else
            follow(next[i], there, samples);
    });
}

/// Skips bends beyond a hopeless one: they are hopeless, too, and take the most time, as they never
/// converge.
void JointSolving::leaveOut(std::size_t from, std::vector<Solved>& samples) const {
    for (const std::size_t next : _tree.startingFrom(from)) {
        ElasticSample& sample = samples[next].sample;
        sample.rotation = _joint.samples[next];
        sample.reason = samples[from].sample.reason;
        _progress.done(_joint.name);
        leaveOut(next, samples);
    }
}

/// Bends the solid as far as possible towards a bad bend, so that functions are fitted to its own
/// shapes there: for arms with a raised rest pose, these include hanging at the sides.
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

/// Bends to a rotation and evaluates the result.
JointSolid::State JointSolving::bend(const JointSolid::State& from, const Eigen::Quaterniond& to,
                                     ElasticSample& sample) const {
    const auto start = Clock::now();
    _progress.check();
    JointSolid::State there = _solid->bend(from, to);
    sample = sampleOf(there, to);
    sample.seconds = since(start);
    return there;
}

ElasticSample JointSolving::sampleOf(const JointSolid::State& state,
                                     const Eigen::Quaterniond& rotation) const {
    ElasticSample sample;
    const Eigen::Quaterniond own = _axes.conjugate() * rotation * _axes;
    sample.rotation = {own.w(), own.x(), own.y(), own.z()};
    sample.steps = state.steps;
    if (state.tangled) {
        sample.reason = "its cells invert before this bend";
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
    if (sample.crossings > kFewCrossings) sample.plainCrossings = plainCrossings(rotation);
    const double share = kCrossingsShare * static_cast<double>(sample.plainCrossings);
    if (sample.crossings > kFewCrossings && static_cast<double>(sample.crossings) > share)
        sample.reason = std::to_string(sample.crossings) + " pairs of triangles intersect";
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

} // namespace

SampleTree::SampleTree(const std::vector<Eigen::Quaterniond>& rotations)
    : _following(rotations.size() + 1) {
    const Eigen::Quaterniond rest = Eigen::Quaterniond::Identity();
    std::vector<double> angles;
    angles.reserve(rotations.size());
    for (const Eigen::Quaterniond& rotation : rotations)
        angles.push_back(rest.angularDistance(rotation));
    std::vector<std::size_t> order(rotations.size());
    std::iota(order.begin(), order.end(), std::size_t(0));
    std::stable_sort(order.begin(), order.end(),
                     [&angles](std::size_t a, std::size_t b) { return angles[a] < angles[b]; });
    for (std::size_t i = 0; i < order.size(); ++i) {
        const std::size_t sample = order[i];
        std::size_t from = rotations.size();
        double nearest = angles[sample];
        for (std::size_t k = 0; k < i; ++k) {
            const double away = rotations[order[k]].angularDistance(rotations[sample]);
            if (away >= nearest) continue;
            nearest = away;
            from = order[k];
        }
        _following[from].push_back(sample);
    }
}

const std::vector<std::size_t>& SampleTree::startingFrom(std::size_t sample) const {
    return sample == kRest ? _following.back() : _following[sample];
}

ElasticShapes solveJoint(const ElasticSkin& skin, const ElasticJoint& joint,
                         SharedProgress& progress) {
    return JointSolving(skin, joint, progress).run();
}

} // namespace osgSkin::elastic
