// SPDX-License-Identifier: MIT
// Joints that are not part of the body: targets, cloth, held objects. They move nothing else.
#include "Figure.h"

#include <osgSkinRig/Clip>
#include <osgSkinRig/Retarget>
#include <osgSkinRig/RetargetReport>

#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <vector>

using namespace osgSkin;

namespace {

/// makeFigure() with its right side.
RestSkeleton makeBody(double armDegrees) {
    RestSkeleton body = makeFigure(armDegrees);
    const std::vector<RestJoint> left = body.joints;
    const auto mirrored = [](glm::dvec3 p) { return glm::dvec3(-p.x, p.y, p.z); };
    const auto otherSide = [](const std::string& name) {
        return name.substr(0, 4) == "Left" ? "Right" + name.substr(4) : "R" + name.substr(1);
    };
    for (const RestJoint& joint : left) {
        if (joint.name[0] != 'L') continue;
        RestJoint other = joint;
        other.name = otherSide(joint.name);
        other.centre = mirrored(joint.centre);
        if (joint.tip) other.tip = mirrored(*joint.tip);
        const std::string& above = left[std::size_t(joint.parent)].name;
        if (above[0] == 'L') other.parent = body.find(otherSide(above));
        body.joints.push_back(other);
    }
    return body;
}

struct Helper {
    const char* what;
    std::function<void(RestSkeleton&)> add;
};

void chain(RestSkeleton& body, const char* name, const char* above, glm::dvec3 to) {
    const int top = body.find(above);
    const glm::dvec3 from = body.joints[std::size_t(top)].centre;
    const int first = body.add(std::string(name) + "1", top, 0.5 * (from + to));
    body.add(std::string(name) + "2", first, to);
}

std::vector<Helper> helpers() {
    return {
        {"a cape",
         [](RestSkeleton& body) {
             chain(body, "cape", "Spine", {0, 0.2, -1});
         }},
        {"a tail",
         [](RestSkeleton& body) {
             chain(body, "tail", "Hips", {0, -0.5, -2});
         }},
        {"cloth on a thigh",
         [](RestSkeleton& body) {
             chain(body, "dress", "LeftUpLeg", {2, -1, 0});
         }},
        {"a sword",
         [](RestSkeleton& body) {
             chain(body, "blade", "LeftHand", {8, -3, 0});
         }},
        {"a camera", [](RestSkeleton& body) { body.add("eye", 0, glm::dvec3(0, 100, 0)); }},
        {"a joint under the floor",
         [](RestSkeleton& body) { body.add("under", 0, glm::dvec3(0, -9, 0)); }},
        {"targets of feet",
         [](RestSkeleton& body) {
             const int root = body.add("ik_foot_root", 0, glm::dvec3(0, 0, 0));
             body.add("ik_foot_l", root, glm::dvec3(1, 1, 0));
             body.add("ik_foot_r", root, glm::dvec3(-1, 1, 0));
         }},
    };
}

Motion walkAway(const RestSkeleton& actor) {
    Motion motion = standStill(actor, 20);
    for (std::size_t f = 0; f < motion.frames; ++f) {
        motion.rootPositions[f] += glm::dvec3(0.1, 0.0, 0.3) * double(f);
        motion.rotations[f * actor.joints.size() + std::size_t(actor.find("LeftUpLeg"))] =
            turnDegrees(2.0 * double(f), {1, 0, 0});
    }
    return motion;
}

void expectTheSame(const Clip& clip, const RetargetReport& report, const Clip& plain,
                   const RetargetReport& plainReport) {
    EXPECT_NEAR(report.scale, plainReport.scale, 1e-12);
    ASSERT_EQ(clip.frames, plain.frames);
    for (std::size_t f = 0; f < plain.frames; ++f) {
        EXPECT_LT(glm::length(clip.rootPositions[f] - plain.rootPositions[f]), 1e-9) << f;
        for (std::size_t j = 0; j < plain.joints; ++j)
            ASSERT_LT(angleBetween(clip.rotations[f * clip.joints + j],
                                   plain.rotations[f * plain.joints + j]),
                      1e-6)
                << "joint " << j << ", sample " << f;
    }
}

} // namespace

TEST(HelperJoints, OfTheRigDoNotChangePoses) {
    const Motion motion = walkAway(makeBody(30.0));
    const RestSkeleton rig = makeBody(0.0);
    RetargetReport plainReport;
    const Clip plain = retarget(motion, rig, {}, &plainReport);
    for (const Helper& helper : helpers()) {
        SCOPED_TRACE(helper.what);
        RestSkeleton with = rig;
        helper.add(with);
        RetargetReport report;
        const Clip clip = retarget(motion, with, {}, &report);
        expectTheSame(clip, report, plain, plainReport);
    }
}

TEST(HelperJoints, OfTheMotionDoNotChangePoses) {
    const RestSkeleton actor = makeBody(30.0);
    const RestSkeleton rig = makeBody(0.0);
    RetargetReport plainReport;
    const Clip plain = retarget(walkAway(actor), rig, {}, &plainReport);
    for (const Helper& helper : helpers()) {
        SCOPED_TRACE(helper.what);
        RestSkeleton with = actor;
        helper.add(with);
        RetargetReport report;
        const Clip clip = retarget(walkAway(with), rig, {}, &report);
        expectTheSame(clip, report, plain, plainReport);
    }
}

/// There is no height to compare: the motion's unit stays.
TEST(HelperJoints, MotionWithoutLegsKeepsItsUnit) {
    RestSkeleton actor;
    const RestSkeleton body = makeBody(30.0);
    std::vector<int> now(body.joints.size(), -1);
    for (std::size_t j = 0; j < body.joints.size(); ++j) {
        RestJoint joint = body.joints[j];
        if (joint.name.find("Leg") != std::string::npos ||
            joint.name.find("Foot") != std::string::npos ||
            joint.name.find("HipJoint") != std::string::npos)
            continue;
        if (joint.parent >= 0) joint.parent = now[std::size_t(joint.parent)];
        now[j] = int(actor.joints.size());
        actor.joints.push_back(joint);
    }
    Motion motion = standStill(actor, 2);
    motion.rootPositions[1] += glm::dvec3(4, 0, -2);
    RetargetReport report;
    const Clip clip = retarget(motion, makeBody(0.0), {}, &report);
    EXPECT_DOUBLE_EQ(report.scale, 1.0);
    EXPECT_LT(glm::length(clip.rootPositions[1] - clip.rootPositions[0] - glm::dvec3(4, 0, -2)),
              1e-9);
}

/// A held object does not give the hand's direction; its tip and its fingers do.
TEST(HelperJoints, HandIgnoresHeldObject) {
    RestSkeleton rig = makeBody(0.0);
    const int hand = rig.find("LeftHand");
    rig.joints[std::size_t(hand)].tip.reset();
    const Motion motion = standStill(makeBody(0.0), 1);
    const glm::dvec3 at = rig.joints[std::size_t(hand)].centre;
    for (const char* held : {"staff", "sword_l", "weapon"}) {
        RestSkeleton with = rig;
        with.add(held, hand, at + glm::dvec3(0.0, -0.5, 1.0));
        RetargetReport report;
        retarget(motion, with, {}, &report);
        EXPECT_NEAR(report.entries[std::size_t(hand)].alignmentDegrees, 0.0, 1e-9) << held;
    }
    RestSkeleton ends = rig;
    ends.add("LeftHand_end", hand, at + glm::dvec3(0.0, 0.0, 1.0));
    RetargetReport report;
    retarget(motion, ends, {}, &report);
    EXPECT_NEAR(report.entries[std::size_t(hand)].alignmentDegrees, 90.0, 1e-6);
}
