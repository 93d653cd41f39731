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
constexpr double kStraight = 0.995;   ///< of a leg's length, which it may have
constexpr double kMostBent = 0.35;    ///< the same of the shortest leg
constexpr double kJump = 0.6;         ///< a longer way in a step: the program placed the figure
constexpr double kPause = 0.25;       ///< a longer step begins again
constexpr double kSteepest = 0.5;     ///< cosine, of slopes that feet are turned to

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

void follow(osg::Vec3d& value, const osg::Vec3d& target, double time, double dt) {
    value += (target - value) * (1.0 - std::exp(-dt / time));
}

} // namespace

double GroundPlane::heightAt(const osg::Vec3d& place) const {
    const osg::Vec3d away = place - point;
    return point.z() - (away.x() * normal.x() + away.y() * normal.y()) / normal.z();
}

LegsOnGround::Sole LegsOnGround::findSole(const osg::Vec3d& heel, const osg::Vec3d& ball,
                                          const osg::Vec3d& tip, const FindGround& ground) {
    Sole result;
    result.heel = heel;
    result.ball = ball;
    result.tip = tip;
    result.hasHeel = ground(heel, result.atHeel);
    result.hasBall = ground(ball, result.atBall);
    result.hasTip = ground(tip, result.atTip);
    return result;
}

/// The plane on which heel and ball stand.
/// \param isOnEdge whether they are on different steps; it is then the upper one
GroundPlane LegsOnGround::findPlane(const Sole& sole, bool& isOnEdge) const {
    const osg::Vec3d& heel = sole.heel;
    const osg::Vec3d& ball = sole.ball;
    GroundPlane result{{ball.x(), ball.y(), _floor}};
    if (sole.hasBall)
        result = sole.atBall;
    else if (sole.hasHeel)
        result = sole.atHeel;
    else if (sole.hasTip)
        result = sole.atTip;
    isOnEdge = false;
    if (sole.hasBall && sole.hasHeel) {
        const double edge = kEdge * _leg, rise = sole.atBall.point.z() - sole.atHeel.point.z();
        const double byBall = sole.atBall.point.z() - sole.atBall.heightAt(heel);
        const double byHeel = sole.atHeel.heightAt(ball) - sole.atHeel.point.z();
        const osg::Vec3d along = level(ball - heel), middle = (heel + ball) * 0.5;
        isOnEdge = rise < std::min(byBall, byHeel) - edge || rise > std::max(byBall, byHeel) + edge;
        if (isOnEdge && sole.atHeel.heightAt(middle) > sole.atBall.heightAt(middle)) {
            result = sole.atHeel;
        } else if (!isOnEdge && along.length() > edge) { // both points are on it
            const osg::Vec3d direction = unit(along + osg::Vec3d(0.0, 0.0, rise));
            result.normal = unit(result.normal - direction * (result.normal * direction));
        }
    }
    if (result.normal.z() < kSteepest) result.normal.set(0.0, 0.0, 1.0);
    result.point = {ball.x(), ball.y(), result.heightAt(ball)};
    return result;
}

/// The part of the way between two points that is on a plane, which begins there.
double LegsOnGround::shareOn(const GroundPlane& plane, const osg::Vec3d& from, const osg::Vec3d& to,
                             const FindGround& ground) const {
    double low = 0.0, high = 1.0;
    for (int i = 0; i < 3; ++i) {
        const double middle = 0.5 * (low + high);
        const osg::Vec3d place = from + (to - from) * middle;
        GroundPlane found;
        const bool isOn = ground(place, found) &&
                          std::abs(found.point.z() - plane.heightAt(place)) <= kEdge * _leg;
        (isOn ? low : high) = middle;
    }
    return 0.5 * (low + high);
}

/// The step on which a foot is to stand.
/// \param chosen before, which it keeps while any part of the sole is on it; null: none
/// \param shift off the edges of higher steps
GroundPlane LegsOnGround::chooseStep(const Sole& sole, const GroundPlane* chosen,
                                     const FindGround& ground, osg::Vec3d& shift) const {
    const double edge = kEdge * _leg;
    bool isOnEdge = false;
    const GroundPlane upper = findPlane(sole, isOnEdge);
    const osg::Vec3d direction = unit(level(sole.tip - sole.heel));
    const osg::Vec3d heelToBall = level(sole.ball - sole.heel);
    const auto isAbove = [&](bool has, const GroundPlane& at, const GroundPlane& plane) {
        return has && at.point.z() > plane.heightAt(at.point) + edge;
    };
    GroundPlane plane = upper;
    if (isOnEdge && sole.atHeel.heightAt(sole.ball) > sole.atBall.heightAt(sole.ball) &&
        shareOn(sole.atHeel, sole.heel, sole.ball, ground) < kOnUpper)
        plane = sole.atBall;
    if (chosen && supports(sole, *chosen) &&
        std::abs(plane.heightAt(sole.ball) - chosen->heightAt(sole.ball)) > edge)
        plane = *chosen;
    shift = {};
    if (isAbove(sole.hasHeel, sole.atHeel, plane)) {
        shift = heelToBall * shareOn(sole.atHeel, sole.heel, sole.ball, ground) +
                direction * (kMargin * _leg);
    } else if (isAbove(sole.hasBall, sole.atBall, plane)) {
        shift = heelToBall * shareOn(plane, sole.heel, sole.ball, ground) +
                level(sole.heel - sole.tip) - direction * (kMargin * _leg);
    } else if (isAbove(sole.hasTip, sole.atTip, plane)) {
        shift = level(sole.tip - sole.ball) * (shareOn(plane, sole.ball, sole.tip, ground) - 1.0) -
                direction * (kMargin * _leg);
    }
    if (shift.length() > kMaxShift * _leg) {
        shift = {};
        plane = upper;
    }
    if (sole.hasTip && shift.length2() == 0.0)
        plane.point.z() += std::max(0.0, sole.atTip.point.z() - plane.heightAt(sole.tip));
    plane.point = {sole.ball.x(), sole.ball.y(), plane.heightAt(sole.ball)};
    return plane;
}

/// Whether any part of a sole is on a plane.
bool LegsOnGround::supports(const Sole& sole, const GroundPlane& plane) const {
    const auto isOn = [&](bool has, const GroundPlane& at) {
        return has && std::abs(at.point.z() - plane.heightAt(at.point)) <= kEdge * _leg;
    };
    return isOn(sole.hasHeel, sole.atHeel) || isOn(sole.hasBall, sole.atBall) ||
           isOn(sole.hasTip, sole.atTip);
}

/// How far a foot in the air goes on: as far beyond the other one as it was behind, or until it
/// stops.
double LegsOnGround::wayLeft(const ClipLeg& leg, const Foot& foot, const Foot& other) const {
    const double speed = foot.speed.length();
    if (!(speed > 0.0)) return 0.0;
    const osg::Vec3d direction = foot.speed / speed;
    const osg::Vec3d beside = other.isPlanted ? other.ball : other.lifted;
    const double stop = foot.brake > 0.0 ? 0.5 * speed * speed / foot.brake : 1e9 * _leg;
    const double mirrored = (beside * 2.0 - foot.lifted - leg.ball) * direction;
    return std::min({std::max(mirrored, 0.05 * speed), stop, 1.2 * _leg});
}

/// A foot on the ground.
void LegsOnGround::stand(const ClipLeg& leg, Foot& foot, double dt, const FindGround& ground) {
    const double before = heightOf(foot, leg.ball);
    osg::Vec3d shift;
    const GroundPlane found =
        chooseStep(findSole(leg.heel, leg.ball, leg.tip, ground), &foot.next, ground, shift);
    // It comes down on its heel, and goes on until it is flat.
    if (foot.speed.length() > kRolling * _leg) follow(foot.shift, shift, kShiftTime, dt);
    const double step = found.point.z() - foot.next.heightAt(leg.ball);
    foot.share = foot.way = 1.0;
    foot.clear = 0.0;
    foot.from = foot.next;
    foot.lifted = leg.ball;
    foot.error -= heightOf(foot, leg.ball) - before;
    if (std::abs(step) > kEdge * _leg) foot.error -= step; // else a slope, or ground that moves
    foot.from = foot.next = found;
}

/// A foot in the air.
void LegsOnGround::swing(const ClipLeg& leg, Foot& foot, const Foot& other, double dt,
                         const FindGround& ground) {
    const double speed = foot.speed.length(), left = wayLeft(leg, foot, other);
    const double gone = level(leg.ball - foot.lifted).length();
    const osg::Vec3d direction = speed > 0.0 ? foot.speed / speed : osg::Vec3d();
    const osg::Vec3d there = leg.ball + direction * left;
    const osg::Vec3d along = unit(level(leg.tip - leg.heel));
    const Sole sole = findSole(there - along * (leg.ball - leg.heel).length(), there,
                               there + along * (leg.tip - leg.ball).length(), ground);
    foot.way = std::max(foot.way, gone / std::max(gone + left, 1e-6 * _leg));
    osg::Vec3d shift;
    const GroundPlane found =
        chooseStep(sole, foot.way > kChosen ? &foot.next : nullptr, ground, shift);
    follow(foot.shift, shift, foot.way < kChosen ? kWaitTime : kShiftTime, dt);
    const bool isUp = found.point.z() > foot.from.heightAt(found.point);
    foot.share = isUp ? ramp(0.0, 0.7, foot.way) : ramp(0.2, 0.85, foot.way);
    const double before = heightOf(foot, leg.ball);
    foot.next = found;
    foot.clear = 0.0;
    // Over the edges before the toes and below the heel.
    const double base = heightOf(foot, leg.ball);
    const auto above = [&](const osg::Vec3d& point, double clip) {
        GroundPlane below;
        return ground(point, below)
                   ? below.point.z() - heightOf(foot, point) - std::max(0.0, clip - _floor)
                   : 0.0;
    };
    const osg::Vec3d tip = leg.tip + foot.shift;
    const double clear =
        std::max({0.0, above(leg.heel + foot.shift, leg.heel.z()),
                  above(tip + direction * std::min(kLead * speed, left), tip.z())});
    // It waits before an edge until it is above.
    const bool isBehind = above(tip, tip.z()) > before - base + foot.error + kMargin * _leg;
    if (isBehind && foot.shift.length() < kMaxWait * _leg) foot.shift -= foot.speed * dt;
    foot.clear = clear;
    foot.error -= base + clear - before;
}

/// The ground of a foot, without what it has to lose yet.
double LegsOnGround::heightOf(const Foot& foot, const osg::Vec3d& ball) {
    const double from = foot.from.heightAt(ball), rise = foot.next.heightAt(ball) - from;
    const bool isUp = foot.next.point.z() > foot.from.heightAt(foot.next.point);
    return from + (isUp ? std::max(rise, 0.0) : std::min(rise, 0.0)) * foot.share + foot.clear;
}

/// Where a foot is: on the plane below it, as its clip is on the floor.
void LegsOnGround::place(const ClipLeg& leg, std::size_t side, double dt,
                         const FindGround& ground) {
    Foot& foot = _feet[side];
    const osg::Vec3d& ball = leg.ball;
    if (!_isPlaced) {
        foot = {};
        foot.from = foot.next =
            chooseStep(findSole(leg.heel, ball, leg.tip, ground), nullptr, ground, foot.shift);
        foot.normal = foot.next.normal;
        foot.height = foot.next.point.z();
        foot.lifted = ball;
        foot.stood = kLanding;
    } else {
        const auto speedOf = [&](const osg::Vec3d& now, const osg::Vec3d& before) {
            return dt > 0.0 ? level(now - before) / dt : osg::Vec3d();
        };
        const double before = foot.speed.length();
        const double slowest =
            std::min({speedOf(leg.heel, foot.heel).length(), speedOf(ball, foot.ball).length(),
                      speedOf(leg.tip, foot.tip).length()});
        foot.speed = speedOf(ball, foot.ball);
        if (dt > 0.0) // smoothed: clips have steps in their speeds
            foot.brake += ((before - foot.speed.length()) / dt - foot.brake) *
                          (1.0 - std::exp(-dt / kBrakeTime));
        const double sole = std::min({leg.heel.z(), ball.z(), leg.tip.z()}) - _floor;
        const bool wasPlanted = foot.isPlanted;
        foot.isPlanted = sole < kPlanted * _leg && slowest < kSlow * _leg;
        foot.stood = foot.isPlanted ? foot.stood + dt : 0.0;
        // Where a clip begins again, a foot may slide for a moment.
        foot.slides = foot.isPlanted ? 0.0 : foot.slides + dt;
        if (wasPlanted && sole < kPlanted * _leg && foot.slides < kSlideTime) foot.isPlanted = true;
        if (wasPlanted != foot.isPlanted) _newest = side;
        if (wasPlanted && !foot.isPlanted) {
            foot.lifted = foot.ball;
            foot.way = 0.0;
        }
        if (foot.isPlanted)
            stand(leg, foot, dt, ground);
        else
            swing(leg, foot, _feet[1 - side], dt, ground);
        settle(foot.error, foot.errorSpeed,
               foot.stood > 0.0 && foot.stood < kLanding ? kLandTime : kFootTime, dt);
        const osg::Vec3d normal =
            foot.from.normal * (1.0 - foot.share) + foot.next.normal * foot.share;
        follow(foot.normal, normal, kNormalTime, dt);
        foot.normal = unit(foot.normal);
        foot.height = heightOf(foot, ball) + foot.error;
    }
    foot.heel = leg.heel;
    foot.ball = ball;
    foot.tip = leg.tip;
    const osg::Vec3d onFloor(ball.x(), ball.y(), _floor), onGround(ball.x(), ball.y(), foot.height);
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
        toAnkle.length(), std::max(std::abs(a - b), kMostBent * (a + b)), std::min(longest, a + b));
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
        for (osg::Vec3d* point : {&foot.lifted, &foot.heel, &foot.ball, &foot.tip})
            *point = *point * carried;
        foot.height -= carriedUp;
    }
    // A figure that is put on a step at once goes there in its own time.
    if (std::abs(carriedUp) > kEdge * _leg) _lift -= carriedUp;
    for (std::size_t side = 0; side < _feet.size(); ++side) place(clip[side], side, dt, ground);
    moveHips(clip, dt, std::abs(carriedUp) > kEdge * _leg ? 0.0 : carriedUp);
    for (std::size_t side = 0; side < _feet.size(); ++side) bend(clip[side], _feet[side]);
    _isPlaced = true;
}

} // namespace osgSkin
