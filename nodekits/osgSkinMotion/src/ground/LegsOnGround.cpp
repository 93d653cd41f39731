// SPDX-License-Identifier: MIT
#include "ground/LegsOnGround.h"

#include <osg/Math>

#include <algorithm>
#include <cmath>
#include <limits>

namespace osgSkin {
namespace {

// Lengths are leg lengths, times are seconds.
constexpr double kPlanted = 0.012;    ///< below this height a slow foot stands
constexpr double kSlow = 0.5;         ///< speed of a standing foot
constexpr double kBrakeTime = 0.02;   ///< over which a foot's braking is measured
constexpr double kSlideTime = 0.04;   ///< for which a standing foot may be faster
constexpr double kRolling = 0.1;      ///< speed of a standing foot that is not flat yet
constexpr double kEdge = 0.03;        ///< larger differences of the ground's height are steps
constexpr double kEdgeInAir = 0.06;   ///< the same below a foot in the air
constexpr double kFootTime = 0.04;    ///< in which a foot takes another place than it was to
constexpr double kLandTime = 0.02;    ///< the same of one that has just come down
constexpr double kLanding = 0.2;      ///< seconds
constexpr double kNormalTime = 0.05;  ///< in which it turns to a slope
constexpr double kChosen = 0.4;       ///< share of a foot's way after which it keeps its step
constexpr double kLead = 0.08;        ///< how long before an edge a foot rises
constexpr double kShiftTime = 0.05;   ///< in which a foot is moved off an edge
constexpr double kOnUpper = 0.4;      ///< less of a sole on the upper step is moved off it
constexpr double kMaxShift = 0.16;    ///< the longest way off an edge
constexpr double kWaitTime = 0.1;     ///< in which it catches up after it waited before an edge
constexpr double kMaxWait = 0.3;      ///< the longest way that a foot stays back before an edge
constexpr double kMargin = 0.025;     ///< of a sole from an edge
constexpr double kHipsTime = 0.06;    ///< in which the hips follow the feet
constexpr double kMaxHipsSpeed = 1.9; ///< leg lengths a second
constexpr double kStraight = 0.995;   ///< share of its length to which a leg may stretch
constexpr double kShortest = 0.35; ///< share of the leg's length that is left when it is bent most
constexpr double kJump = 0.6;      ///< a longer way in a step: the program placed the figure
constexpr double kPause = 0.25;    ///< a longer step begins again
constexpr double kSteepest = 0.5;  ///< cosine, of slopes that feet are turned to

osg::Vec3d level(const osg::Vec3d& v) {
    return {v.x(), v.y(), 0.0};
}

osg::Vec3d unit(osg::Vec3d v) {
    v.normalize(); // 0 stays
    return v;
}

osg::Quat shortestArc(const osg::Vec3d& from, const osg::Vec3d& to) {
    osg::Quat rotation;
    rotation.makeRotate(from, to);
    return rotation;
}

/// From 0 at `from` to 1 at `to` without a jerk.
double ramp(double from, double to, double value) {
    const double x = std::clamp((value - from) / (to - from), 0.0, 1.0);
    return x * x * (3.0 - 2.0 * x);
}

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

double GroundPlane::heightAt(const osg::Vec3d& place) const {
    const osg::Vec3d away = place - point;
    return point.z() - (away.x() * normal.x() + away.y() * normal.y()) / normal.z();
}

/// The plane on which a foot is to stand: that of its heel and its ball, or where these are on
/// different steps the upper one, if enough of the sole is on it.
/// \param chosen before, which it keeps while any part of the sole is on it; null: none
/// \param shift off the edges of higher steps
GroundPlane LegsOnGround::findPlane(const SolePoints& sole, const GroundPlane* chosen,
                                    const FindGround& ground, osg::Vec3d& shift) const {
    const double edge = kEdge * _leg;
    const auto& [heel, ball, tip] = sole;
    const std::optional<GroundPlane> atHeel = ground(heel), atBall = ground(ball),
                                     atTip = ground(tip);
    const auto over = [](const std::optional<GroundPlane>& at, const GroundPlane& plane) {
        return at->point.z() - plane.heightAt(at->point);
    };
    const auto isAbove = [&](const std::optional<GroundPlane>& at, const GroundPlane& plane) {
        return at && over(at, plane) > edge;
    };
    const auto isOn = [&](const std::optional<GroundPlane>& at, const GroundPlane& plane) {
        return at && std::abs(over(at, plane)) <= edge;
    };
    // The part of the way between two points that is on a plane, which begins there.
    const auto shareOn = [&](const GroundPlane& plane, const osg::Vec3d& from,
                             const osg::Vec3d& to) {
        double low = 0.0, high = 1.0;
        for (int i = 0; i < 3; ++i) {
            const double middle = 0.5 * (low + high);
            (isOn(ground(from + (to - from) * middle), plane) ? low : high) = middle;
        }
        return 0.5 * (low + high);
    };
    GroundPlane plane{{ball.x(), ball.y(), _floor}};
    if (atBall)
        plane = *atBall;
    else if (atHeel)
        plane = *atHeel;
    else if (atTip)
        plane = *atTip;
    const osg::Vec3d along = level(ball - heel);
    GroundPlane upper = plane;
    if (atHeel && atBall) {
        const double rise = atBall->point.z() - atHeel->point.z();
        const double byBall = rise + over(atHeel, *atBall), byHeel = rise - over(atBall, *atHeel);
        if (rise < std::min(byBall, byHeel) - edge || rise > std::max(byBall, byHeel) + edge) {
            const osg::Vec3d middle = (heel + ball) * 0.5;
            if (atHeel->heightAt(middle) > atBall->heightAt(middle)) {
                upper = *atHeel;
                if (shareOn(upper, heel, ball) >= kOnUpper) plane = upper;
            }
        } else if (along.length() > edge) { // both points are on it
            const osg::Vec3d direction = unit(along + osg::Vec3d(0.0, 0.0, rise));
            plane.normal = unit(plane.normal - direction * (plane.normal * direction));
            upper = plane;
        }
    }
    if (chosen && std::abs(plane.heightAt(ball) - chosen->heightAt(ball)) > edge &&
        (isOn(atHeel, *chosen) || isOn(atBall, *chosen) || isOn(atTip, *chosen)))
        plane = *chosen;
    const osg::Vec3d margin = unit(level(tip - heel)) * (kMargin * _leg);
    shift = {};
    if (isAbove(atHeel, plane))
        shift = along * shareOn(*atHeel, heel, ball) + margin;
    else if (isAbove(atBall, plane))
        shift = along * shareOn(plane, heel, ball) + level(heel - tip) - margin;
    else if (isAbove(atTip, plane))
        shift = level(tip - ball) * (shareOn(plane, ball, tip) - 1.0) - margin;
    if (shift.length() > kMaxShift * _leg) {
        shift = {};
        plane = upper;
    }
    if (plane.normal.z() < kSteepest) plane.normal.set(0.0, 0.0, 1.0);
    if (atTip && shift.length2() == 0.0) plane.point.z() += std::max(0.0, over(atTip, plane));
    plane.point = {ball.x(), ball.y(), plane.heightAt(ball)};
    return plane;
}

/// How far a foot in the air goes on: as far beyond the other one as it was behind, or until it
/// stops.
double LegsOnGround::wayLeft(const ClipLeg& leg, const Foot& foot, const Foot& other) const {
    const double speed = foot.speed.length();
    if (!(speed > 0.0)) return 0.0;
    const osg::Vec3d direction = foot.speed / speed;
    const osg::Vec3d beside = other.isPlanted ? other.sole[Ball] : other.lifted;
    const double stop = foot.brake > 0.0 ? 0.5 * speed * speed / foot.brake : 1e9 * _leg;
    const double mirrored = (beside * 2.0 - foot.lifted - leg.sole[Ball]) * direction;
    return std::min({std::max(mirrored, 0.05 * speed), stop, 1.2 * _leg});
}

/// The height of a foot's ground at a place, without what it has to lose yet.
double LegsOnGround::heightOf(const Foot& foot, const osg::Vec3d& place) {
    const double from = foot.from.heightAt(place), rise = foot.next.heightAt(place) - from;
    const bool isUp = foot.next.point.z() > foot.from.heightAt(foot.next.point);
    return from + (isUp ? std::max(rise, 0.0) : std::min(rise, 0.0)) * foot.share + foot.clear;
}

/// Finds the foot's speed, and whether it stands.
void LegsOnGround::measure(const ClipLeg& leg, Foot& foot, double dt) const {
    const double before = foot.speed.length();
    double height = leg.sole[Ball].z() - _floor, slowest = std::numeric_limits<double>::max();
    for (const SolePoint point : {Heel, Tip, Ball}) {
        foot.speed = dt > 0.0 ? level(leg.sole[point] - foot.sole[point]) / dt : osg::Vec3d();
        slowest = std::min(slowest, foot.speed.length());
        height = std::min(height, leg.sole[point].z() - _floor);
    }
    if (dt > 0.0) // smoothed: clips have steps in their speeds
        follow(foot.brake, (before - foot.speed.length()) / dt, kBrakeTime, dt);
    const bool isLow = height < kPlanted * _leg, isSlow = slowest < kSlow * _leg;
    // Where a clip begins again, a foot may slide for a moment.
    foot.slides = isLow && isSlow ? 0.0 : foot.slides + dt;
    foot.isPlanted = isLow && (isSlow || (foot.isPlanted && foot.slides < kSlideTime));
    foot.stood = foot.isPlanted ? foot.stood + dt : 0.0;
}

/// A foot on the ground.
void LegsOnGround::stand(const ClipLeg& leg, Foot& foot, double dt,
                         const FindGround& ground) const {
    const osg::Vec3d& ball = leg.sole[Ball];
    const double before = heightOf(foot, ball);
    osg::Vec3d shift;
    const GroundPlane found = findPlane(leg.sole, &foot.next, ground, shift);
    // It comes down on its heel, and goes on until it is flat.
    if (foot.speed.length() > kRolling * _leg) follow(foot.shift, shift, kShiftTime, dt);
    const double landed = foot.next.heightAt(ball), step = found.point.z() - landed;
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
    const double speed = foot.speed.length(), left = wayLeft(leg, foot, other);
    const double gone = level(ball - foot.lifted).length();
    const osg::Vec3d direction = unit(foot.speed), along = unit(level(tip - heel));
    const osg::Vec3d there = ball + direction * left;
    foot.way = std::max(foot.way, gone / std::max(gone + left, 1e-6 * _leg));
    osg::Vec3d shift;
    const GroundPlane found = findPlane(
        {there - along * (ball - heel).length(), there, there + along * (tip - ball).length()},
        foot.way > kChosen ? &foot.next : nullptr, ground, shift);
    follow(foot.shift, shift, foot.way < kChosen ? kWaitTime : kShiftTime, dt);
    const bool isUp = found.point.z() > foot.from.heightAt(found.point);
    foot.share = isUp ? ramp(0.0, 0.7, foot.way) : ramp(0.2, 0.85, foot.way);
    const double wasClear = foot.clear;
    foot.clear = 0.0;
    const double before = heightOf(foot, ball);
    foot.next = found;
    const double height = heightOf(foot, ball);
    // Over the edges below heel and toes and before the toes.
    const auto above = [&](const osg::Vec3d& point, double clip) {
        const std::optional<GroundPlane> below = ground(point);
        return below ? below->point.z() - heightOf(foot, point) - std::max(0.0, clip - _floor)
                     : 0.0;
    };
    const osg::Vec3d toes = tip + foot.shift;
    const double overToes = above(toes, tip.z());
    const double clear =
        std::max({0.0, overToes, above(heel + foot.shift, heel.z()),
                  above(toes + direction * std::min(kLead * speed, left), tip.z())});
    // It waits before an edge until it is above.
    foot.error -= height - before;
    const bool isBehind = overToes > wasClear + foot.error + kMargin * _leg;
    if (isBehind && foot.shift.length() < kMaxWait * _leg) foot.shift -= foot.speed * dt;
    if (std::abs(clear - wasClear) > kEdgeInAir * _leg) foot.error -= clear - wasClear;
    foot.clear = clear;
}

/// Where a foot is: on the plane below it, as its clip is on the floor.
void LegsOnGround::place(const ClipLeg& leg, std::size_t side, double dt,
                         const FindGround& ground) {
    Foot& foot = _feet[side];
    const osg::Vec3d& ball = leg.sole[Ball];
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
        foot.normal = unit(foot.normal);
    }
    foot.sole = leg.sole;
    const osg::Vec3d onFloor(ball.x(), ball.y(), _floor);
    const osg::Vec3d onGround(ball.x(), ball.y(), heightOf(foot, ball) + foot.error);
    foot.turns.foot = shortestArc(osg::Vec3d(0.0, 0.0, 1.0), foot.normal);
    foot.ankle = onGround + foot.turns.foot * (leg.ankle - onFloor) + foot.shift;
}

/// How far the hips may be lifted until the leg is straight.
double LegsOnGround::reach(const ClipLeg& leg, const Foot& foot) const {
    const double most =
        std::max(kStraight * ((leg.knee - leg.hip).length() + (leg.ankle - leg.knee).length()),
                 (leg.ankle - leg.hip).length());
    const double away = level(foot.ankle - leg.hip).length();
    return foot.ankle.z() + std::sqrt(std::max(0.0, most * most - away * away)) - leg.hip.z();
}

/// The height of the ground for the hips: between both feet upstairs, that of the lower one
/// downstairs, and without a jump as feet are lifted and set down.
double LegsOnGround::hipsHeight() const {
    const Foot& foot = _feet[_newest];
    const Foot& other = _feet[1 - _newest];
    const double stands = other.next.point.z(), way = ramp(0.0, 1.0, foot.way);
    const double before = foot.isPlanted ? 0.0 : foot.from.heightAt(foot.lifted) - stands;
    const double after = foot.next.point.z() - stands;
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
    const osg::Vec3d thigh = leg.knee - leg.hip, shin = leg.ankle - leg.knee;
    const osg::Vec3d hip = leg.hip + osg::Vec3d(0.0, 0.0, _lift);
    const double a = thigh.length(), b = shin.length();
    osg::Vec3d toAnkle = foot.ankle - hip;
    const double longest = std::max(kStraight * (a + b), (leg.ankle - leg.hip).length());
    const double distance = std::clamp(
        toAnkle.length(), std::max(std::abs(a - b), kShortest * (a + b)), std::min(longest, a + b));
    toAnkle = unit(toAnkle);
    const double along = (a * a + distance * distance - b * b) / (2.0 * distance);
    const double bent = std::sqrt(std::max(0.0, a * a - along * along));
    // The knee's direction turns with the line from hip to ankle. Where the leg bends more than in
    // the clip, in which it may be straight, the thigh says where the knee is.
    const osg::Vec3d line = unit(leg.ankle - leg.hip);
    osg::Vec3d knees = thigh - line * (thigh * line);
    knees += unit(leg.knees - line * (leg.knees * line)) * std::max(0.0, bent - knees.length());
    knees = shortestArc(line, toAnkle) * knees;
    knees = unit(knees - toAnkle * (knees * toAnkle));
    const osg::Vec3d newThigh = toAnkle * along + knees * bent;
    foot.turns.thigh = shortestArc(thigh, newThigh);
    foot.turns.shin = shortestArc(shin, toAnkle * distance - newThigh);
}

void LegsOnGround::step(const std::array<ClipLeg, 2>& clip, double dt, const osg::Matrixd& carried,
                        const FindGround& ground) {
    const osg::Vec3d moved = carried.getTrans();
    if (!(dt >= 0.0) || dt > kPause || !(moved.length() < kJump * _leg)) _isPlaced = false;
    const double carriedUp = -moved.z();
    for (Foot& foot : _feet) {
        for (GroundPlane* plane : {&foot.from, &foot.next}) {
            plane->point = plane->point * carried;
            plane->normal = osg::Matrixd::transform3x3(plane->normal, carried);
        }
        foot.normal = osg::Matrixd::transform3x3(foot.normal, carried);
        foot.shift = osg::Matrixd::transform3x3(foot.shift, carried);
        foot.lifted = foot.lifted * carried;
        for (osg::Vec3d& point : foot.sole) point = point * carried;
    }
    // A figure that is put on a step at once goes there in its own time.
    if (std::abs(carriedUp) > kEdge * _leg) _lift -= carriedUp;
    for (std::size_t side = 0; side < _feet.size(); ++side) place(clip[side], side, dt, ground);
    moveHips(clip, dt, std::abs(carriedUp) > kEdge * _leg ? 0.0 : carriedUp);
    for (std::size_t side = 0; side < _feet.size(); ++side) bend(clip[side], _feet[side]);
    _isPlaced = true;
}

} // namespace osgSkin
