// SPDX-License-Identifier: MIT
#include "walk/WalkPlayer.h"

#include "clips/BakedClip.h"
#include "feet/Legs.h"

#include <osgSkin/GlmOsg>

#include <glm/common.hpp>

#include <algorithm>
#include <cmath>

namespace osgSkin {
namespace {

/// A longer way at once is no step, but the program placing the figure: half of a figure's height,
/// as shares of its hips' height. A sprinter seen 20 times a second goes half as far.
constexpr double kJump = 0.95;

constexpr double kSpeedTime = 0.15; ///< seconds in which the measured speed follows
constexpr double kStopTime = 0.13;  ///< longer without a move is a stop; simulators have 20 Hz
constexpr double kShortest = 0.45;  ///< the shortest steps, as shares of the clip's

constexpr double kLevel = 0.003; ///< leg lengths by which a point of the sole is lower

} // namespace

WalkPlayer::WalkPlayer(const osg::ref_ptr<const Gaits>& gaits)
    : _gaits(gaits), _toWalker(toGlm(gaits->get().toWalker)), _fromRest(rotationOf(_toWalker)),
      _forward(std::cos(gaits->get().facing), std::sin(gaits->get().facing), 0.0) {
    const Gaits::Set& set = _gaits->get();
    _unit = glm::length(transformDirection(_toWalker, {0.0, 0.0, 1.0}));
    setLayer(0, {set.standing, 0.0, 0.0, true});
    stand();
    for (std::size_t side = 0; side < set.legs.size(); ++side) {
        _leg += 0.5 * legLength(set.legs[side]);
        _height += 0.5 * jointOf(set.legs[side].hip).z;
        _radius[side] = transformDirection(_toWalker, set.legs[side].ball - set.legs[side].heel).z;
        _floor = std::min(_floor, heightOf(side));
    }
}

glm::dvec3 WalkPlayer::jointOf(std::size_t joint) const {
    const std::vector<SampledClip::Joint>& joints = _gaits->get().standing->joints();
    return transformPoint(_toWalker, apply(_whole[joint], joints[joint].centre));
}

/// Where the clips have a point of a sole.
glm::dvec3 WalkPlayer::soleOf(std::size_t side, SolePoint point) const {
    const Gaits::Leg& leg = _gaits->get().legs[side];
    const glm::dvec3& place = point == Heel ? leg.heel : point == Ball ? leg.ball : leg.tip;
    return transformPoint(_toWalker, apply(_whole[point == Tip ? leg.toe : leg.ankle], place)) -
           glm::dvec3(0.0, 0.0, point == Ball ? _radius[side] : 0.0);
}

double WalkPlayer::heightOf(std::size_t side) const {
    return std::min({soleOf(side, Heel).z, soleOf(side, Ball).z, soleOf(side, Tip).z});
}

/// The point on which a foot rolls: the one that it rolled on before, unless another is lower.
WalkPlayer::SolePoint WalkPlayer::pivotOf(std::size_t side, SolePoint now) const {
    SolePoint pivot = now;
    double height = soleOf(side, now).z - kLevel * _leg;
    for (const SolePoint point : {Heel, Ball, Tip}) {
        const double other = soleOf(side, point).z;
        if (other >= height) continue;
        height = other;
        pivot = point;
    }
    return pivot;
}

double WalkPlayer::legLength(const Gaits::Leg& leg) const {
    const glm::dvec3 knee = jointOf(leg.knee);
    return glm::distance(knee, jointOf(leg.hip)) + glm::distance(jointOf(leg.ankle), knee);
}

/// The way of one cycle of what is shown.
double WalkPlayer::stride() const {
    const Gaits::Set& set = _gaits->get();
    const double full =
        set.walking.stride +
        _running * (set.running.clip ? set.running.stride - set.walking.stride : 0.0);
    return full * std::max(_walking, kShortest);
}

/// The way since the last call along the heading, in the walker's own units. A jump is none, and
/// takes the feet along.
double WalkPlayer::measureWay(const glm::dmat4& place) {
    glm::dvec3 way(0.0);
    if (_isPlaced) way = -level(transformPoint(glm::inverse(place), glm::dvec3(_place[3])));
    if (!_isPlaced || !(glm::length(way) <= kJump * _height)) {
        for (Foot& foot : _feet) foot.isPlaced = false;
        way = glm::dvec3(0.0);
    }
    _place = place;
    _isPlaced = true;
    const double length = glm::length(way);
    return std::copysign(length, glm::dot(way, _forward) < -0.3 * length ? -1.0 : 1.0);
}

void WalkPlayer::measureSpeed(double way, double dt) {
    _still = way != 0.0 ? 0.0 : _still + dt;
    _newWay += std::abs(way);
    if (way != 0.0) _direction = std::copysign(1.0, way);
    if (!(dt > 0.0)) return;
    _pace += (_newWay / dt - _pace) * (1.0 - std::exp(-dt / kSpeedTime));
    _newWay = 0.0;
}

void WalkPlayer::chooseGait(double dt) {
    const Gaits::Set& set = _gaits->get();
    const double walk = set.walking.speed();
    const bool isMoving = !isStopped();
    double walking = 0.0, running = 0.0;
    if (isMoving) walking = std::clamp(_pace / walk, kShortest, 1.0);
    if (isMoving && set.running.clip) {
        const double run = set.running.speed(), from = walk + 0.3 * (run - walk);
        running = glm::smoothstep(from, from + 0.5 * (run - walk), _pace);
    }
    if (isMoving && _walking == 0.0) { // the right foot goes first: it swings past the left one
        const Gaits::Contact& right = set.walking.contacts[1];
        const double swing = right.begin - right.end;
        _phase = right.end + 0.5 * (swing - std::floor(swing));
    }
    _walking = towards(_walking, walking, dt / kGaitTime);
    _running = towards(_running, running, dt / kGaitTime);
    if (!isMoving && _walking == 0.0) _pace = 0.0;
}

void WalkPlayer::advancePhase(double way) {
    _phase += way / stride();
    _phase -= std::floor(_phase);
}

void WalkPlayer::blendGaits() {
    const Gaits::Set& set = _gaits->get();
    static thread_local std::vector<JointSample> other;
    const std::size_t count = set.standing->joints().size();
    _joints.resize(count);
    other.resize(count);
    const auto add = [&](const SampledClip& clip, double time, double share) {
        if (share <= 0.0) return;
        clip.evaluate(time, true, share < 1.0 ? other.data() : _joints.data());
        if (share >= 1.0) return;
        const SampleBlend blended(share);
        for (std::size_t j = 0; j < count; ++j) _joints[j] = blended(_joints[j], other[j]);
    };
    const auto addGait = [&](const Gaits::Gait& gait, double share) {
        if (gait.clip) add(*gait.clip, _phase * gait.clip->duration(), share);
    };
    if (_walking > 0.0) {
        addGait(set.walking, 1.0);
        addGait(set.running, _running);
    }
    add(*set.standing, _standingTime, 1.0 - _walking);
    localToModel(set.standing->joints(), _joints.data(), _whole);
}

void WalkPlayer::move(const glm::dmat4& place, double dt, const double* speed) {
    const double way = measureWay(place);
    measureSpeed(way, dt);
    if (speed) {
        _pace = std::abs(*speed);
        if (*speed != 0.0) _direction = std::copysign(1.0, *speed);
        _still = *speed != 0.0 ? 0.0 : std::max(_still, kStopTime);
    }
    chooseGait(dt);
    const double phaseStep = _walking > 0.0 ? way / stride() : 0.0;
    if (_walking > 0.0) advancePhase(way);
    blendGaits();
    moveFeet(dt, phaseStep);
    bendLegs();
    advance(dt);
}

bool WalkPlayer::playClip(const SampledClip& clip, double fade) {
    const Gaits::Set& set = _gaits->get();
    Layer layer{&clip, 0.0, 1.0, false};
    layer.fadeOut = fade;
    return playOn(set.standing->joints()[set.upperBody].name, layer, fade);
}

void WalkPlayer::stand() {
    _isPlaced = false;
    _pace = _walking = _running = _phase = _standingTime = 0.0;
    _still = kStopTime;
    _feet = {};
    blendGaits();
}

/// Longer without a move than a simulator's step.
bool WalkPlayer::isStopped() const {
    return _still >= kStopTime;
}

bool WalkPlayer::isStill() const {
    return _walking == 0.0 && _pace == 0.0 && _newWay == 0.0 && !getLayer(kPartLayer).clip &&
           _feet[0].step < 0.0 && _feet[1].step < 0.0;
}

} // namespace osgSkin
