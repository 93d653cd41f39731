// SPDX-License-Identifier: MIT
#include "ground/LegsOnGround.h"

#include "bones/TwoBone.h"
#include "feet/Legs.h"
#include "retarget/PlantedFoot.h"

#include <glm/common.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace osgSkin {
namespace {

// Lengths are leg lengths, times are seconds.
constexpr double kBrakeTime = 0.02;   ///< over which a foot's braking is measured
constexpr double kSlideTime = 0.04;   ///< for which a standing foot may be faster
constexpr double kRolling = 0.1;      ///< speed of a standing foot that is not flat yet
constexpr double kEdge = 0.03;        ///< larger differences of the ground's height are steps
constexpr double kEdgeInAir = 0.06;   ///< the same below a foot in the air
constexpr double kFootTime = 0.04;    ///< over which a changed foothold is blended in
constexpr double kLandTime = 0.02;    ///< the same of one that has just come down
constexpr double kLanding = 0.2;      ///< seconds
constexpr double kNormalTime = 0.05;  ///< in which it turns to a slope
constexpr double kChosen = 0.4;       ///< share of the swing after which the foothold is final
constexpr double kLead = 0.08;        ///< how long before an edge a foot rises
constexpr double kShiftTime = 0.05;   ///< over which a foot is moved off an edge
constexpr double kOnUpper = 0.4;      ///< less of a sole on the upper step is moved off it
constexpr double kMaxShift = 0.16;    ///< the largest shift away from an edge
constexpr double kWaitTime = 0.1;     ///< of catching up after a wait before an edge
constexpr double kMaxWait = 0.3;      ///< the longest way that a foot stays back before an edge
constexpr double kMargin = 0.025;     ///< between a sole and an edge
constexpr double kHipsTime = 0.06;    ///< in which the hips follow the feet
constexpr double kMaxHipsSpeed = 1.9; ///< leg lengths a second
constexpr double kStraight = 0.995;   ///< share of its length to which a leg may stretch
constexpr double kShortest = 0.35; ///< share of the leg's length that is left when it is bent most
constexpr double kJump = 0.6;      ///< a longer way in a step: the program placed the figure
constexpr double kPause = 0.25;    ///< a longer step begins again
constexpr double kSteepest = 0.5;  ///< cosine, of slopes that feet are turned to

/// The way of a critically damped spring to 0.
void settle(double& value, double& speed, double time, double dt) {
    const double rate = 1.0 / time, push = (speed + rate * value) * dt, left = std::exp(-rate * dt);
    speed = (speed - rate * push) * left;
    value = (value + push) * left;
}

template <typename T>
void follow(T& value, const T& target, double time, double dt) {
    value += (target - value) * (1.0 - std::exp(-dt / time));
}

} // namespace

double GroundPlane::heightAt(const glm::dvec3& place) const {
    const glm::dvec3 away = place - point;
    return point.z - (away.x * normal.x + away.y * normal.y) / normal.z;
}

/// The ground below a sole.
class LegsOnGround::BelowSole {
public:
    BelowSole(const SolePoints& sole, const FindGround& ground, double edge)
        : atHeel(ground(sole[Heel])), atBall(ground(sole[Ball])), atTip(ground(sole[Tip])),
          _sole(sole), _ground(ground), _edge(edge) {}

    static double over(const std::optional<GroundPlane>& at, const GroundPlane& plane) {
        return at->point.z - plane.heightAt(at->point);
    }
    bool isAbove(const std::optional<GroundPlane>& at, const GroundPlane& plane) const {
        return at && over(at, plane) > _edge;
    }
    bool isOn(const std::optional<GroundPlane>& at, const GroundPlane& plane) const {
        return at && std::abs(over(at, plane)) <= _edge;
    }
    bool isPartlyOn(const GroundPlane& plane) const {
        return isOn(atHeel, plane) || isOn(atBall, plane) || isOn(atTip, plane);
    }

    /// The part of the line between two points that is on a plane, which begins there.
    double shareOn(const GroundPlane& plane, SolePoint from, SolePoint to) const {
        double low = 0.0, high = 1.0;
        for (int i = 0; i < 3; ++i) {
            const double middle = 0.5 * (low + high);
            const glm::dvec3 point = _sole[from] + (_sole[to] - _sole[from]) * middle;
            (isOn(_ground(point), plane) ? low : high) = middle;
        }
        return 0.5 * (low + high);
    }

    /// The plane of its heel and its ball, or where these are on different steps the upper one, if
    /// enough of the sole is on it.
    /// \param upper set to the upper one in any case
    GroundPlane plane(double floor, GroundPlane& upper) const {
        const glm::dvec3 &heel = _sole[Heel], &ball = _sole[Ball];
        GroundPlane plane{{ball.x, ball.y, floor}};
        for (const std::optional<GroundPlane>* at : {&atTip, &atHeel, &atBall})
            if (*at) plane = **at;
        upper = plane;
        if (!atHeel || !atBall) return plane;
        const double rise = atBall->point.z - atHeel->point.z;
        const double byBall = rise + over(atHeel, *atBall), byHeel = rise - over(atBall, *atHeel);
        const glm::dvec3 along = level(ball - heel);
        if (rise < std::min(byBall, byHeel) - _edge || rise > std::max(byBall, byHeel) + _edge) {
            const glm::dvec3 middle = (heel + ball) * 0.5;
            if (atHeel->heightAt(middle) > atBall->heightAt(middle)) {
                upper = *atHeel;
                if (shareOn(upper, Heel, Ball) >= kOnUpper) plane = upper;
            }
        } else if (glm::length(along) > _edge) { // both points are on it
            const glm::dvec3 direction = unitOrZero(along + glm::dvec3(0.0, 0.0, rise));
            plane.normal = unitOrZero(plane.normal - direction * glm::dot(plane.normal, direction));
            upper = plane;
        }
        return plane;
    }

    const std::optional<GroundPlane> atHeel, atBall, atTip;

private:
    const SolePoints& _sole;
    const FindGround& _ground;
    const double _edge;
};

/// The plane on which a foot is to stand.
/// \param chosen before, which it keeps while any part of the sole is on it; null: none
/// \param shift off the edges of higher steps
GroundPlane LegsOnGround::findPlane(const SolePoints& sole, const GroundPlane* chosen,
                                    const FindGround& ground, glm::dvec3& shift) const {
    const auto& [heel, ball, tip] = sole;
    const BelowSole below(sole, ground, kEdge * _leg);
    GroundPlane upper, plane = below.plane(_floor, upper);
    if (chosen && std::abs(plane.heightAt(ball) - chosen->heightAt(ball)) > kEdge * _leg &&
        below.isPartlyOn(*chosen))
        plane = *chosen;
    const glm::dvec3 margin = unitOrZero(level(tip - heel)) * (kMargin * _leg);
    shift = glm::dvec3(0.0);
    if (below.isAbove(below.atHeel, plane))
        shift = level(ball - heel) * below.shareOn(*below.atHeel, Heel, Ball) + margin;
    else if (below.isAbove(below.atBall, plane))
        shift = level(ball - heel) * below.shareOn(plane, Heel, Ball) + level(heel - tip) - margin;
    else if (below.isAbove(below.atTip, plane))
        shift = level(tip - ball) * (below.shareOn(plane, Ball, Tip) - 1.0) - margin;
    if (glm::length(shift) > kMaxShift * _leg) {
        shift = glm::dvec3(0.0);
        plane = upper;
    }
    if (plane.normal.z < kSteepest) plane.normal = {0.0, 0.0, 1.0};
    if (below.atTip && shift == glm::dvec3(0.0))
        plane.point.z += std::max(0.0, BelowSole::over(below.atTip, plane));
    plane.point = {ball.x, ball.y, plane.heightAt(ball)};
    return plane;
}

/// The remaining distance of a foot in the air: as far beyond the other one as it was
/// behind, or until it stops.
double LegsOnGround::remainingSwing(const ClipLeg& leg, const Foot& foot, const Foot& other) const {
    const double speed = glm::length(foot.speed);
    if (!(speed > 0.0)) return 0.0;
    const glm::dvec3 direction = foot.speed / speed;
    const glm::dvec3 beside = other.isPlanted ? other.sole[Ball] : other.lifted;
    const double stop = foot.brake > 0.0 ? 0.5 * speed * speed / foot.brake : 1e9 * _leg;
    const double mirrored = glm::dot(beside * 2.0 - foot.lifted - leg.sole[Ball], direction);
    return std::min({std::max(mirrored, 0.05 * speed), stop, 1.2 * _leg});
}

/// The height of a foot's ground at a place, without what it has to lose yet.
double LegsOnGround::heightOf(const Foot& foot, const glm::dvec3& place) {
    const double from = foot.from.heightAt(place), rise = foot.next.heightAt(place) - from;
    const bool isUp = foot.next.point.z > foot.from.heightAt(foot.next.point);
    return from + (isUp ? std::max(rise, 0.0) : std::min(rise, 0.0)) * foot.share + foot.clear;
}

/// Finds the foot's speed, and whether it stands.
void LegsOnGround::measure(const ClipLeg& leg, Foot& foot, double dt) const {
    const double before = glm::length(foot.speed);
    double height = leg.sole[Ball].z - _floor, slowest = std::numeric_limits<double>::max();
    for (const SolePoint point : {Heel, Tip, Ball}) {
        foot.speed = dt > 0.0 ? level(leg.sole[point] - foot.sole[point]) / dt : glm::dvec3(0.0);
        slowest = std::min(slowest, glm::length(foot.speed));
        height = std::min(height, leg.sole[point].z - _floor);
    }
    if (dt > 0.0) // smoothed: clips have steps in their speeds
        follow(foot.brake, (before - glm::length(foot.speed)) / dt, kBrakeTime, dt);
    const bool isStanding = kGroundContact.isPlanted(height / _leg, slowest / _leg);
    // Where a clip begins again, a foot may slide for a moment.
    foot.slides = isStanding ? 0.0 : foot.slides + dt;
    foot.isPlanted = isStanding || (foot.isPlanted && foot.slides < kSlideTime &&
                                    kGroundContact.isPlanted(height / _leg, 0.0));
    foot.stood = foot.isPlanted ? foot.stood + dt : 0.0;
}

/// A foot on the ground.
void LegsOnGround::stand(const ClipLeg& leg, Foot& foot, double dt,
                         const FindGround& ground) const {
    const glm::dvec3& ball = leg.sole[Ball];
    const double before = heightOf(foot, ball);
    glm::dvec3 shift;
    const GroundPlane found = findPlane(leg.sole, &foot.next, ground, shift);
    // It comes down on its heel, and goes on until it is flat.
    if (glm::length(foot.speed) > kRolling * _leg) follow(foot.shift, shift, kShiftTime, dt);
    const double landed = foot.next.heightAt(ball), step = found.point.z - landed;
    foot.error -= landed - before;
    if (std::abs(step) > kEdge * _leg) foot.error -= step; // else a slope, or ground that moves
    foot.from = foot.next = found;
    foot.lifted = ball;
    foot.share = foot.way = 1.0;
    foot.clear = 0.0;
}

/// A foot in the air.
void LegsOnGround::swing(const ClipLeg& leg, Foot& foot, const Foot& other, double dt,
                         const FindGround& ground) const {
    const auto& [heel, ball, tip] = leg.sole;
    const double speed = glm::length(foot.speed), left = remainingSwing(leg, foot, other);
    const double gone = glm::length(level(ball - foot.lifted));
    const glm::dvec3 direction = unitOrZero(foot.speed), along = unitOrZero(level(tip - heel));
    const glm::dvec3 there = ball + direction * left;
    foot.way = std::max(foot.way, gone / std::max(gone + left, 1e-6 * _leg));
    glm::dvec3 shift;
    const GroundPlane found = findPlane({there - along * glm::distance(ball, heel), there,
                                         there + along * glm::distance(tip, ball)},
                                        foot.way > kChosen ? &foot.next : nullptr, ground, shift);
    follow(foot.shift, shift, foot.way < kChosen ? kWaitTime : kShiftTime, dt);
    const bool isUp = found.point.z > foot.from.heightAt(found.point);
    foot.share = isUp ? glm::smoothstep(0.0, 0.7, foot.way) : glm::smoothstep(0.2, 0.85, foot.way);
    const double wasClear = foot.clear;
    foot.clear = 0.0;
    const double before = heightOf(foot, ball);
    foot.next = found;
    const double height = heightOf(foot, ball);
    // Over the edges below heel and toes and before the toes.
    const auto above = [&](const glm::dvec3& point, double clip) {
        const std::optional<GroundPlane> below = ground(point);
        return below ? below->point.z - heightOf(foot, point) - std::max(0.0, clip - _floor) : 0.0;
    };
    const glm::dvec3 toes = tip + foot.shift;
    const double overToes = above(toes, tip.z);
    const double clear = std::max({0.0, overToes, above(heel + foot.shift, heel.z),
                                   above(toes + direction * std::min(kLead * speed, left), tip.z)});
    // It waits before an edge until it is above.
    foot.error -= height - before;
    const bool isBehind = overToes > wasClear + foot.error + kMargin * _leg;
    if (isBehind && glm::length(foot.shift) < kMaxWait * _leg) foot.shift -= foot.speed * dt;
    if (std::abs(clear - wasClear) > kEdgeInAir * _leg) foot.error -= clear - wasClear;
    foot.clear = clear;
}

/// Where a foot is: on the plane below it, as its clip is on the floor.
void LegsOnGround::place(const ClipLeg& leg, std::size_t side, double dt,
                         const FindGround& ground) {
    Foot& foot = _feet[side];
    const glm::dvec3& ball = leg.sole[Ball];
    if (!_isPlaced) {
        foot = {};
        foot.from = foot.next = findPlane(leg.sole, nullptr, ground, foot.shift);
        foot.normal = foot.next.normal;
        foot.lifted = ball;
        foot.stood = kLanding;
    } else {
        const bool wasPlanted = foot.isPlanted;
        measure(leg, foot, dt);
        if (wasPlanted != foot.isPlanted) _newest = side;
        if (wasPlanted && !foot.isPlanted) foot.way = 0.0;
        if (foot.isPlanted)
            stand(leg, foot, dt, ground);
        else
            swing(leg, foot, _feet[1 - side], dt, ground);
        const bool isLanding = foot.isPlanted && foot.stood < kLanding;
        settle(foot.error, foot.errorSpeed, isLanding ? kLandTime : kFootTime, dt);
        follow(foot.normal, foot.from.normal * (1.0 - foot.share) + foot.next.normal * foot.share,
               kNormalTime, dt);
        foot.normal = unitOrZero(foot.normal);
    }
    foot.sole = leg.sole;
    const glm::dvec3 onFloor(ball.x, ball.y, _floor);
    const glm::dvec3 onGround(ball.x, ball.y, heightOf(foot, ball) + foot.error);
    foot.turns.foot = shortestRotation(glm::dvec3(0.0, 0.0, 1.0), foot.normal);
    foot.ankle = onGround + foot.turns.foot * (leg.ankle - onFloor) + foot.shift;
}

/// How far the hips may be lifted until the leg is straight.
double LegsOnGround::reach(const ClipLeg& leg, const Foot& foot) const {
    const double most = std::max(
        kStraight * (glm::distance(leg.knee, leg.hip) + glm::distance(leg.ankle, leg.knee)),
        glm::distance(leg.ankle, leg.hip));
    const double away = glm::length(level(foot.ankle - leg.hip));
    return foot.ankle.z + std::sqrt(std::max(0.0, most * most - away * away)) - leg.hip.z;
}

/// The height of the ground for the hips: between both feet upstairs, that of the lower one
/// downstairs, and without a jump as feet are lifted and set down.
double LegsOnGround::hipsHeight() const {
    const Foot& foot = _feet[_newest];
    const Foot& other = _feet[1 - _newest];
    const double stands = other.next.point.z, way = glm::smoothstep(0.0, 1.0, foot.way);
    const double before = foot.isPlanted ? 0.0 : foot.from.heightAt(foot.lifted) - stands;
    const double after = foot.next.point.z - stands;
    return stands - _floor + 0.5 * std::min(0.0, before) * (1.0 - way) +
           (after > 0.0 ? 0.5 * after : after) * way;
}

void LegsOnGround::moveHips(const std::array<ClipLeg, 2>& clip, double dt, double carriedUp) {
    double target = hipsHeight();
    for (std::size_t side = 0; side < _feet.size(); ++side)
        target = std::min(target, reach(clip[side], _feet[side]));
    if (!_isPlaced) {
        _lift = target;
        _liftSpeed = 0.0;
        return;
    }
    const double before = _lift;
    double off = _lift - target;
    settle(off, _liftSpeed, kHipsTime, dt);
    _lift = target + off;
    // Standing feet stay on the ground.
    for (std::size_t side = 0; side < _feet.size(); ++side)
        if (_feet[side].isPlanted) _lift = std::min(_lift, reach(clip[side], _feet[side]));
    const double most = kMaxHipsSpeed * _leg * dt;
    _lift = std::clamp(_lift, before - most - carriedUp, before + most - carriedUp);
}

/// Bends the knee in the clip's direction, so that the leg ends at its place.
void LegsOnGround::bend(const ClipLeg& leg, Foot& foot) const {
    const glm::dvec3 thigh = leg.knee - leg.hip, shin = leg.ankle - leg.knee;
    const glm::dvec3 toEnd = foot.ankle - leg.hip - glm::dvec3(0.0, 0.0, _lift);
    const double a = glm::length(thigh), b = glm::length(shin);
    const double longest = std::max(kStraight * (a + b), glm::distance(leg.ankle, leg.hip));
    const double distance =
        std::clamp(glm::length(toEnd), std::max(std::abs(a - b), kShortest * (a + b)),
                   std::min(longest, a + b));
    const glm::dvec3 toAnkle = unitOrZero(toEnd);
    const LimbBend at = bendOf(a, b, distance);
    // The knee's direction turns with the line from hip to ankle. Where the leg bends more than in
    // the clip, in which it may be straight, the thigh says where the knee is.
    const glm::dvec3 line = unitOrZero(leg.ankle - leg.hip);
    const auto beside = [](const glm::dvec3& v, const glm::dvec3& axis) {
        return v - axis * glm::dot(v, axis);
    };
    glm::dvec3 knees = beside(thigh, line);
    knees += unitOrZero(beside(leg.knees, line)) * std::max(0.0, at.beside - glm::length(knees));
    knees = unitOrZero(beside(shortestRotation(line, toAnkle) * knees, toAnkle));
    const glm::dvec3 newThigh = toAnkle * at.along + knees * at.beside;
    foot.turns.thigh = shortestRotation(thigh, newThigh);
    foot.turns.shin = shortestRotation(shin, toAnkle * distance - newThigh);
}

void LegsOnGround::step(const std::array<ClipLeg, 2>& clip, double dt, const glm::dmat4& carried,
                        const FindGround& ground) {
    const glm::dvec3 moved(carried[3]);
    if (!(dt >= 0.0) || dt > kPause || !(glm::length(moved) < kJump * _leg)) _isPlaced = false;
    const double carriedUp = -moved.z;
    for (Foot& foot : _feet) {
        for (GroundPlane* plane : {&foot.from, &foot.next}) {
            plane->point = transformPoint(carried, plane->point);
            plane->normal = transformDirection(carried, plane->normal);
        }
        foot.normal = transformDirection(carried, foot.normal);
        foot.shift = transformDirection(carried, foot.shift);
        foot.lifted = transformPoint(carried, foot.lifted);
        for (glm::dvec3& point : foot.sole) point = transformPoint(carried, point);
    }
    // A figure that is put on a step at once goes there in its own time.
    if (std::abs(carriedUp) > kEdge * _leg) _lift -= carriedUp;
    for (std::size_t side = 0; side < _feet.size(); ++side) place(clip[side], side, dt, ground);
    moveHips(clip, dt, std::abs(carriedUp) > kEdge * _leg ? 0.0 : carriedUp);
    for (std::size_t side = 0; side < _feet.size(); ++side) bend(clip[side], _feet[side]);
    _isPlaced = true;
}

} // namespace osgSkin
