// SPDX-License-Identifier: MIT
#include "walk/GaitCycle.h"

#include "clips/JointMaps.h"
#include "feet/Legs.h"
#include "retarget/PlantedFoot.h"

#include <osgSkin/Error>

#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace osgSkin {
namespace {

constexpr double kSamplesPerSecond = 30.0; ///< of the clips that are made; slerp does the rest
constexpr double kOnTheSpot = 0.25; ///< share of the feet's displacement that the root must show

/// The component along Z of a cross product.
double crossZ(const glm::dvec3& a, const glm::dvec3& b) {
    return a.x * b.y - a.y * b.x;
}

/// A clip's poses, of which the root's place is changed.
struct Poses {
    const SampledClip& clip;
    const WalkingBody& body;
    std::vector<JointSample> samples; ///< [sample * joints + joint]
    bool isLooped = true;

    std::size_t joints() const { return clip.joints().size(); }
    std::size_t count() const { return samples.size() / joints(); }
    JointSample& root(std::size_t sample) { return samples[sample * joints() + clip.rootJoint()]; }

    void add(double time) {
        samples.resize(samples.size() + joints());
        clip.evaluate(time, isLooped, &samples[samples.size() - joints()]);
    }

    /// Adds to the root's place in a sample. Walker space.
    void moveRoot(std::size_t sample, const glm::dvec3& by) {
        const glm::dvec3 inRest = transformDirection(glm::inverse(body.toLevel), by);
        const JointMap above = aboveRoot(sample);
        root(sample).translation += glm::conjugate(above.rotation) * inRest / above.scale;
    }

    /// Rotates the figure in a sample about Z and the origin of walker space.
    void turnRoot(std::size_t sample, double angle) {
        JointSample& turned = root(sample);
        const glm::dvec3 before = rootAt(sample);
        const glm::dquat toLevel = rotationOf(body.toLevel), above = aboveRoot(sample).rotation;
        const glm::dquat aboutZ = glm::angleAxis(angle, glm::dvec3(0.0, 0.0, 1.0));
        const glm::dquat turn = glm::conjugate(toLevel) * aboutZ * toLevel;
        turned.rotation = glm::normalize(glm::conjugate(above) * turn * above * turned.rotation);
        moveRoot(sample, aboutZ * before - before);
    }

    glm::dvec3 rootAt(std::size_t sample) const {
        const std::vector<JointMap> whole = wholeAt(sample);
        const std::size_t root = clip.rootJoint();
        return transformPoint(body.toLevel, apply(whole[root], clip.joints()[root].centre));
    }

    /// The direction in which the hips look in a sample, as an angle from straight on.
    double heading(std::size_t sample) const {
        const glm::dquat toLevel = rotationOf(body.toLevel);
        const glm::dquat turn =
            toLevel * wholeAt(sample)[body.hips].rotation * glm::conjugate(toLevel);
        const glm::dvec3 looks = turn * body.forward;
        return std::atan2(crossZ(body.forward, looks), glm::dot(level(looks), body.forward));
    }

    /// The turn that makes the mean heading straight on.
    void straighten() {
        glm::dvec2 mean(0.0);
        for (std::size_t i = 0; i < count(); ++i) {
            const double angle = heading(i);
            mean += glm::dvec2(std::cos(angle), std::sin(angle));
        }
        const double turn = -std::atan2(mean.y, mean.x);
        for (std::size_t i = 0; i < count(); ++i) turnRoot(i, turn);
    }

    /// Puts the mean place of the root above the origin.
    void centre() {
        glm::dvec3 mean(0.0);
        for (std::size_t i = 0; i < count(); ++i) mean += level(rootAt(i)) / double(count());
        for (std::size_t i = 0; i < count(); ++i) moveRoot(i, -mean);
    }

    /// Begins the cycle where the left foot is in front the most.
    void startLeft() {
        const std::vector<double> ahead = leftAhead(findTrack(*make("", 1.0), body), body.forward);
        const auto first = std::max_element(ahead.begin(), ahead.end()) - ahead.begin();
        std::rotate(samples.begin(),
                    samples.begin() + first * static_cast<std::ptrdiff_t>(joints()), samples.end());
    }

    osg::ref_ptr<const SampledClip> make(const std::string& name, double step) const {
        return SampledClip::create(name, clip.joints(), samples, step);
    }

private:
    std::vector<JointMap> wholeAt(std::size_t sample) const {
        std::vector<JointMap> whole;
        localToModel(clip.joints(), &samples[sample * joints()], whole);
        return whole;
    }

    JointMap aboveRoot(std::size_t sample) const {
        const int parent = clip.joints()[clip.rootJoint()].parent;
        return parent < 0 ? JointMap() : wholeAt(sample)[static_cast<std::size_t>(parent)];
    }
};

/// The longest contact of a foot in a cycle, as shares of the cycle.
/// \param way of one cycle
Gaits::Contact findContact(const std::vector<glm::dvec3>& ball, double leg, const glm::dvec3& way) {
    const std::size_t count = ball.size();
    const auto lowest =
        std::min_element(ball.begin(), ball.end(),
                         [](const glm::dvec3& a, const glm::dvec3& b) { return a.z < b.z; });
    const glm::dvec3 carried = way / double(count); // from one sample to the next
    const auto isPlanted = [&](std::size_t i) {
        const glm::dvec3 moved =
            level(ball[(i + 1) % count] - ball[(i + count - 1) % count]) * 0.5 + carried;
        return kCycleContact.isPlanted((ball[i].z - lowest->z) / leg,
                                       glm::length(moved) / glm::length(carried));
    };
    SampleRun longest;
    for (const SampleRun& run : contactRuns(count, true, isPlanted))
        if (run.count > longest.count) longest = run;
    if (longest.count < 3) // too fast to tell: about its lowest place
        longest = {(static_cast<std::size_t>(lowest - ball.begin()) + count - 1) % count, 3};
    // Half a sample more at either end.
    const auto share = [count](double sample) {
        return sample / double(count) - std::floor(sample / double(count));
    };
    return {share(double(longest.first) - 0.5), share(double(longest.first + longest.count) - 0.5)};
}

/// How far a planted foot slides, walker space.
double slideIn(const std::vector<glm::dvec3>& ball, const Gaits::Contact& contact,
               const glm::dvec3& way) {
    const std::size_t count = ball.size();
    const auto first = static_cast<std::size_t>(std::ceil(contact.begin * double(count)));
    std::size_t planted = 0;
    while (planted < count && contact.contains(double((first + planted) % count) / double(count)))
        ++planted;
    return slideOf(planted, [&](std::size_t k) {
        return level(ball[(first + k) % count]) + way * (double(k) / double(count));
    });
}

/// One cycle within a clip's samples, and how the root moves in it.
struct Cycle {
    std::size_t begin = 0, length = 0;
    double stride = 0.0;     ///< the way forward
    bool isMoving = false;   ///< the root shows that way
    glm::dvec3 way{0.0};     ///< of the root along the ground
    glm::dvec3 perLoop{0.0}; ///< of the root from the first sample over the seam to the first again
    double rise = 0.0;       ///< of the root, which a cycle does not have
};

/// Finds the cycle whose end is most like its beginning; a loop begins where it does.
/// \throw osgSkin::Error where there is none
void findSeam(const SampledClip& clip, std::size_t period, bool loops, Cycle& cycle) {
    cycle.length = loops ? period : 0;
    double best = std::numeric_limits<double>::infinity();
    for (std::size_t steps = period - period / 8; !loops && steps <= period + period / 8; ++steps)
        for (std::size_t from = 0; period >= 8 && from + steps < clip.sampleCount(); ++from) {
            const double gap = poseDistance(clip, clip.sample(from), clip.sample(from + steps));
            if (gap >= best) continue;
            best = gap;
            cycle.begin = from;
            cycle.length = steps;
        }
    if (cycle.length < 8)
        throw Error(
            "walker: clip \"" + clip.name() +
            "\" has no whole cycle, in which first one foot is in front and then the other");
}

/// Measures the stride: over the seam of a loop as the root's mean speed says.
/// \throw osgSkin::Error where it does not go forward
void measureStride(const SampledClip& clip, const FootTrack& track, const WalkingBody& body,
                   bool loops, Cycle& cycle) {
    const std::size_t count = clip.sampleCount(), end = cycle.begin + cycle.length;
    const glm::dvec3 whole = level(track.root.back() - track.root.front());
    const glm::dvec3 perSample = whole / double(std::max<std::size_t>(1, count - 1));
    const double feet =
        speedOfFeet(track, body, clip.step(), loops) * double(cycle.length) * clip.step();
    cycle.perLoop = whole + perSample;
    cycle.way = perSample * double(cycle.length);
    if (end < count) {
        cycle.way = level(track.root[end] - track.root[cycle.begin]);
        cycle.rise = track.root[end].z - track.root[cycle.begin].z;
    }
    cycle.isMoving = glm::length(cycle.way) > kOnTheSpot * feet;
    cycle.stride = cycle.isMoving ? glm::dot(cycle.way, body.forward) : feet;
    if (!(cycle.stride > 0.1 * body.leg))
        throw Error("walker: clip \"" + clip.name() +
                    "\" does not go forward, expected a walk or a run");
}

/// Samples the cycle evenly; the root goes on over the seam of a loop, which is a jump back.
void sampleCycle(const Cycle& cycle, bool loops, std::size_t samples, Poses& poses) {
    const double step = poses.clip.step(), last = double(poses.clip.sampleCount() - 1);
    poses.isLooped = loops;
    for (std::size_t i = 0; i < samples; ++i) {
        const double at = double(cycle.begin) + double(cycle.length) * double(i) / double(samples);
        poses.add(at * step);
        // Between the last sample and the first the pose was interpolated back.
        if (loops && cycle.isMoving && at > last)
            poses.moveRoot(i, cycle.perLoop * std::min(at - last, 1.0));
    }
}

/// Makes the end continue the beginning: what is missing is spread over the cycle.
void closeCycle(const Cycle& cycle, bool loops, Poses& poses) {
    const SampledClip& clip = poses.clip;
    std::vector<JointSample> end(poses.joints());
    clip.evaluate(double(cycle.begin + cycle.length) * clip.step(), loops, end.data());
    const glm::dvec3 gone =
        (cycle.isMoving ? cycle.way : glm::dvec3(0.0)) + glm::dvec3(0.0, 0.0, cycle.rise);
    const std::size_t count = poses.count();
    for (std::size_t i = 0; i < count; ++i) {
        const double share = double(i) / double(count);
        for (std::size_t j = 0; j < poses.joints(); ++j) {
            JointSample& sample = poses.samples[i * poses.joints() + j];
            const glm::dquat missing =
                glm::conjugate(end[j].rotation) * clip.sample(cycle.begin)[j].rotation;
            sample.rotation = glm::normalize(
                sample.rotation * glm::slerp(glm::dquat(1.0, 0.0, 0.0, 0.0), missing, share));
        }
        poses.moveRoot(i, -gone * share);
    }
    poses.centre();
    poses.startLeft();
}

} // namespace

double meanSpeed(const SampledClip& clip, const WalkingBody& body) {
    const FootTrack track = findTrack(clip, body);
    const double seconds = clip.step() * double(clip.sampleCount() - 1);
    const double way = glm::length(level(track.root.back() - track.root.front()));
    const double feet = speedOfFeet(track, body, clip.step(), isLoop(clip));
    const double root = seconds > 0.0 ? way / seconds : 0.0;
    if (root > kOnTheSpot * feet) return root;
    return findPeriod(leftAhead(track, body.forward), isLoop(clip)) == 0 ? 0.0 : feet;
}

osg::ref_ptr<const SampledClip> onTheSpot(const SampledClip& clip, const WalkingBody& body) {
    Poses poses{clip, body, {}, isLoop(clip)};
    const double seconds = clip.duration();
    const auto count =
        static_cast<std::size_t>(std::max(1.0, std::round(seconds * kSamplesPerSecond)));
    for (std::size_t i = 0; i < count; ++i) poses.add(seconds * double(i) / double(count));
    poses.straighten();
    poses.centre();
    return poses.make(clip.name(), seconds / double(count));
}

Gaits::Gait findCycle(const SampledClip& clip, const WalkingBody& body, double floor,
                      double& slide) {
    const bool loops = isLoop(clip);
    Poses source{clip, body, {}, false};
    for (std::size_t i = 0; i < clip.sampleCount(); ++i) source.add(double(i) * clip.step());
    source.straighten();
    const osg::ref_ptr<const SampledClip> straight = source.make(clip.name(), clip.step());
    const FootTrack track = findTrack(*straight, body);
    Cycle cycle;
    findSeam(*straight, findPeriod(leftAhead(track, body.forward), loops), loops, cycle);
    measureStride(*straight, track, body, loops, cycle);
    const double seconds = double(cycle.length) * clip.step();
    const auto samples =
        static_cast<std::size_t>(std::max(12.0, std::round(seconds * kSamplesPerSecond)));
    Poses poses{*straight, body, {}};
    sampleCycle(cycle, loops, samples, poses);
    closeCycle(cycle, loops, poses);

    const double step = seconds / double(samples);
    double lowest = std::numeric_limits<double>::infinity();
    for (const auto& ball : findTrack(*poses.make(clip.name(), step), body).ball)
        for (const glm::dvec3& place : ball) lowest = std::min(lowest, place.z);
    for (std::size_t i = 0; i < samples; ++i)
        poses.moveRoot(i, glm::dvec3(0.0, 0.0, floor - lowest));
    Gaits::Gait gait;
    gait.stride = cycle.stride;
    gait.clip = poses.make(clip.name(), step);
    const FootTrack made = findTrack(*gait.clip, body);
    const glm::dvec3 way = body.forward * gait.stride;
    slide = 0.0;
    for (std::size_t side = 0; side < gait.contacts.size(); ++side) {
        gait.contacts[side] = findContact(made.ball[side], body.leg, way);
        slide = std::max(slide, slideIn(made.ball[side], gait.contacts[side], way) / gait.stride);
    }
    return gait;
}

} // namespace osgSkin
