// SPDX-License-Identifier: MIT
#include "springs/SpringChains.h"

#include <gtest/gtest.h>

#include <glm/gtc/constants.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <tuple>
#include <vector>

namespace {

using glm::dquat;
using glm::dvec3;
using osgSkin::SpringChains;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t kBones = 4;
constexpr double kLength = 0.08;

/// A pony tail that points back and down from a head which nods, turns and bobs.
SpringChains::Frame headAt(double time) {
    const dquat turn = glm::angleAxis(0.6 * std::sin(5.0 * time), dvec3(0, 1, 0)) *
                       glm::angleAxis(0.4 * std::sin(8.0 * time + 1.0), dvec3(1, 0, 0));
    const dvec3 place(0.3 * std::sin(3.0 * time), 1.5 + 0.05 * std::sin(11.0 * time), 1.4 * time);
    SpringChains::Frame frame;
    for (std::size_t i = 0; i < kBones; ++i) {
        const dvec3 bone = turn * (kLength * glm::normalize(dvec3(0, -0.6, -1)));
        const dvec3 head = i == 0 ? place + turn * dvec3(0, 0.1, -0.1) : frame.bones[i - 1].tip;
        frame.bones.push_back({head, head + bone, turn});
    }
    return frame;
}

SpringChains::Frame at(SpringChains::Frame frame, const dvec3& shift) {
    for (SpringChains::Bone& bone : frame.bones) {
        bone.head += shift;
        bone.tip += shift;
    }
    return frame;
}

std::vector<SpringChains::Joint> joints(double stiffness, double drag, double gravity,
                                        double radius = 0.0) {
    std::vector<SpringChains::Joint> result;
    for (int i = 0; i < int(kBones); ++i) {
        SpringChains::Joint joint;
        joint.parent = i - 1;
        joint.stiffness = stiffness;
        joint.drag = drag;
        joint.gravity = dvec3(0, -gravity, 0);
        joint.radius = radius;
        result.push_back(joint);
    }
    return result;
}

dvec3 boneOf(const SpringChains& chains, const SpringChains::Frame& frame, std::size_t joint) {
    const dvec3 head = joint == 0 ? frame.bones[0].head : chains.tips()[joint - 1];
    return chains.tips()[joint] - head;
}

double degreesBetween(const dvec3& a, const dvec3& b) {
    return glm::degrees(std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b)));
}

/// The specification's algorithm, written from its text, in steps of any length: speed is kept and
/// gained as 60 frames a second would, in all. The joint pulls along the bone as it would be after
/// 1/60 s; in steps of that length, these are the specification's own.
class PlainSteps {
public:
    PlainSteps(const std::vector<SpringChains::Joint>& joints, const SpringChains::Frame& frame,
               const std::vector<dvec3>& tips)
        : _joints(joints), _heads{frame.bones[0].head}, _tips(tips),
          _speeds(tips.size(), dvec3(0.0)) {
        _heads.insert(_heads.end(), tips.begin(), tips.end() - 1);
    }

    void step(const SpringChains::Frame& frame, double dt) {
        dquat above(1, 0, 0, 0);
        for (std::size_t i = 0; i < _tips.size(); ++i) {
            const SpringChains::Joint& joint = _joints[i];
            const dvec3 head = i == 0 ? frame.bones[0].head : _tips[i - 1];
            const dvec3 pose = above * (frame.bones[i].tip - frame.bones[i].head);
            const double kept = std::pow(1.0 - joint.drag, 60.0 * dt);
            _speeds[i] =
                kept * _speeds[i] + (1.0 - kept) / joint.drag *
                                        (joint.stiffness * glm::normalize(pose) + joint.gravity);
            const dvec3 bone = _tips[i] + dt * _speeds[i] - head, last = _tips[i] - _heads[i];
            const dvec3 ahead = glm::normalize(last + (bone - last) / (60.0 * dt));
            const double along = glm::dot(bone, ahead);
            const double pull =
                along - std::sqrt(along * along - glm::dot(bone, bone) + kLength * kLength);
            const dvec3 tip = head + bone - pull * ahead;
            _speeds[i] = (tip - _tips[i]) / dt;
            _tips[i] = tip;
            _heads[i] = head;
            above = osgSkin::shortestRotation(pose, tip - head) * above;
        }
    }

    const std::vector<dvec3>& tips() const { return _tips; }

private:
    std::vector<SpringChains::Joint> _joints;
    std::vector<dvec3> _heads, _tips, _speeds;
};

/// The largest angle between two chains' bones in a frame.
double apart(const std::vector<dvec3>& a, const std::vector<dvec3>& b, dvec3 head) {
    double most = 0.0;
    dvec3 other = head;
    for (std::size_t i = 0; i < kBones; ++i) {
        most = std::max(most, degreesBetween(a[i] - head, b[i] - other));
        head = a[i];
        other = b[i];
    }
    return most;
}

struct Hair {
    const char* name;
    double stiffness, drag, gravity;
    double fromSpecification; ///< degrees at 60 frames a second, at most
};

constexpr Hair kHair[] = {{"hair", 1.0, 0.4, 0.2, 8.0},
                          {"hanging", 0.05, 0.3, 0.3, 3.0},
                          {"stiff", 4.0, 0.2, 0.0, 15.0},
                          {"loose", 0.5, 0.2, 0.1, 15.0}};

class SpringRates : public testing::TestWithParam<std::tuple<Hair, int>> {};

TEST_P(SpringRates, SwingsAsInFineSteps) {
    const auto& [hair, rate] = GetParam();
    const auto made = joints(hair.stiffness, hair.drag, hair.gravity);
    SpringChains chains(made);
    ASSERT_TRUE(chains.move(headAt(0.0), 0.0));
    PlainSteps fine(made, headAt(0.0), chains.tips());
    double most = 0.0, widest = 0.0;
    int millisecond = 0;
    std::vector<dvec3> before = fine.tips();
    for (int i = 1; i <= 10 * rate; ++i) {
        const double time = double(i) / rate;
        while (1e-3 * millisecond < time - 1e-9) {
            before = fine.tips();
            fine.step(headAt(1e-3 * ++millisecond), 1e-3);
        }
        const SpringChains::Frame frame = headAt(time);
        ASSERT_TRUE(chains.move(frame, 1.0 / rate));
        const double late = millisecond - 1e3 * time;
        std::vector<dvec3> tips = fine.tips();
        for (std::size_t j = 0; j < kBones; ++j) tips[j] = glm::mix(tips[j], before[j], late);
        most = std::max(most, apart(chains.tips(), tips, frame.bones[0].head));
        for (std::size_t j = 0; j < kBones; ++j) {
            EXPECT_NEAR(glm::length(boneOf(chains, frame, j)), kLength, 1e-9);
            widest = std::max(widest, degreesBetween(boneOf(chains, frame, j),
                                                     frame.bones[j].tip - frame.bones[j].head));
        }
    }
    RecordProperty("degrees", std::to_string(most));
    EXPECT_LT(most, 5.0);
    EXPECT_GT(widest, 30.0); // it swings
}

INSTANTIATE_TEST_SUITE_P(SpringChains, SpringRates,
                         testing::Combine(testing::ValuesIn(kHair),
                                          testing::Values(15, 30, 60, 144, 240)),
                         [](const auto& each) {
                             return std::get<0>(each.param).name + std::string("_at_") +
                                    std::to_string(std::get<1>(each.param));
                         });

class SpringSpecification : public testing::TestWithParam<Hair> {};

TEST_P(SpringSpecification, SwingsAsItsStepsOf60Frames) {
    const Hair& hair = GetParam();
    const auto made = joints(hair.stiffness, hair.drag, hair.gravity);
    SpringChains chains(made);
    ASSERT_TRUE(chains.move(headAt(0.0), 0.0));
    PlainSteps plain(made, headAt(0.0), chains.tips());
    double most = 0.0;
    for (int i = 1; i <= 600; ++i) {
        plain.step(headAt(i / 60.0), 1.0 / 60.0);
        ASSERT_TRUE(chains.move(headAt(i / 60.0), 1.0 / 60.0));
        most = std::max(most, apart(chains.tips(), plain.tips(), headAt(i / 60.0).bones[0].head));
    }
    RecordProperty("degrees", std::to_string(most));
    EXPECT_LT(most, hair.fromSpecification);
}

INSTANTIATE_TEST_SUITE_P(SpringChains, SpringSpecification, testing::ValuesIn(kHair),
                         [](const auto& each) { return std::string(each.param.name); });

TEST(SpringChains, HangsAtRestInTheFirstFrame) {
    SpringChains chains(joints(0.0, 0.5, 1.0));
    SpringChains::Frame frame = headAt(0.0);
    ASSERT_TRUE(chains.move(frame, 0.0));
    for (std::size_t i = 0; i < kBones; ++i)
        EXPECT_LT(degreesBetween(boneOf(chains, frame, i), dvec3(0, -1, 0)), 1.0);
    frame.fromWorld = glm::angleAxis(glm::half_pi<double>(), dvec3(1, 0, 0)); // down is -z
    SpringChains tilted(joints(0.0, 0.5, 1.0));
    ASSERT_TRUE(tilted.move(frame, 0.0));
    EXPECT_LT(degreesBetween(boneOf(tilted, frame, 0), dvec3(0, 0, -1)), 1.0);
}

TEST(SpringChains, EndsAtTheSpecificationsSpeed) {
    // A long bone that falls sideways: the speed of 60 frames a second, gravity / drag.
    std::vector<SpringChains::Joint> one(1);
    one[0].drag = 0.4;
    SpringChains::Frame frame;
    frame.bones = {{dvec3(0), dvec3(0, 1e5, 0), dquat(1, 0, 0, 0)}};
    one[0].gravity = dvec3(0.2, 0, 0);
    for (const double rate : {15.0, 60.0, 240.0}) {
        SpringChains chains(one);
        ASSERT_TRUE(chains.move(frame, 0.0));
        dvec3 before(0.0);
        for (int i = 0; i < int(2.0 * rate); ++i) {
            before = chains.tips()[0];
            ASSERT_TRUE(chains.move(frame, 1.0 / rate));
        }
        EXPECT_NEAR(glm::length(chains.tips()[0] - before) * rate, 0.5, 1e-3) << rate;
    }
}

TEST(SpringChains, RefusesNumbersThatAreNotFinite) {
    SpringChains chains(joints(1.0, 0.4, 0.2)), undisturbed(joints(1.0, 0.4, 0.2));
    for (int i = 0; i < 60; ++i) {
        SpringChains::Frame frame = headAt(i / 60.0);
        if (i % 7 == 3) {
            SpringChains::Frame bad = frame;
            (i % 2 ? bad.bones[1].tip.x : bad.bones[0].head.y) = kNan;
            EXPECT_FALSE(chains.move(bad, 1.0 / 60.0));
            bad = frame;
            bad.bones[2].axes.x = std::numeric_limits<double>::infinity();
            EXPECT_FALSE(chains.move(bad, 1.0 / 60.0));
            EXPECT_FALSE(chains.move(frame, kNan));
            frame.bones[3].head.z = 1e300;
            EXPECT_FALSE(chains.move(frame, 1.0 / 60.0));
            frame = headAt(i / 60.0);
        }
        ASSERT_TRUE(chains.move(frame, 1.0 / 60.0));
        ASSERT_TRUE(undisturbed.move(frame, 1.0 / 60.0));
        EXPECT_EQ(chains.tips(), undisturbed.tips());
    }
}

TEST(SpringChains, StaysBoundedWithAnyNumbers) {
    for (const double number : {kNan, std::numeric_limits<double>::infinity(), -1.0, 1e300, 0.0})
        for (const double drag : {kNan, -1.0, 0.0, 1.0, 7.0}) {
            auto made = joints(number, drag, number, number);
            SpringChains chains(made);
            for (int i = 0; i < 100; ++i) {
                const SpringChains::Frame frame = headAt(i / 15.0);
                ASSERT_TRUE(chains.move(frame, 1.0 / 15.0));
                for (std::size_t j = 0; j < kBones; ++j)
                    ASSERT_NEAR(glm::length(boneOf(chains, frame, j)), kLength, 1e-9) << number;
            }
        }
}

struct Jump {
    const char* name;
    double seconds;
    dvec3 shift;
    double degrees;
};

class SpringJumps : public testing::TestWithParam<Jump> {};

TEST_P(SpringJumps, AreCarriedAlong) {
    const Jump& jump = GetParam();
    SpringChains chains(joints(1.0, 0.4, 0.0));
    const SpringChains::Frame frame = headAt(0.0);
    for (int i = 0; i < 30; ++i) ASSERT_TRUE(chains.move(frame, 1.0 / 60.0));
    const dquat turn = glm::angleAxis(glm::radians(jump.degrees), dvec3(0, 1, 0));
    SpringChains::Frame moved = frame;
    for (SpringChains::Bone& bone : moved.bones) {
        bone.head = turn * bone.head + jump.shift;
        bone.tip = turn * bone.tip + jump.shift;
        bone.axes = turn * bone.axes;
    }
    ASSERT_TRUE(chains.move(moved, jump.seconds));
    for (int i = 0; i < 10; ++i) {
        for (std::size_t j = 0; j < kBones; ++j)
            EXPECT_LT(
                degreesBetween(boneOf(chains, moved, j), moved.bones[j].tip - moved.bones[j].head),
                0.1);
        ASSERT_TRUE(chains.move(moved, 1.0 / 60.0));
    }
}

INSTANTIATE_TEST_SUITE_P(SpringChains, SpringJumps,
                         testing::Values(Jump{"teleport", 1.0 / 60.0, dvec3(50, 0, -20), 0.0},
                                         Jump{"turn", 1.0 / 60.0, dvec3(0), 180.0},
                                         Jump{"pause", 5.0, dvec3(0.5, 0, 0), 40.0},
                                         Jump{"time_back", -3.0, dvec3(0.5, 0, 0), 40.0},
                                         Jump{"stopped_time", 0.0, dvec3(0.3, 0, 0), 20.0}),
                         [](const auto& each) { return std::string(each.param.name); });

TEST(SpringChains, StreamsBehindAFastMove) {
    SpringChains chains(joints(0.2, 0.2, 0.1));
    SpringChains::Frame frame;
    for (int i = 0; i < 120; ++i) {
        frame = at(headAt(0.0), dvec3(30.0 * i / 60.0, 0, 0)); // half a metre a frame
        ASSERT_TRUE(chains.move(frame, 1.0 / 60.0));
    }
    EXPECT_LT(degreesBetween(boneOf(chains, frame, 0), dvec3(-1, 0, 0)), 15.0);
}

/// A skirt's chain beside a thigh that kicks through it, and a ball that flies through.
TEST(SpringChains, NeverCrossesColliders) {
    constexpr double kRadius = 0.02;
    for (const double rate : {15.0, 30.0, 60.0, 240.0}) {
        auto made = joints(0.3, 0.3, 0.3, kRadius);
        for (SpringChains::Joint& joint : made) joint.colliders = {0, 1};
        SpringChains chains(made);
        double deepest = 0.0;
        int touches = 0;
        for (int i = 0; i < int(10.0 * rate); ++i) {
            const double time = i / rate;
            SpringChains::Frame frame;
            const dvec3 hip(0.1 * std::sin(2.0 * time), 1.0, 0.0);
            for (std::size_t j = 0; j < kBones; ++j) {
                const dvec3 head = hip + dvec3(0, -kLength * double(j), 0.14);
                frame.bones.push_back({head, head + dvec3(0, -kLength, 0), dquat(1, 0, 0, 0)});
            }
            const double kick = 0.7 * std::sin(6.0 * time);
            frame.colliders = {{hip, hip + 0.4 * dvec3(0, -std::cos(kick), std::sin(kick)), 0.08},
                               {hip + dvec3(0.5 * std::sin(3.0 * time), -0.25, 0.2),
                                hip + dvec3(0.5 * std::sin(3.0 * time), -0.25, 0.2), 0.05}};
            ASSERT_TRUE(chains.move(frame, 1.0 / rate));
            for (const dvec3& tip : chains.tips())
                for (const SpringChains::Collider& c : frame.colliders) {
                    const dvec3 axis = c.end - c.start;
                    const double along = glm::dot(axis, axis) > 0.0
                                             ? glm::dot(tip - c.start, axis) / glm::dot(axis, axis)
                                             : 0.0;
                    const double gap =
                        glm::length(tip - (c.start + std::clamp(along, 0.0, 1.0) * axis)) -
                        c.radius - kRadius;
                    deepest = std::max(deepest, -gap);
                    touches += gap < 1e-3;
                }
        }
        EXPECT_LT(deepest, 1e-6) << rate;
        EXPECT_GT(touches, int(rate)) << rate;
    }
}

/// As in skirts whose first joint is at the next one: rounding would turn it by any angle.
TEST(SpringChains, CarriesTinyBonesAlong) {
    for (const double length : {1e-7, 1e-6, 1e-5}) {
        SpringChains chains(joints(0.7, 0.4, 0.2));
        std::vector<dvec3> before(kBones);
        for (int i = 0; i < 480; ++i) {
            SpringChains::Frame frame = headAt(i / 240.0);
            SpringChains::Bone& tiny = frame.bones[0];
            const dvec3 way = (length / kLength - 1.0) * (tiny.tip - tiny.head);
            tiny.tip += way;
            for (std::size_t j = 1; j < kBones; ++j) {
                frame.bones[j].head += way;
                frame.bones[j].tip += way;
            }
            ASSERT_TRUE(chains.move(frame, i == 0 ? 0.0 : 1.0 / 240.0));
            EXPECT_EQ(chains.tips()[0], tiny.head) << "does not turn";
            for (std::size_t j = 1; j < kBones; ++j) {
                const dvec3 bone = chains.tips()[j] - chains.tips()[j - 1];
                EXPECT_NEAR(glm::length(bone), kLength, 1e-6 + length);
                if (i > 0) {
                    EXPECT_LT(degreesBetween(bone, before[j]), 10.0) << i << ' ' << j;
                }
                before[j] = bone;
            }
        }
    }
}

/// A tail that is shaken in a ball, and one over a floor.
TEST(SpringChains, StaysInsideOfCollidersAndOverPlanes) {
    constexpr double kRadius = 0.02, kBall = 0.3, kPlane = 1e5;
    for (const double rate : {15.0, 60.0, 240.0}) {
        auto made = joints(0.1, 0.3, 0.5, kRadius);
        for (SpringChains::Joint& joint : made) joint.colliders = {0, 1};
        SpringChains chains(made);
        double deepest = 0.0;
        int touches = 0;
        for (int i = 0; i < int(10.0 * rate); ++i) {
            SpringChains::Frame frame;
            const dvec3 top(0.2 * std::sin(5.0 * i / rate), 0.15, 0.1 * std::sin(7.0 * i / rate));
            for (std::size_t j = 0; j < kBones; ++j) {
                const dvec3 head = top + dvec3(kLength * double(j), 0, 0);
                frame.bones.push_back({head, head + dvec3(kLength, 0, 0), dquat(1, 0, 0, 0)});
            }
            const dvec3 below(0, -kPlane, 0);
            frame.colliders = {{dvec3(0), dvec3(0), -kBall}, {below, below, kPlane}};
            ASSERT_TRUE(chains.move(frame, 1.0 / rate));
            for (const dvec3& tip : chains.tips()) {
                deepest =
                    std::max({deepest, glm::length(tip) - (kBall - kRadius), kRadius - tip.y});
                touches += tip.y < kRadius + 1e-3;
            }
        }
        EXPECT_LT(deepest, 2e-5) << rate;
        EXPECT_GT(touches, int(rate)) << rate;
    }
}

/// Two balls that both hold the tips, each of which moves them back into the other.
TEST(SpringChains, LookAtCollidersAgainWithinTheFramesLimit) {
    auto made = joints(0.3, 0.3, 0.0, 1.0);
    for (SpringChains::Joint& joint : made) joint.colliders = {0, 1};
    SpringChains chains(made);
    SpringChains::Frame frame = headAt(0.0);
    const dvec3 middle = frame.bones[1].tip;
    frame.colliders = {{middle + dvec3(0.01, 0, 0), middle + dvec3(0.01, 0, 0), 5.0},
                       {middle - dvec3(0.01, 0, 0), middle - dvec3(0.01, 0, 0), 5.0}};
    const std::size_t pairs = 2 * kBones;
    ASSERT_TRUE(chains.move(frame, 0.0));
    EXPECT_GT(chains.rechecks(), 100 * pairs);
    constexpr std::size_t kFew = 100;
    ASSERT_TRUE(chains.move(frame, 1.0 / 60.0, kFew));
    EXPECT_LE(chains.rechecks(), kFew);
    EXPECT_EQ(chains.checks(), 8 * pairs + chains.rechecks()); // in each of eight steps once
    for (const dvec3& tip : chains.tips()) EXPECT_TRUE(osgSkin::isFinite(tip));
}

TEST(SpringChains, PointsAwayFromAColliderAroundItsJoint) {
    auto made = joints(1.0, 0.4, 1.0, 0.0);
    made.resize(1);
    made[0].colliders = {0};
    SpringChains chains(made);
    SpringChains::Frame frame;
    frame.bones = {{dvec3(0, 0.05, 0), dvec3(0, 0.05 - kLength, 0), dquat(1, 0, 0, 0)}};
    frame.colliders = {{dvec3(0), dvec3(0), 0.1}}; // reaches 0.05 above the joint
    ASSERT_TRUE(chains.move(frame, 0.0));
    EXPECT_GE(glm::length(chains.tips()[0]), 0.1 - 1e-9);
    frame.colliders[0].radius = 1.0; // no room
    ASSERT_TRUE(chains.move(frame, 1.0 / 60.0));
    EXPECT_LT(degreesBetween(chains.tips()[0] - frame.bones[0].head, dvec3(0, 1, 0)), 1e-6);
}

} // namespace
