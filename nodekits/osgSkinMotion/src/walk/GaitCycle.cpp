// SPDX-License-Identifier: MIT
#include "walk/GaitCycle.h"

#include "clips/JointMaps.h"

#include <osgSkin/Error>
#include <osgSkin/GlmOsg>

#include <osg/Math>
#include <osg/Quat>

#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace osgSkin {
namespace {

constexpr double kSamplesPerSecond = 30.0; ///< of the clips that are made; slerp does the rest
constexpr double kLow = 0.04;              ///< leg lengths above its lowest place, of a ball that
                                           ///< shows the speed
constexpr double kLifted = 0.08;           ///< the same, of one that does not carry any more
constexpr double kSlow = 0.35;             ///< of the figure's speed, of a planted ball
constexpr double kOnTheSpot = 0.25;        ///< of the way that feet show, which the root then goes

double angleBetween(const glm::dquat& a, const glm::dquat& b) {
    return 2.0 * std::acos(std::min(1.0, std::abs(glm::dot(a, b))));
}

/// The largest angle between two poses' joints.
double poseDistance(const SampledClip& clip, const JointSample* a, const JointSample* b) {
    double most = 0.0;
    for (std::size_t j = 0; j < clip.joints().size(); ++j)
        most = std::max(most, angleBetween(a[j].rotation, b[j].rotation));
    return most;
}

/// How far the left foot is in front of the right one, [sample].
std::vector<double> leftAhead(const Track& track, const osg::Vec3d& forward) {
    std::vector<double> ahead;
    for (std::size_t i = 0; i < track.root.size(); ++i)
        ahead.push_back((track.ball[0][i] - track.ball[1][i]) * forward);
    return ahead;
}

/// A clip's poses, of which the root's place is changed.
struct Poses {
    const SampledClip& clip;
    const WalkingBody& body;
    std::vector<JointSample> samples; ///< [sample * joints + joint]

    std::size_t joints() const { return clip.joints().size(); }
    std::size_t count() const { return samples.size() / joints(); }

    void add(double time) {
        samples.resize(samples.size() + joints());
        clip.evaluate(time, isLooped, &samples[samples.size() - joints()]);
    }

    /// Adds to the root's place in a sample. Walker space.
    void moveRoot(std::size_t sample, const osg::Vec3d& by) {
        const osg::Vec3d inRest =
            osg::Matrixd::transform3x3(by, osg::Matrixd::inverse(body.toWalker));
        const JointMap above = aboveRoot(sample);
        samples[sample * joints() + clip.rootJoint()].translation +=
            glm::conjugate(above.rotation) * toGlm(inRest) / above.scale;
    }

    /// Rotates the figure in a sample about Z and the origin of walker space.
    void turnRoot(std::size_t sample, double angle) {
        JointSample& root = samples[sample * joints() + clip.rootJoint()];
        const osg::Vec3d before = rootAt(sample);
        const glm::dquat toWalker = toGlm(body.toWalker.getRotate());
        const glm::dquat above = aboveRoot(sample).rotation;
        const glm::dquat turn =
            glm::conjugate(toWalker) * glm::angleAxis(angle, glm::dvec3(0.0, 0.0, 1.0)) * toWalker;
        root.rotation = glm::normalize(glm::conjugate(above) * turn * above * root.rotation);
        moveRoot(sample, osg::Quat(angle, osg::Vec3d(0, 0, 1)) * before - before);
    }

    osg::Vec3d rootAt(std::size_t sample) const { return at(sample, clip.rootJoint()); }

    osg::Vec3d at(std::size_t sample, std::size_t joint) const {
        std::vector<JointMap> whole;
        findWhole(clip.joints(), &samples[sample * joints()], whole);
        return toOsg(apply(whole[joint], clip.joints()[joint].centre)) * body.toWalker;
    }

    /// The direction in which the hips look in a sample, as an angle from straight on.
    double heading(std::size_t sample) const {
        std::vector<JointMap> whole;
        findWhole(clip.joints(), &samples[sample * joints()], whole);
        const glm::dquat toWalker = toGlm(body.toWalker.getRotate());
        const glm::dquat turn = toWalker * whole[body.hips].rotation * glm::conjugate(toWalker);
        const osg::Vec3d looks = toOsg(turn * toGlm(body.forward));
        return std::atan2((body.forward ^ looks).z(), flat(looks) * body.forward);
    }

    /// The turn that makes the mean heading straight on.
    void straighten() {
        osg::Vec3d mean;
        for (std::size_t i = 0; i < count(); ++i) {
            const double angle = heading(i);
            mean += osg::Vec3d(std::cos(angle), std::sin(angle), 0.0);
        }
        const double turn = -std::atan2(mean.y(), mean.x());
        for (std::size_t i = 0; i < count(); ++i) turnRoot(i, turn);
    }

    /// Puts the mean place of the root above the origin.
    void centre() {
        osg::Vec3d mean;
        for (std::size_t i = 0; i < count(); ++i) mean += flat(rootAt(i)) / double(count());
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

    bool isLooped = true;

private:
    JointMap aboveRoot(std::size_t sample) const {
        const int parent = clip.joints()[clip.rootJoint()].parent;
        if (parent < 0) return {};
        std::vector<JointMap> whole;
        findWhole(clip.joints(), &samples[sample * joints()], whole);
        return whole[static_cast<std::size_t>(parent)];
    }
};

/// The number of samples of one cycle: from one foot in front to the same again. Of a clip with
/// less, twice the time from one foot to the other. 0 where there is no step of both feet.
std::size_t findPeriod(const std::vector<double>& ahead, bool isLoop) {
    const std::size_t count = ahead.size();
    const double most = *std::max_element(ahead.begin(), ahead.end());
    const double least = *std::min_element(ahead.begin(), ahead.end());
    if (!(most > 0.0) || !(least < 0.0)) return 0;
    // The sample of each foot's largest lead, the feet in turn.
    std::vector<std::size_t> leads;
    int side = 0; // 1: the left foot is in front
    for (std::size_t i = 0; i < count; ++i) {
        const int now = ahead[i] > 0.5 * most ? 1 : ahead[i] < 0.5 * least ? -1 : side;
        if (now != side) leads.push_back(i);
        side = now;
        if (now != 0 && now * ahead[i] > now * ahead[leads.back()]) leads.back() = i;
    }
    if (isLoop) {
        // The last lead may be the first one's beginning.
        const std::size_t turns = leads.size() - leads.size() % 2;
        return turns > 0 ? count / (turns / 2) : 0;
    }
    // The clip may begin and end within one.
    if (!leads.empty() && leads.front() == 0) leads.erase(leads.begin());
    if (!leads.empty() && leads.back() + 1 == count) leads.pop_back();
    if (leads.size() < 2) return 0;
    const double step = double(leads.back() - leads.front()) / double(leads.size() - 1);
    return static_cast<std::size_t>(std::lround(2.0 * step));
}

/// How fast the lower foot moves back against the root, which is how fast the figure goes: the
/// median over the samples in which it is low.
double speedOfFeet(const Track& track, const osg::Vec3d& forward, double step, double leg,
                   bool isLoop) {
    const std::size_t count = track.root.size();
    // A twentieth of the samples may be lower: a file may begin with a pose of its own.
    std::vector<double> heights;
    for (std::size_t i = 0; i < count; ++i)
        heights.push_back(std::min(track.ball[0][i].z(), track.ball[1][i].z()));
    const auto low = heights.begin() + static_cast<std::ptrdiff_t>(count / 20);
    std::nth_element(heights.begin(), low, heights.end());
    const double floor = *low;
    std::vector<double> speeds;
    for (const auto& ball : track.ball)
        for (std::size_t i = 0; i < count; ++i) {
            const std::size_t next = (i + 1) % count;
            if ((next == 0 && !isLoop) || ball[i].z() > floor + kLow * leg) continue;
            const double back =
                ((ball[i] - track.root[i]) - (ball[next] - track.root[next])) * forward;
            if (back > 0.0) speeds.push_back(back / step);
        }
    if (speeds.empty()) return 0.0;
    const auto middle = speeds.begin() + static_cast<std::ptrdiff_t>(speeds.size() / 2);
    std::nth_element(speeds.begin(), middle, speeds.end());
    return *middle;
}

/// The longest run of samples in a cycle in which a foot is low and slow, as shares of the cycle.
Gaits::Contact findContact(const std::vector<osg::Vec3d>& ball, double leg, const osg::Vec3d& way) {
    const std::size_t count = ball.size();
    const auto lowest =
        std::min_element(ball.begin(), ball.end(),
                         [](const osg::Vec3d& a, const osg::Vec3d& b) { return a.z() < b.z(); });
    const osg::Vec3d carried = way / double(count); // from one sample to the next
    const auto isPlanted = [&](std::size_t i) {
        const osg::Vec3d moved =
            flat(ball[(i + 1) % count] - ball[(i + count - 1) % count]) * 0.5 + carried;
        return ball[i].z() < lowest->z() + kLifted * leg &&
               moved.length() < kSlow * carried.length();
    };
    std::size_t longest = 0, first = 0;
    for (std::size_t start = 0; start < count; ++start) {
        std::size_t length = 0;
        while (length < count && isPlanted((start + length) % count)) ++length;
        if (length > longest) {
            longest = length;
            first = start;
        }
    }
    if (longest < 3) { // too fast to tell: about its lowest place
        first = (static_cast<std::size_t>(lowest - ball.begin()) + count - 1) % count;
        longest = 3;
    }
    // Half a sample more at either end.
    const auto share = [count](double sample) {
        return sample / double(count) - std::floor(sample / double(count));
    };
    return {share(double(first) - 0.5), share(double(first + longest) - 0.5)};
}

/// How far a planted foot slides, walker space.
double slideOf(const std::vector<osg::Vec3d>& ball, const Gaits::Contact& contact,
               const osg::Vec3d& way) {
    const std::size_t count = ball.size();
    std::vector<osg::Vec3d> places;
    const auto first = static_cast<std::size_t>(std::ceil(contact.begin * double(count)));
    for (std::size_t k = 0; k < count; ++k) {
        const std::size_t i = (first + k) % count;
        if (!contact.contains(double(i) / double(count))) break;
        places.push_back(flat(ball[i]) + way * (double(k) / double(count)));
    }
    double most = 0.0;
    for (const osg::Vec3d& place : places) most = std::max(most, (place - places.front()).length());
    return most;
}

} // namespace

Track findTrack(const SampledClip& clip, const WalkingBody& body) {
    Track result;
    std::vector<JointMap> whole;
    for (std::size_t i = 0; i < clip.sampleCount(); ++i) {
        findWhole(clip.joints(), clip.sample(i), whole);
        const std::size_t root = clip.rootJoint();
        result.root.push_back(toOsg(apply(whole[root], clip.joints()[root].centre)) *
                              body.toWalker);
        for (std::size_t side = 0; side < body.legs.size(); ++side)
            result.ball[side].push_back(
                toOsg(apply(whole[body.legs[side].ankle], body.legs[side].ball)) * body.toWalker);
    }
    return result;
}

bool isLoop(const SampledClip& clip) {
    const std::size_t count = clip.sampleCount();
    if (count < 4) return false;
    // Against nine steps of ten: a file may begin with a pose of its own, far from the others.
    std::vector<double> steps;
    for (std::size_t i = 0; i + 1 < count; ++i)
        steps.push_back(poseDistance(clip, clip.sample(i), clip.sample(i + 1)));
    const auto most = steps.begin() + static_cast<std::ptrdiff_t>(9 * steps.size() / 10);
    std::nth_element(steps.begin(), most, steps.end());
    return poseDistance(clip, clip.sample(count - 1), clip.sample(0)) <= 1.2 * *most + 0.02;
}

double meanSpeed(const SampledClip& clip, const WalkingBody& body) {
    const Track track = findTrack(clip, body);
    const double seconds = clip.step() * double(clip.sampleCount() - 1);
    const double way = flat(track.root.back() - track.root.front()).length();
    const double feet = speedOfFeet(track, body.forward, clip.step(), body.leg, isLoop(clip));
    const double root = seconds > 0.0 ? way / seconds : 0.0;
    if (root > kOnTheSpot * feet) return root;
    return findPeriod(leftAhead(track, body.forward), isLoop(clip)) == 0 ? 0.0 : feet;
}

osg::ref_ptr<const SampledClip> onTheSpot(const SampledClip& clip, const WalkingBody& body) {
    Poses poses{clip, body, {}};
    const double seconds = clip.duration();
    const auto count =
        static_cast<std::size_t>(std::max(1.0, std::round(seconds * kSamplesPerSecond)));
    poses.isLooped = isLoop(clip);
    for (std::size_t i = 0; i < count; ++i) poses.add(seconds * double(i) / double(count));
    poses.straighten();
    poses.centre();
    return poses.make(clip.name(), seconds / double(count));
}

Gaits::Gait findCycle(const SampledClip& clip, const WalkingBody& body, double floor,
                      double& slide) {
    const bool loops = isLoop(clip);
    Poses source{clip, body, {}};
    source.isLooped = false;
    for (std::size_t i = 0; i < clip.sampleCount(); ++i) source.add(double(i) * clip.step());
    source.straighten();
    const osg::ref_ptr<const SampledClip> straight = source.make(clip.name(), clip.step());
    const Track track = findTrack(*straight, body);
    const std::vector<double> ahead = leftAhead(track, body.forward);
    const std::size_t count = straight->sampleCount(), period = findPeriod(ahead, loops);
    // Where the end is most like the beginning.
    std::size_t begin = 0, length = loops ? period : 0;
    double best = std::numeric_limits<double>::infinity();
    for (std::size_t steps = period - period / 8; !loops && steps <= period + period / 8; ++steps)
        for (std::size_t from = 0; period >= 8 && from + steps < count; ++from) {
            const double gap =
                poseDistance(*straight, straight->sample(from), straight->sample(from + steps));
            if (gap >= best) continue;
            best = gap;
            begin = from;
            length = steps;
        }
    if (length < 8)
        throw Error(
            "walker: clip \"" + clip.name() +
            "\" has no whole cycle, in which first one foot is in front and then the other");
    const double seconds = double(length) * clip.step();
    const double feet = speedOfFeet(track, body.forward, clip.step(), body.leg, loops);
    // The root's way: over the seam of a loop as its mean speed says.
    const osg::Vec3d whole = flat(track.root.back() - track.root.front());
    const osg::Vec3d perSample = whole / double(std::max<std::size_t>(1, count - 1));
    osg::Vec3d way = begin + length < count ? flat(track.root[begin + length] - track.root[begin])
                                            : perSample * double(length);
    const bool isMoving = way.length() > kOnTheSpot * feet * seconds;
    const double stride = isMoving ? way * body.forward : feet * seconds;
    if (!(stride > 0.1 * body.leg))
        throw Error("walker: clip \"" + clip.name() +
                    "\" does not go forward, expected a walk or a run");

    const auto samples =
        static_cast<std::size_t>(std::max(12.0, std::round(seconds * kSamplesPerSecond)));
    Poses cycle{*straight, body, {}};
    for (std::size_t i = 0; i < samples; ++i) {
        const double at = (double(begin) + double(length) * double(i) / double(samples));
        // A loop's way over its seam is a jump back.
        cycle.isLooped = loops;
        const bool isOverSeam = loops && at > double(count) - 1.0;
        if (isOverSeam && isMoving && at < double(count)) {
            // Between the last sample and the first: interpolate the pose, and go on.
            cycle.add(at * clip.step());
            const double share = at - (double(count) - 1.0);
            cycle.moveRoot(i, (whole + perSample) * share);
        } else {
            cycle.add(at * clip.step());
            if (isOverSeam && isMoving) cycle.moveRoot(i, whole + perSample);
        }
    }
    // The end continues the beginning: what is missing is spread over the cycle.
    std::vector<JointSample> end(cycle.joints());
    straight->evaluate(double(begin + length) * clip.step(), loops, end.data());
    for (std::size_t i = 0; i < samples; ++i) {
        const double share = double(i) / double(samples);
        for (std::size_t j = 0; j < cycle.joints(); ++j) {
            JointSample& sample = cycle.samples[i * cycle.joints() + j];
            const glm::dquat missing =
                glm::conjugate(end[j].rotation) * straight->sample(begin)[j].rotation;
            sample.rotation = glm::normalize(
                sample.rotation * glm::slerp(glm::dquat(1.0, 0.0, 0.0, 0.0), missing, share));
        }
    }
    const double rise =
        begin + length < count ? track.root[begin + length].z() - track.root[begin].z() : 0.0;
    for (std::size_t i = 0; i < samples; ++i)
        cycle.moveRoot(i, -((isMoving ? way : osg::Vec3d()) + osg::Vec3d(0.0, 0.0, rise)) *
                              (double(i) / double(samples)));
    cycle.centre();
    cycle.startLeft();

    Gaits::Gait gait;
    gait.stride = stride;
    gait.clip = cycle.make(clip.name(), seconds / double(samples));
    Track made = findTrack(*gait.clip, body);
    double lowest = std::numeric_limits<double>::infinity();
    for (const auto& ball : made.ball)
        for (const osg::Vec3d& place : ball) lowest = std::min(lowest, place.z());
    for (std::size_t i = 0; i < samples; ++i)
        cycle.moveRoot(i, osg::Vec3d(0.0, 0.0, floor - lowest));
    gait.clip = cycle.make(clip.name(), seconds / double(samples));
    made = findTrack(*gait.clip, body);
    slide = 0.0;
    for (std::size_t side = 0; side < gait.contacts.size(); ++side) {
        gait.contacts[side] = findContact(made.ball[side], body.leg, body.forward * stride);
        slide = std::max(
            slide, slideOf(made.ball[side], gait.contacts[side], body.forward * stride) / stride);
    }
    return gait;
}

} // namespace osgSkin
