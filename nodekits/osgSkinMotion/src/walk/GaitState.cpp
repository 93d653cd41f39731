// SPDX-License-Identifier: MIT
#include "walk/GaitState.h"

#include "feet/Legs.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

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

/// Most shares by which a figure's own steps are shorter, and its start is earlier or later.
constexpr double kOwnSteps = 0.12, kOwnStart = 0.15;

constexpr double kLevelling = 0.1;   ///< a second: how fast strides come to the next level
constexpr double kKeepsLevel = 0.65; ///< levels by which what is wanted may be off the present one

/// The fractional part: 0.3 for -0.7.
double fraction(double number) {
    return number - std::floor(number);
}

} // namespace

GaitState::GaitState(const Gaits& gaits, double height)
    : _gaits(&gaits), _forward(std::cos(gaits.get().facing), std::sin(gaits.get().facing), 0.0),
      _height(height) {
    stand();
}

void GaitState::vary(unsigned int number) {
    // Multiples of irrational numbers: neighbours differ, and any number of figures fills the
    // range.
    _firstFoot = 1 - number % 2;
    _firstSwing = 0.5 + kOwnStart * (2.0 * fraction(0.5 + 0.7548776662 * number) - 1.0);
    _stepsPerWay = 1.0 + kOwnSteps * fraction(0.5698402910 * number);
    _ownStanding = fraction(0.6180339887 * number);
}

double GaitState::Level::follow(double wanted, double dt, bool keeps) {
    constexpr auto levels = double(kLevels);
    if (std::abs(wanted - now) * levels > kKeepsLevel) now = std::round(wanted * levels) / levels;
    off = wanted > 0.0 ? towards(off, keeps ? now - wanted : 0.0, kLevelling * dt) : 0.0;
    return std::clamp(wanted + off, 0.0, 1.0);
}

/// The way of one cycle of what is shown.
double GaitState::stride() const {
    const Gaits::Set& set = _gaits->get();
    const double full =
        set.walking.stride +
        _running * (set.running.clip ? set.running.stride - set.walking.stride : 0.0);
    return full * std::max(_walking, kShortest);
}

/// The way since the last call along the heading, in the walker's own units. A jump is none.
double GaitState::measureWay(const glm::dmat4& place, const glm::dmat4& toWalker) {
    glm::dvec3 way(0.0);
    if (_isPlaced) way = -level(transformPoint(toWalker, glm::dvec3(_place[3])));
    double length = glm::length(way);
    _hasJumped = !_isPlaced || !(length <= kJump * _height);
    if (_hasJumped) length = 0.0;
    _place = place;
    _isPlaced = true;
    return std::copysign(length, glm::dot(way, _forward) < -0.3 * length ? -1.0 : 1.0);
}

void GaitState::measureSpeed(double way, double dt) {
    _still = way != 0.0 ? 0.0 : _still + dt;
    _newWay += std::abs(way);
    if (way != 0.0) _direction = std::copysign(1.0, way);
    if (!(dt > 0.0)) return;
    _pace += (_newWay / dt - _pace) * (1.0 - std::exp(-dt / kSpeedTime));
    _newWay = 0.0;
}

void GaitState::chooseGait(double dt) {
    const Gaits::Set& set = _gaits->get();
    const double walk = set.walking.speed();
    const bool isMoving = !isStopped();
    double walking = 0.0, running = 0.0;
    if (isMoving) walking = std::clamp(_pace / (walk * _stepsPerWay), kShortest, 1.0);
    if (isMoving && set.running.clip) {
        const double run = set.running.speed(), from = walk + 0.3 * (run - walk);
        running = glm::smoothstep(from, from + 0.5 * (run - walk), _pace);
    }
    if (isMoving && _walking == 0.0) { // the foot that goes first swings past the other one
        const Gaits::Contact& first = set.walking.contacts[_firstFoot];
        _phase = first.end + _firstSwing * fraction(first.begin - first.end);
        _standingTime += _ownStanding * set.standing->duration();
    }
    _walking = towards(_walking, _walkingLevel.follow(walking, dt, _keepsLevels), dt / kGaitTime);
    _running = towards(_running, _runningLevel.follow(running, dt, _keepsLevels), dt / kGaitTime);
    if (!isMoving && _walking == 0.0) _pace = 0.0;
}

void GaitState::move(const glm::dmat4& place, const glm::dmat4& toWalker, double dt,
                     const double* speed) {
    const double way = measureWay(place, toWalker);
    measureSpeed(way, dt);
    if (speed) {
        _pace = std::abs(*speed);
        if (*speed != 0.0) _direction = std::copysign(1.0, *speed);
        _still = *speed != 0.0 ? 0.0 : std::max(_still, kStopTime);
    }
    chooseGait(dt);
    _phaseStep = _walking > 0.0 ? way / stride() : 0.0;
    if (_walking > 0.0) _phase = fraction(_phase + way / stride());
}

void GaitState::stand() {
    _isPlaced = false;
    _hasJumped = true;
    _pace = _walking = _running = _phase = _standingTime = 0.0;
    _still = kStopTime;
    _walkingLevel = _runningLevel = {};
}

void GaitState::show(double standingTime) {
    stand();
    _standingTime = standingTime;
}

void GaitState::show(double walking, double running, double phase, double step) {
    _walking = walking;
    _running = running;
    _phase = phase;
    _direction = std::copysign(1.0, step);
    _phaseStep = step;
    _place[3] += glm::dvec4(step * stride() * _forward, 0.0);
    _hasJumped = false;
    _still = 0.0;
}

/// Longer without a move than a simulator's step.
bool GaitState::isStopped() const {
    return _still >= kStopTime;
}

} // namespace osgSkin
