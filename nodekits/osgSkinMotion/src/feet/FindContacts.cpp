// SPDX-License-Identifier: MIT
#include <osgSkinMotion/FootContacts>

#include "clips/JointMaps.h"
#include "feet/FootTrack.h"
#include "feet/Legs.h"
#include "retarget/PlantedFoot.h"

#include <osgSkinRig/BodyDirections>
#include <osgSkinRig/JointRoles>

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

namespace osgSkin {
namespace {

constexpr double kSlowest = 0.2;    ///< leg lengths a second; slower figures do not go
constexpr double kShortest = 0.04;  ///< seconds of a contact
constexpr double kOnTheSpot = 0.25; ///< share of the feet's displacement that the root must show

double medianOf(std::vector<double> values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

/// Finds legs, and which direction is up, in the rest pose.
/// \return false where they are not recognised
bool findFeet(const SampledClip& clip, TrackedFeet& feet) {
    const RestSkeleton rest = restOf(clip);
    const JointRoles roles = recogniseJoints(rest);
    for (const char* role : {"LeftUpperLeg", "LeftLowerLeg", "LeftFoot", "RightUpperLeg",
                             "RightLowerLeg", "RightFoot"})
        if (roles.joint(role) < 0) return false;
    std::vector<glm::dvec3> centres;
    for (const RestJoint& joint : rest.joints) centres.push_back(joint.centre);
    const int axis = BodyDirections(roles, centres).up(0);
    if (axis == 0) return false;
    glm::dvec3 up(0.0);
    up[std::abs(axis) - 1] = axis > 0 ? 1.0 : -1.0;
    feet.toLevel = glm::mat4_cast(shortestRotation(up, glm::dvec3(0.0, 0.0, 1.0)));
    const RestLegs legs = findLegs(rest, roles, feet.toLevel, {}, "foot contacts");
    feet.leg = legs.length;
    feet.forward = legs.forward;
    for (std::size_t side = 0; side < legs.sides.size(); ++side) {
        feet.ankles[side] = legs.sides[side].ankle;
        feet.balls[side] = transformPoint(glm::inverse(feet.toLevel), legs.sides[side].ball);
    }
    return feet.leg > 0.0;
}

/// The figure's velocity by its feet, in whatever direction it goes.
/// \param feet `forward` is set to that direction
glm::dvec3 velocityOfFeet(const FootTrack& track, double step, bool loops, TrackedFeet& feet) {
    const glm::dvec3 side(-feet.forward.y, feet.forward.x, 0.0);
    std::vector<double> ahead, aside;
    for (const auto& ball : track.ball)
        for (std::size_t i = 0; i + 1 < ball.size(); ++i) {
            if (ball[i].z > track.ball[&ball == &track.ball[0] ? 1 : 0][i].z) continue;
            const glm::dvec3 back = (ball[i] - track.root[i]) - (ball[i + 1] - track.root[i + 1]);
            ahead.push_back(glm::dot(back, feet.forward));
            aside.push_back(glm::dot(back, side));
        }
    if (ahead.empty()) return glm::dvec3(0.0);
    const glm::dvec3 direction = feet.forward * medianOf(ahead) + side * medianOf(aside);
    if (!(glm::length(direction) > 0.0)) return glm::dvec3(0.0);
    feet.forward = glm::normalize(direction);
    return feet.forward * speedOfFeet(track, feet, step, loops);
}

/// The samples in which a foot is planted.
/// \param velocity of the figure
/// \param isMoving its root shows it
std::vector<SampleRun> plantedRuns(const std::vector<glm::dvec3>& ball, double step, double floor,
                                   double leg, const glm::dvec3& velocity, bool isMoving) {
    const std::size_t count = ball.size();
    const glm::dvec3 perLoop = isMoving ? velocity * (step * double(count)) : glm::dvec3(0.0);
    const glm::dvec3 carried = isMoving ? glm::dvec3(0.0) : velocity;
    return contactRuns(count, true, [&](std::size_t i) {
        const glm::dvec3 next = i + 1 < count ? ball[i + 1] : ball[0] + perLoop;
        const glm::dvec3 before = i > 0 ? ball[i - 1] : ball[count - 1] - perLoop;
        const glm::dvec3 speed = level(next - before) / (2.0 * step) + carried;
        return kCycleContact.isPlanted((ball[i].z - floor) / leg,
                                       glm::length(speed) / glm::length(velocity));
    });
}

/// The middles of contacts of both feet in turn, from a left one on; of several of one foot, the
/// longest.
std::vector<double> alternate(std::vector<FootContacts::Contact> all, double duration) {
    const auto left =
        std::find_if(all.begin(), all.end(), [](const auto& c) { return c.foot == 0; });
    for (auto contact = all.begin(); contact != left; ++contact) {
        contact->begin += duration;
        contact->end += duration;
    }
    std::rotate(all.begin(), left, all.end());
    std::vector<FootContacts::Contact> turns;
    for (const FootContacts::Contact& contact : all)
        if (turns.empty() || turns.back().foot != contact.foot)
            turns.push_back(contact);
        else if (contact.end - contact.begin > turns.back().end - turns.back().begin)
            turns.back() = contact;
    if (turns.size() % 2 != 0) turns.pop_back();
    std::vector<double> steps;
    steps.reserve(turns.size());
    for (const FootContacts::Contact& contact : turns)
        steps.push_back(0.5 * (contact.begin + contact.end));
    const bool isMixed =
        std::adjacent_find(steps.begin(), steps.end(), std::greater_equal<>()) != steps.end();
    if (isMixed || (!steps.empty() && steps.back() >= steps.front() + duration)) steps.clear();
    return steps;
}

FootContacts findContacts(const SampledClip& clip) {
    FootContacts result;
    result.duration = clip.duration();
    TrackedFeet feet;
    const std::size_t count = clip.sampleCount();
    if (count < 4 || !findFeet(clip, feet)) return result;
    const FootTrack track = findTrack(clip, feet);
    const glm::dvec3 byRoot =
        level(track.root.back() - track.root.front()) / (clip.step() * double(count - 1));
    const glm::dvec3 byFeet = velocityOfFeet(track, clip.step(), isLoop(clip), feet);
    const bool isMoving = glm::length(byRoot) > kOnTheSpot * glm::length(byFeet);
    const glm::dvec3 velocity = isMoving ? byRoot : byFeet;
    if (!(glm::length(velocity) > kSlowest * feet.leg)) return result;
    result.velocity = transformDirection(glm::inverse(feet.toLevel), velocity);
    std::vector<double> heights;
    for (std::size_t i = 0; i < count; ++i)
        heights.push_back(std::min(track.ball[0][i].z, track.ball[1][i].z));
    const double floor = floorBelow(heights);
    for (std::size_t side = 0; side < track.ball.size(); ++side)
        for (const SampleRun& run :
             plantedRuns(track.ball[side], clip.step(), floor, feet.leg, velocity, isMoving)) {
            // Half a sample more at either end.
            const double begin = (double(run.first) - 0.5) * clip.step();
            const double seconds = double(run.count) * clip.step();
            if (seconds < kShortest || run.count == count) continue;
            result.all.push_back({side, std::max(0.0, begin), begin + seconds});
        }
    std::sort(result.all.begin(), result.all.end(),
              [](const auto& a, const auto& b) { return a.begin < b.begin; });
    result.steps = alternate(result.all, result.duration);
    return result;
}

} // namespace

/// The time of a number of steps since the first.
double FootContacts::stepTime(double step) const {
    const auto count = double(steps.size()), whole = std::floor(step),
               loops = std::floor(whole / count);
    const auto i = static_cast<std::size_t>(whole - loops * count);
    const double next = i + 1 < steps.size() ? steps[i + 1] : steps[0] + duration;
    return loops * duration + steps[i] + (next - steps[i]) * (step - whole);
}

double FootContacts::phaseAt(double time) const {
    const double loops = std::floor((time - steps[0]) / duration);
    const double within = std::max(time - loops * duration, steps[0]);
    const auto next = std::upper_bound(steps.begin(), steps.end(), within);
    const auto i = static_cast<std::size_t>(next - steps.begin()) - 1;
    const double end = next == steps.end() ? steps[0] + duration : *next;
    return 0.5 *
           (loops * double(steps.size()) + double(i) + (within - steps[i]) / (end - steps[i]));
}

double FootContacts::timeAt(double phase) const {
    return stepTime(2.0 * phase);
}

double FootContacts::rateAt(double time) const {
    const double step = std::floor(2.0 * phaseAt(time));
    return 0.5 / (stepTime(step + 1.0) - stepTime(step));
}

const FootContacts& SampledClip::footContacts() const {
    std::call_once(_contactsFound, [this] {
        _contacts = std::make_unique<const FootContacts>(findContacts(*this));
    });
    return *_contacts;
}

} // namespace osgSkin
