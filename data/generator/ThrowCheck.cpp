// SPDX-License-Identifier: MIT
#include "ThrowCheck.h"

#include "ThrowClearance.h"
#include "ThrowMeasure.h"
#include "ThrowMotion.h"
#include "ThrowTiming.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ostream>
#include <string>

namespace mannequin {
namespace {

class Findings {
public:
    explicit Findings(std::ostream& out) : out_(out) {}

    void within(const std::string& what, double value, double least, double most) {
        const bool ok = value >= least && value <= most;
        char text[200];
        std::snprintf(text, sizeof text, "%-4s %-56s %9.3f in [%g, %g]\n", ok ? "ok" : "FAIL",
                      what.c_str(), value, least, most);
        out_ << text;
        good_ = good_ && ok;
    }

    bool good() const { return good_; }

private:
    std::ostream& out_;
    bool good_ = true;
};

struct Range {
    double least = 1e9;
    double most = -1e9;

    void add(double value) {
        least = std::min(least, value);
        most = std::max(most, value);
    }
};

Range rangeOf(const std::vector<FrameMeasure>& frames, double FrameMeasure::*measure) {
    Range range;
    for (const FrameMeasure& frame : frames) range.add(frame.*measure);
    return range;
}

/// Maximum displacement of a joint in millimetres while its foot is planted.
double slip(const std::vector<FrameMeasure>& frames, glm::dvec3 FrameMeasure::*joint, int first,
            int last) {
    double most = 0;
    for (int i = first; i <= last; ++i)
        most = std::max(most, glm::distance(frames[static_cast<std::size_t>(i)].*joint,
                                            frames[static_cast<std::size_t>(first)].*joint));
    return 1000 * most;
}

/// Angle between two rotations in degrees.
double apart(const glm::dquat& a, const glm::dquat& b) {
    return degrees(2 * std::acos(std::min(1.0, std::abs(glm::dot(a, b)))));
}

/// Maximum angular speed and acceleration of the given joints over frames [first, last].
struct Smoothness {
    double speed = 0;        ///< degrees per second
    double acceleration = 0; ///< degrees per second squared
};

Smoothness smoothness(const std::vector<Pose>& poses, int first, int last,
                      const std::vector<std::size_t>& joints) {
    const auto rate = [&](int i, std::size_t joint) {
        const auto at = static_cast<std::size_t>(i);
        const glm::dquat step = glm::inverse(poses[at].local[joint]) * poses[at + 1].local[joint];
        const glm::dvec3 axis(step.x, step.y, step.z);
        return 2 * degrees(kFrameRate) * (step.w < 0 ? -axis : axis);
    };
    Smoothness s;
    for (int i = first; i + 1 < last; ++i) {
        for (const std::size_t joint : joints) {
            const glm::dvec3 now = rate(i, joint);
            s.speed = std::max(s.speed, glm::length(now));
            s.acceleration =
                std::max(s.acceleration, kFrameRate * glm::distance(rate(i + 1, joint), now));
        }
    }
    return s;
}

void checkSmoothness(Findings& find, const Skeleton& skeleton, const std::vector<Pose>& poses) {
    std::vector<std::size_t> all, body;
    for (std::size_t i = 0; i < skeleton.joints().size(); ++i) {
        all.push_back(i);
        const std::string& name = skeleton.joints()[i].name;
        const bool throwing = name == "RightArm" || name == "RightForeArm" || name == "RightHand" ||
                              name == "RThumb" || name == "RightFingerBase" ||
                              name == "RightHandIndex1";
        if (!throwing) body.push_back(i);
    }
    const int throwFrom = kContactFrame - 30;
    const int throwTo = kReleaseFrame + 30;
    const Smoothness windUp = smoothness(poses, 0, throwFrom, all);
    const Smoothness trunk = smoothness(poses, throwFrom, throwTo, body);
    const Smoothness arm = smoothness(poses, throwFrom, throwTo, all);
    const Smoothness recovery = smoothness(poses, throwTo, kFrameCount - 1, all);
    find.within("fastest joint, wind-up, deg/s", windUp.speed, 0, 800);
    find.within("fastest joint but for the throwing arm, deg/s", trunk.speed, 0, 1000);
    find.within("fastest joint, throwing arm, deg/s", arm.speed, 0, 7430);
    find.within("fastest joint, recovery, deg/s", recovery.speed, 0, 800);
    find.within("largest acceleration, wind-up, deg/s^2", windUp.acceleration, 0, 12000);
    find.within("largest acceleration, throw but for its arm, deg/s^2", trunk.acceleration, 0,
                45000);
    find.within("largest acceleration, recovery, deg/s^2", recovery.acceleration, 0, 25000);
}

void checkBall(Findings& find, const Skeleton& skeleton, const std::vector<Pose>& poses,
               const std::vector<BvhRow>& ball) {
    double off = 0;
    for (int i = 0; i <= kReleaseFrame; ++i) {
        const auto at = static_cast<std::size_t>(i);
        const glm::dvec3 held = grip(skeleton, worldPose(skeleton, poses[at]));
        off = std::max(off, glm::distance(held, {ball[at][0], ball[at][1], ball[at][2]}));
    }
    find.within("ball off the hand while held, mm", 1000 * off, 0, 0.1);
    const BvhRow& from = ball[kReleaseFrame];
    const BvhRow& to = ball[kReleaseFrame + 1];
    const Launch launch = launchOf(static_cast<double>(kFrameRate) *
                                   glm::dvec3(to[0] - from[0], to[1] - from[1], to[2] - from[2]));
    find.within("ball's speed, m/s", launch.speed, 15, 30);
    find.within("ball's direction above the horizontal, deg", launch.up, -10, 10);
    find.within("ball's direction off the target, deg", launch.sideways, -5, 5);
    const glm::dvec3 before = grip(skeleton, worldPose(skeleton, poses[kReleaseFrame - 1]));
    const Launch hand = launchOf(static_cast<double>(kFrameRate) *
                                 (glm::dvec3(from[0], from[1], from[2]) - before));
    find.within("ball's speed over the hand's a frame earlier", launch.speed / hand.speed, 0.9,
                1.1);
}

} // namespace

bool checkThrow(std::ostream& out, const Skeleton& skeleton, const std::vector<BvhRow>& body,
                const std::vector<BvhRow>& ball) {
    Findings find(out);
    find.within("frames", static_cast<double>(body.size()), kFrameCount, kFrameCount);
    find.within("frames of the ball", static_cast<double>(ball.size()), kFrameCount, kFrameCount);
    if (!find.good()) return false;
    std::vector<Pose> poses;
    poses.reserve(body.size());
    for (const BvhRow& row : body) poses.push_back(poseOfRow(row));
    const std::vector<FrameMeasure> frames = measureFrames(skeleton, poses);
    find.within("duration, s", frameTime(kFrameCount), 2, 3);
    find.within("frame rate, Hz", kFrameRate, 60, 240);

    double gap = glm::distance(poses.front().root, poses.back().root) * 1000;
    find.within("loop: root's jump, mm", gap, 0, 0.1);
    double jump = 0;
    for (std::size_t j = 0; j < poses.front().local.size(); ++j)
        jump = std::max(jump, apart(poses.front().local[j], poses.back().local[j]));
    find.within("loop: largest joint's jump, deg", jump, 0, 0.1);

    find.within("right sole's lowest, mm", 1000 * rangeOf(frames, &FrameMeasure::rightSole).least,
                -1, 1);
    find.within("left sole's lowest, mm", 1000 * rangeOf(frames, &FrameMeasure::leftSole).least, -1,
                1);
    find.within("pivot foot's slip to the contact, mm",
                slip(frames, &FrameMeasure::rightToe, 0, kContactFrame), 0, 5);
    find.within("lead foot's slip from the contact on, mm",
                slip(frames, &FrameMeasure::leftToe, kContactFrame, kLeadLeavesFrame), 0, 5);
    find.within("lead ankle's slip from the contact on, mm",
                slip(frames, &FrameMeasure::leftAnkle, kContactFrame, kLeadLeavesFrame - 18), 0, 5);
    double drag = 0;
    for (int i = kContactFrame; i <= kReleaseFrame; ++i)
        drag = std::max(drag, frames[static_cast<std::size_t>(i)].rightSole);
    find.within("pivot foot off the floor before the release, mm", 1000 * drag, -1, 5);

    const Range rightKnee = rangeOf(frames, &FrameMeasure::rightKnee);
    const Range leftKnee = rangeOf(frames, &FrameMeasure::leftKnee);
    find.within("right knee's least flexion, deg", rightKnee.least, 5, 180);
    find.within("left knee's least flexion, deg", leftKnee.least, 5, 180);
    find.within("right knee's greatest flexion, deg", rightKnee.most, 0, 140);
    find.within("left knee's greatest flexion, deg", leftKnee.most, 0, 140);
    find.within("right elbow's least flexion, deg", rangeOf(frames, &FrameMeasure::elbow).least, 0,
                180);
    find.within("left elbow's least flexion, deg", rangeOf(frames, &FrameMeasure::leftElbow).least,
                0, 180);
    find.within("greatest external rotation, deg", rangeOf(frames, &FrameMeasure::external).most,
                160, 176);

    Range clearance;
    for (const Pose& pose : poses)
        clearance.add(limbClearance(skeleton, worldPose(skeleton, pose)));
    find.within("least gap between limbs, mm", 1000 * clearance.least, 0, 1000);

    const Sequence s = kinematicSequence(frames);
    find.within("upper trunk's peak after the pelvis's, frames", s.thorax - s.pelvis, 1, 40);
    find.within("elbow's peak after the upper trunk's, frames", s.elbow - s.thorax, 1, 40);
    find.within("shoulder's peak after the elbow's, frames", s.shoulder - s.elbow, 1, 40);

    checkSmoothness(find, skeleton, poses);
    checkBall(find, skeleton, poses, ball);
    return find.good();
}

} // namespace mannequin
