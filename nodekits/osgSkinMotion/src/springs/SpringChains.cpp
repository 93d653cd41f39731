// SPDX-License-Identifier: MIT
#include "springs/SpringChains.h"

#include <glm/common.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace osgSkin {
namespace {

constexpr double kVrmRate = 60.0;       ///< frames a second for which VRM's numbers are meant
constexpr double kStep = 1.0 / 480.0;   ///< seconds, at most
constexpr double kLongestFrame = 0.25;  ///< seconds; more is a pause
constexpr double kJump = 1.0;           ///< metres in one frame, beyond the speed before it
constexpr double kTurnCosine = 0.70711; ///< of half the turn that is a jump, 90 degrees
constexpr int kSettleSteps = 60;        ///< of 1/60 s
constexpr double kMinBraking = -0.3;    ///< of a bone that is pushed, which speeds it up
constexpr double kSettleDrag = 0.5;     ///< at least
constexpr double kTiny = 1e-9;          ///< metres
constexpr double kMinLength = 1e-3;     ///< of a bone, in lengths of its chain's longest
constexpr double kMaxStiffness = 1e6, kMaxLength = 1e12;
constexpr double kClear = 1e-3; ///< room to colliders, so that few rounds are needed
constexpr int kMaxRounds = 128; ///< among several colliders

double inRange(double value, double most) {
    return std::isfinite(value) ? std::clamp(value, 0.0, most) : 0.0;
}

bool isSound(const glm::dvec3& v) {
    return std::abs(v.x) <= kMaxLength && std::abs(v.y) <= kMaxLength &&
           std::abs(v.z) <= kMaxLength;
}

bool isSound(const SpringChains::Frame& frame) {
    for (const SpringChains::Bone& bone : frame.bones)
        if (!isSound(bone.head) || !isSound(bone.tip) || !isFinite(bone.axes)) return false;
    for (const SpringChains::Collider& c : frame.colliders)
        if (!isSound(c.start) || !isSound(c.end) || !(std::abs(c.radius) <= kMaxLength))
            return false;
    return isFinite(frame.fromWorld);
}

bool isSound(const SpringChains::State& state) {
    for (const glm::dvec3* v :
         {&state.frameSpeed, &state.head, &state.headSpeed, &state.speed, &state.bone, &state.pose})
        if (!isSound(*v)) return false;
    return std::abs(state.pull) <= kMaxLength;
}

/// shortestRotation() of unit vectors.
glm::dquat swingOf(const glm::dvec3& from, const glm::dvec3& to) {
    const double cosine = glm::dot(from, to);
    if (cosine < -0.999) return shortestRotation(from, to);
    return glm::normalize(glm::dquat(1.0 + cosine, glm::cross(from, to)));
}

glm::dvec3 nearestOn(const SpringChains::Collider& capsule, const glm::dvec3& point) {
    const glm::dvec3 axis = capsule.end - capsule.start;
    const double square = glm::dot(axis, axis);
    if (square <= kTiny * kTiny) return capsule.start;
    return capsule.start +
           axis * std::clamp(glm::dot(point - capsule.start, axis) / square, 0.0, 1.0);
}

/// Moves a tip to a distance from its joint, along the bone that it had before (SHAKE).
/// All relative to the joint.
glm::dvec3 toLength(const glm::dvec3& tip, const glm::dvec3& before, double length) {
    const double along = glm::dot(tip, before), square = glm::dot(before, before);
    const double inside = along * along - square * (glm::dot(tip, tip) - length * length);
    if (square > 0.0 && inside > 0.0 && along > 0.0)
        return tip + before * ((std::sqrt(inside) - along) / square);
    const double reached = glm::length(tip);
    return reached > kTiny ? tip * (length / reached) : before;
}

/// Moves a tip, on the sphere about its joint, to the nearest point of a ball's surface, or to the
/// one nearest to that.
/// \param ball relative to the joint
/// \param tip relative to the joint
glm::dvec3 ontoBall(const glm::dvec3& ball, double radius, double length, const glm::dvec3& tip) {
    const double distance = glm::length(ball);
    if (distance <= kTiny) return tip;
    const glm::dvec3 towards = ball / distance;
    const double cosine = std::clamp((length * length + distance * distance - radius * radius) /
                                         (2.0 * length * distance),
                                     -1.0, 1.0);
    glm::dvec3 side = tip - towards * glm::dot(tip, towards);
    const double width = glm::length(side);
    side = width > kTiny * length ? side / width : anyPerpendicular(towards);
    return length * (towards * cosine + side * std::sqrt(1.0 - cosine * cosine));
}

} // namespace

SpringChains::SpringChains(std::vector<Joint> joints)
    : _joints(std::move(joints)), _states(_joints.size()), _tips(_joints.size()) {
    for (std::size_t j = 0; j < _joints.size(); ++j) {
        Joint& joint = _joints[j];
        joint.stiffness = inRange(joint.stiffness, kMaxStiffness);
        joint.drag = inRange(joint.drag, 1.0);
        joint.radius = inRange(joint.radius, kMaxLength);
        if (!isSound(joint.gravity)) joint.gravity = glm::dvec3(0.0);
        _states[j].top = joint.parent < 0 ? j : _states[static_cast<std::size_t>(joint.parent)].top;
    }
}

bool SpringChains::move(const Frame& frame, double seconds, std::size_t maxRechecks) {
    _checks = _rechecks = 0;
    _maxRechecks = maxRechecks;
    if (!isSound(frame) || !std::isfinite(seconds)) return false;
    std::swap(_before, _now);
    _now = frame;
    if (!_isMoving) {
        settle();
        return true;
    }
    const bool isPause = seconds < 0.0 || seconds > kLongestFrame;
    carryOverJumps(seconds, isPause);
    seconds = std::clamp(seconds, 0.0, kLongestFrame);
    const int steps = std::max(1, static_cast<int>(std::ceil(seconds / kStep - 1e-6)));
    prepare(seconds / steps, 0.0);
    for (int i = 1; i <= steps; ++i) step(double(i) / steps);
    return true;
}

bool SpringChains::recall(const std::vector<State>& states, const std::vector<glm::dvec3>& tips,
                          const Frame& frame) {
    for (std::size_t j = 0; j < _states.size(); ++j)
        if (!isSound(states[j]) || !isSound(tips[j])) return false;
    if (!isSound(frame)) return false;
    for (std::size_t j = 0; j < _states.size(); ++j) {
        const std::size_t top = _states[j].top;
        _states[j] = states[j];
        _states[j].top = top;
    }
    _tips = tips;
    _now = frame;
    _isMoving = true;
    findLeastLengths();
    return true;
}

void SpringChains::findLeastLengths() {
    std::vector<double> longest(_joints.size(), 0.0); // of the chain with that top
    for (std::size_t j = 0; j < _joints.size(); ++j)
        longest[_states[j].top] =
            std::max(longest[_states[j].top], glm::length(_now.bones[j].tip - _now.bones[j].head));
    for (State& state : _states)
        state.leastLength = std::max(kTiny, kMinLength * longest[state.top]);
}

void SpringChains::settle() {
    _before = _now;
    _isMoving = true;
    findLeastLengths();
    for (std::size_t j = 0; j < _joints.size(); ++j) {
        const Bone& bone = _now.bones[j];
        State& state = _states[j];
        _tips[j] = bone.tip;
        state.head = bone.head;
        state.bone = bone.tip - bone.head;
        const double length = glm::length(state.bone);
        state.pose = length > kTiny ? state.bone / length : glm::dvec3(0.0);
        state.speed = state.headSpeed = state.frameSpeed = glm::dvec3(0.0);
        state.pull = 0.0;
    }
    prepare(1.0 / kVrmRate, kSettleDrag);
    for (int i = 0; i < kSettleSteps; ++i) step(1.0);
    for (State& state : _states) state.speed = glm::dvec3(0.0);
}

/// Where a chain's topmost bone jumps, moves the frame before and all tips along.
void SpringChains::carryOverJumps(double seconds, bool isPause) {
    bool isAnyJump = false;
    for (std::size_t j = 0; j < _joints.size(); ++j) {
        State& state = _states[j];
        State& top = _states[state.top];
        const Bone& to = _now.bones[state.top];
        if (state.top == j) {
            const Bone& from = _before.bones[j];
            const glm::dvec3 way = to.head - from.head;
            top.jumpFrom = from.head;
            top.jumpTurn = to.axes * glm::inverse(from.axes);
            top.isJump = isPause || seconds == 0.0 || std::abs(top.jumpTurn.w) < kTurnCosine ||
                         glm::length(way - top.frameSpeed * seconds) > kJump;
            if (seconds != 0.0) top.frameSpeed = isPause ? glm::dvec3(0.0) : way / seconds;
        }
        if (!top.isJump) continue;
        isAnyJump = true;
        for (glm::dvec3* point :
             {&_before.bones[j].head, &_before.bones[j].tip, &_tips[j], &state.head})
            *point = to.head + top.jumpTurn * (*point - top.jumpFrom);
        for (glm::dvec3* v : {&state.speed, &state.headSpeed, &state.pose, &state.bone})
            *v = top.jumpTurn * *v;
    }
    if (isAnyJump) _before.colliders = _now.colliders;
}

/// Sets what is the same in all steps of a frame.
void SpringChains::prepare(double seconds, double leastDrag) {
    _step = seconds;
    for (std::size_t j = 0; j < _joints.size(); ++j) {
        const double drag = std::max(_joints[j].drag, leastDrag), shares = kVrmRate * seconds;
        const double kept = seconds > 0.0 ? std::pow(1.0 - drag, shares) : 1.0;
        // As if the speed were gained evenly meanwhile: the same final speed at any step.
        const double gain = drag > 0.0 ? (1.0 - kept) / drag : shares;
        State& state = _states[j];
        state.kept = kept;
        state.gainToPose = gain * _joints[j].stiffness;
        state.gain = _now.fromWorld * (gain * _joints[j].gravity);
    }
}

/// \param share of the frame that is over after the step
void SpringChains::step(double share) {
    for (std::size_t j = 0; j < _joints.size(); ++j) {
        const Bone &before = _before.bones[j], &now = _now.bones[j];
        State& state = _states[j];
        const int parent = _joints[j].parent;
        const glm::dvec3 lastHead = state.head;
        state.head = glm::mix(before.head, now.head, share);
        state.swing = glm::dquat(1.0, 0.0, 0.0, 0.0);
        if (parent >= 0) {
            const auto p = static_cast<std::size_t>(parent);
            state.swing = _states[p].swing;
            state.head =
                _states[p].head + state.swing * glm::mix(before.head - _before.bones[p].head,
                                                         now.head - _now.bones[p].head, share);
        }
        const glm::dvec3 bone =
            state.swing * glm::mix(before.tip - before.head, now.tip - now.head, share);
        const double length = glm::length(bone);
        const glm::dvec3 last = std::exchange(_tips[j], state.head);
        if (length <= state.leastLength) continue;
        const double braking = std::max(state.pull / (kVrmRate * length), kMinBraking);
        const glm::dvec3 speed =
            state.kept * (state.headSpeed + (state.speed - state.headSpeed) /
                                                (1.0 + braking * (1.0 + 0.5 * braking))) +
            state.gainToPose * state.pose + state.gain;
        const glm::dvec3 free = last + _step * speed - state.head;
        glm::dvec3 tip = toLength(free, state.bone, length);
        const double pull = glm::dot(free - tip, state.bone) / length;
        tip = outOfColliders(j, length, tip, share);
        _tips[j] += tip;
        if (_step > 0.0) {
            state.speed = (_tips[j] - last) / _step;
            state.headSpeed = (state.head - lastHead) / _step;
            state.pull = pull / _step;
        }
        state.pose = bone / length;
        state.bone = tip;
        state.swing = swingOf(state.pose, tip / length) * state.swing;
    }
}

/// \param tip relative to the joint
glm::dvec3 SpringChains::outOfColliders(std::size_t joint, double length, glm::dvec3 tip,
                                        double share) {
    const glm::dvec3& head = _states[joint].head;
    const std::size_t pairs = _joints[joint].colliders.size();
    bool isMoved = pairs > 0;
    for (int round = 0; isMoved && round < kMaxRounds; ++round) {
        isMoved = false;
        if (round > 0 && _rechecks + pairs > _maxRechecks) break;
        if (round > 0) _rechecks += pairs;
        _checks += pairs;
        for (const std::size_t index : _joints[joint].colliders) {
            const Collider &before = _before.colliders[index], &now = _now.colliders[index];
            const Collider at{glm::mix(before.start, now.start, share) - head,
                              glm::mix(before.end, now.end, share) - head, now.radius};
            const glm::dvec3 ball = nearestOn(at, tip);
            const bool isInside = at.radius < 0.0;
            const double radius = isInside ? std::max(-at.radius - _joints[joint].radius, 0.0)
                                           : at.radius + _joints[joint].radius;
            if ((glm::length(tip - ball) >= radius) != isInside) continue;
            const double clear = kClear * std::min(radius, length);
            tip = ontoBall(ball, isInside ? radius - clear : radius + clear, length, tip);
            isMoved = true;
        }
    }
    return tip;
}

} // namespace osgSkin
