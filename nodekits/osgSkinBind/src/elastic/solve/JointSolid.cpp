// SPDX-License-Identifier: GPL-3.0-or-later
#include "elastic/solve/JointSolid.h"

#include <cmath>
#include <utility>

namespace osgSkin::elastic {
namespace {

/// A step is halved where its first guess inverts a cell, but not below this: radians.
constexpr double kSmallestTurn = 0.02;

/// A state is this near to its goal, radians.
constexpr double kThere = 1e-9;

} // namespace

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
    return state;
}

bool JointSolid::defined(const Points& nodes) const {
    Points gradient = Points::Zero(3, nodes.cols());
    return std::isfinite(_body.value(nodes, gradient));
}

Points JointSolid::guess(const State& from, const Eigen::Quaterniond& to) const {
    Points nodes = turned(from.nodes, _ratios, to * from.turn.conjugate());
    // Steps about different axes do not add up, so pinned nodes go their whole way.
    const Eigen::Index pinned = nodes.cols() - _lattice.freeNodes();
    nodes.rightCols(pinned) = turned(_lattice.rest().rightCols(pinned), _ratios.tail(pinned), to);
    return nodes;
}

JointSolid::State JointSolid::bend(const State& from, const Eigen::Quaterniond& to,
                                   const std::function<bool(const State&)>& goOn) const {
    FoldContact contact(_fold);
    State state = from;
    state.steps = 0;
    double left = state.turn.angularDistance(to);
    double largest = _options.largestTurn;
    while (left > kThere) {
        const double step = left / std::ceil(left / largest - 1e-9);
        const Eigen::Quaterniond next = state.turn.slerp(step / left, to);
        Points nodes = guess(state, next);
        if (!defined(nodes)) {
            largest = 0.5 * step;
            if (largest >= kSmallestTurn) continue;
            state.tangled = true;
            return state;
        }
        const Points goals = _cores.goals(next);
        const std::vector<Bone> bones = _outer.posed(next);
        const Points plain = turned(_lattice.rest(), _ratios, next);
        contact.restart();
        Energy energy;
        energy.value = [&](const Points& at, Points& gradient) {
            gradient.setZero();
            double value = _body.value(at, gradient);
            if (!std::isfinite(value)) return value;
            value += _cores.value(at, goals, gradient) + _fascia.value(at, plain, gradient) +
                     _outer.value(at, bones, gradient) + contact.value(at, gradient);
            gradient.rightCols(at.cols() - _lattice.freeNodes()).setZero();
            return value;
        };
        energy.precondition = [this](const Points& gradient) {
            return _preconditioner.solve(gradient);
        };
        energy.renew = [&contact](const Points& at) { contact.detect(at); };
        const MinimiseResult result = minimise(energy, nodes, _options.limits);
        state.nodes = std::move(nodes);
        state.turn = next;
        state.converged = result.converged;
        state.steps += result.steps;
        left = state.turn.angularDistance(to);
        state.stopped = !goOn(state) && left > kThere;
        if (state.stopped) break;
    }
    return state;
}

} // namespace osgSkin::elastic
