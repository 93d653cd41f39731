// SPDX-License-Identifier: MIT
//
// Where a walker's feet stand, and the legs that reach them.
#include "walk/WalkPlayer.h"

#include "bones/TwoBone.h"
#include "feet/Legs.h"

#include <glm/common.hpp>
#include <glm/gtc/constants.hpp>

#include <algorithm>
#include <cmath>

namespace osgSkin {
namespace {

constexpr double kStepTime = 0.35;  ///< of a step on the spot
constexpr double kStepLift = 0.06;  ///< leg lengths, of a step on the spot
constexpr double kClearance = 0.02; ///< leg lengths, of a sole above the floor in mid-swing
constexpr double kMaxOffset = 0.06; ///< maximum foothold error, leg lengths
constexpr double kMaxTurn = 0.5;    ///< the same, radians
constexpr double kMaxReach = 0.5;   ///< leg lengths by which a planted foot may be off its clip's
constexpr double kStraight = 0.999; ///< of a leg's length, which it may have
constexpr double kMaxDrop = 0.12;   ///< leg lengths by which hips are lowered for planted feet

double angleOf(const glm::dvec3& direction) {
    return std::atan2(direction.y, direction.x);
}

double wrapped(double angle) {
    return std::remainder(angle, glm::two_pi<double>());
}

glm::dquat aboutZ(double angle) {
    return glm::angleAxis(angle, glm::dvec3(0.0, 0.0, 1.0));
}

} // namespace

/// Notes where on the ground a foot is.
/// \param pivot where the clips have it
void WalkPlayer::stayAt(Foot& foot, const glm::dvec3& pivot) {
    foot.spot = transformPoint(_place, pivot + foot.offset);
    foot.heading = transformDirection(_place, aboutZ(foot.turn) * _forward);
}

/// Makes a point of a foot's sole the one about which it turns and rolls.
void WalkPlayer::rollOnto(Foot& foot, std::size_t side, SolePoint point) {
    const glm::dvec3 before = soleOf(side, foot.pivot), now = soleOf(side, point);
    foot.offset += before + aboutZ(foot.turn) * (now - before) - now;
    foot.pivot = point;
    stayAt(foot, now);
}

/// Plants a foot where it is.
void WalkPlayer::plant(Foot& foot, std::size_t side) {
    foot.isPlanted = foot.isPlaced = true;
    foot.step = -1.0;
    rollOnto(foot, side, pivotOf(side, foot.pivot));
}

/// Where feet are beside the clips' feet: planted ones keep their place on the ground, others come
/// back to their clip until they are set down.
void WalkPlayer::moveFeet(double dt, double phaseStep) {
    const Gaits::Set& set = _gaits->get();
    const glm::dmat4 toWalker = glm::inverse(_place);
    const bool goes = _walking > 0.0;
    for (std::size_t side = 0; side < _feet.size(); ++side) {
        Foot& foot = _feet[side];
        foot.lift = 0.0;
        const Gaits::Gait& gait = set.running.clip && _running > 0.5 ? set.running : set.walking;
        if (!foot.isPlaced) { // stand where the clips say
            foot.offset = glm::dvec3(0.0);
            foot.turn = 0.0;
            plant(foot, side);
            foot.isPlanted = !goes || gait.contacts[side].contains(_phase);
        }
        const bool isStopping = goes && isStopped();
        // Where it stops, a foot in the air is put down as the figure comes to stand.
        const bool carries =
            isStopping ? foot.isPlanted : !goes || gait.contacts[side].contains(_phase);
        if (carries && !foot.isPlanted) plant(foot, side);
        if (foot.isPlanted && foot.step < 0.0) {
            const double down = towards(foot.offset.z, _floor - heightOf(side), _leg * dt);
            foot.offset = level(transformPoint(toWalker, foot.spot) - soleOf(side, foot.pivot));
            foot.offset.z = down;
            foot.turn =
                wrapped(angleOf(transformDirection(toWalker, foot.heading)) - angleOf(_forward));
            const double off = glm::length(level(foot.offset)), most = kMaxReach * _leg;
            if (goes && off > most) { // dragged along
                foot.offset *= most / off;
                plant(foot, side);
            } else if (const SolePoint next = pivotOf(side, foot.pivot); next != foot.pivot) {
                rollOnto(foot, side, next);
            }
        }
        foot.isPlanted = carries;
        if (carries) continue;
        // In the air.
        // What is left of the swing; a foot that is up in a stop comes back in that time.
        const Gaits::Contact& contact = gait.contacts[side];
        const double ahead = contact.begin - _phase, behind = _phase - contact.end;
        const double toBegin = ahead - std::floor(ahead), toEnd = behind - std::floor(behind);
        const double left = phaseStep >= 0.0 ? toBegin : toEnd;
        // Short steps are blended with standing, where feet are on the floor.
        foot.lift = 4.0 * kStepLift * _leg * (1.0 - _walking) * toBegin * toEnd /
                    ((toBegin + toEnd) * (toBegin + toEnd) + 1e-9);
        const double share =
            isStopping ? dt / kGaitTime : std::abs(phaseStep) / (left + std::abs(phaseStep) + 1e-9);
        if (isStopping) foot.lift = 4.0 * kStepLift * _leg * _walking * (1.0 - _walking);
        foot.offset *= 1.0 - std::min(1.0, share);
        foot.turn *= 1.0 - std::min(1.0, share);
        const double clear = 4.0 * kClearance * _leg * _walking * toBegin * toEnd /
                             ((toBegin + toEnd) * (toBegin + toEnd) + 1e-9);
        foot.lift = std::max(foot.lift, _floor + clear - heightOf(side) - foot.offset.z);
    }
    if (goes)
        for (Foot& foot : _feet) foot.step = -1.0;
    else
        stepOnTheSpot(dt);
    for (std::size_t side = 0; side < _feet.size(); ++side) // nothing sinks into the floor
        _feet[side].offset.z = std::max(_feet[side].offset.z, _floor - heightOf(side));
}

/// Brings standing feet to their place, one after the other.
void WalkPlayer::stepOnTheSpot(double dt) {
    const auto isOff = [&](const Foot& foot) {
        return glm::length(level(foot.offset)) > kMaxOffset * _leg ||
               std::abs(foot.turn) > kMaxTurn;
    };
    if (_feet[0].step < 0.0 && _feet[1].step < 0.0) {
        const std::size_t farther =
            glm::length(level(_feet[0].offset)) > glm::length(level(_feet[1].offset)) ? 0 : 1;
        const std::size_t next = isOff(_feet[farther]) ? farther : 1 - farther;
        if (!isOff(_feet[next])) return;
        _feet[next].step = 0.0;
        _feet[next].stepOffset = _feet[next].offset;
        _feet[next].stepTurn = _feet[next].turn;
    }
    for (std::size_t side = 0; side < _feet.size(); ++side) {
        Foot& foot = _feet[side];
        if (foot.step < 0.0) continue;
        foot.step += dt / kStepTime;
        const double left = 1.0 - glm::smoothstep(0.0, 1.0, foot.step);
        foot.offset = foot.stepOffset * left;
        foot.turn = foot.stepTurn * left;
        foot.lift = 4.0 * kStepLift * _leg * left * (1.0 - left);
        if (foot.step >= 1.0) plant(foot, side);
    }
}

/// Rotates a joint about its centre.
/// \param world in rest space
void WalkPlayer::rotateJoint(std::size_t joint, const glm::dquat& world) {
    const int parent = _gaits->get().standing->joints()[joint].parent;
    const glm::dquat above = parent < 0 ? glm::dquat(1.0, 0.0, 0.0, 0.0)
                                        : _whole[static_cast<std::size_t>(parent)].rotation;
    _joints[joint].rotation =
        glm::normalize(glm::conjugate(above) * world * _whole[joint].rotation);
    // What lies below in the leg; the rest is not looked at.
    for (const Gaits::Leg& leg : _gaits->get().legs)
        if (joint >= leg.hip && joint <= leg.ankle) findLeg(joint, leg.ankle);
}

void WalkPlayer::findLeg(std::size_t first, std::size_t last) {
    const std::vector<SampledClip::Joint>& joints = _gaits->get().standing->joints();
    for (std::size_t j = first; j <= last; ++j) {
        const JointMap own = mapOf(_joints[j], joints[j].centre);
        const int parent = joints[j].parent;
        _whole[j] = parent < 0 ? own : _whole[static_cast<std::size_t>(parent)] * own;
    }
}

/// Lowers the hips until the legs reach the planted feet.
void WalkPlayer::lowerHips(const std::array<glm::dvec3, 2>& targets) {
    const Gaits::Set& set = _gaits->get();
    double drop = 0.0;
    for (std::size_t side = 0; side < targets.size(); ++side) {
        const Gaits::Leg& leg = set.legs[side];
        const glm::dvec3 hip = jointOf(leg.hip);
        const double length = kStraight * legLength(leg);
        const double away = glm::length(level(targets[side] - hip));
        if (away >= length || !_feet[side].isPlanted) continue;
        drop = std::max(drop, hip.z - targets[side].z - std::sqrt(length * length - away * away));
    }
    if (!(drop > 0.0)) return;
    drop = std::min(drop, kMaxDrop * _leg);
    const std::size_t root = set.standing->rootJoint();
    const int parent = set.standing->joints()[root].parent;
    const JointMap above = parent < 0 ? JointMap() : _whole[static_cast<std::size_t>(parent)];
    const glm::dvec3 down = glm::conjugate(_fromRest) * glm::dvec3(0.0, 0.0, -drop / _unit);
    _joints[root].translation += glm::conjugate(above.rotation) * down / above.scale;
    localToModel(set.standing->joints(), _joints.data(), _whole);
}

/// Bends the legs so that the feet are where they are meant to be.
void WalkPlayer::bendLegs() {
    const Gaits::Set& set = _gaits->get();
    std::array<glm::dvec3, 2> targets;
    std::array<glm::dquat, 2> soles;
    bool isNeeded = false;
    for (std::size_t side = 0; side < _feet.size(); ++side) {
        const Foot& foot = _feet[side];
        const glm::dvec3 pivot = soleOf(side, foot.pivot), ankle = jointOf(set.legs[side].ankle);
        targets[side] = pivot + aboutZ(foot.turn) * (ankle - pivot) + foot.offset +
                        glm::dvec3(0.0, 0.0, foot.lift);
        isNeeded =
            isNeeded || glm::distance(targets[side], ankle) > 1e-9 * _leg || foot.turn != 0.0;
    }
    if (!isNeeded) return;
    const auto toRest = [&](const glm::dquat& rotation) {
        return glm::conjugate(_fromRest) * rotation * _fromRest;
    };
    for (std::size_t side = 0; side < _feet.size(); ++side)
        soles[side] = toRest(aboutZ(_feet[side].turn)) * _whole[set.legs[side].ankle].rotation;
    lowerHips(targets);
    for (std::size_t side = 0; side < _feet.size(); ++side) {
        const Gaits::Leg& leg = set.legs[side];
        const LimbTurns limb =
            reachTurns(jointOf(leg.hip), jointOf(leg.knee), jointOf(leg.ankle), targets[side]);
        rotateJoint(leg.knee, toRest(limb.lower));
        rotateJoint(leg.hip, toRest(limb.upper));
        rotateJoint(leg.ankle, soles[side] * glm::conjugate(_whole[leg.ankle].rotation));
    }
}

} // namespace osgSkin
