// SPDX-License-Identifier: MIT
// Collar bones that follow the arms where a motion does not move them.
#include "Figure.h"
#include "JointIndex.h"

#include <osgSkinRig/Retarget>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

namespace {

using osgSkin::Clip;
using osgSkin::Motion;
using osgSkin::RestSkeleton;

/// makeFigure() with its right arm and leg, and arms level at rest.
RestSkeleton makeBody(double size = 1.0) {
    RestSkeleton body = makeFigure(0.0, size);
    const auto mirrored = [](glm::dvec3 p) { return glm::dvec3(-p.x, p.y, p.z); };
    const std::size_t count = body.joints.size();
    std::vector<int> right(count, -1);
    for (std::size_t j = 0; j < count; ++j) {
        osgSkin::RestJoint joint = body.joints[j];
        if (joint.name.compare(0, 4, "Left") == 0)
            joint.name = "Right" + joint.name.substr(4);
        else if (joint.name == "LHipJoint")
            joint.name = "RHipJoint";
        else
            continue;
        const int parent = right[std::size_t(joint.parent)];
        if (parent >= 0) joint.parent = parent;
        joint.centre = mirrored(joint.centre);
        if (joint.tip) joint.tip = mirrored(*joint.tip);
        right[j] = static_cast<int>(body.joints.size());
        body.joints.push_back(joint);
    }
    return body;
}

/// Another skeleton than makeBody()'s.
RestSkeleton makeRig() {
    RestSkeleton rig = makeBody(1.5);
    rig.joints[2].centre.z += 2.0;
    return rig;
}

/// A still sample, and one with a joint rotated.
Motion turning(const char* joint, const glm::dquat& by) {
    const RestSkeleton body = makeBody();
    Motion motion = standStill(body, 2);
    motion.rotations[body.joints.size() + jointIndex(body, joint)] = by;
    return motion;
}

/// The left collar bone's rotation in the second sample, that of the first being the rest's.
glm::dquat collarOf(const Motion& motion, const RestSkeleton& rig, bool follows = true) {
    osgSkin::RetargetOptions options;
    options.collarsFollow = follows;
    const Clip clip = osgSkin::retarget(motion, rig, options);
    const std::size_t collar = jointIndex(rig, "LeftShoulder");
    EXPECT_LT(angleBetween(place(clip, rig, 0).turns[collar], glm::dquat(1, 0, 0, 0)), 1e-6);
    return place(clip, rig, 1).turns[collar];
}

} // namespace

TEST(CollarBones, RiseWithTheArm) {
    for (const double degrees : {-80.0, 60.0}) {
        const Motion motion = turning("LeftArm", turnDegrees(degrees, {0, 0, 1}));
        EXPECT_LT(angleBetween(collarOf(motion, makeRig()), turnDegrees(0.12 * degrees, {0, 0, 1})),
                  1e-6);
        EXPECT_EQ(collarOf(motion, makeRig(), false), glm::dquat(1, 0, 0, 0));
        EXPECT_EQ(collarOf(motion, makeBody()), glm::dquat(1, 0, 0, 0)) << "on its own skeleton";
    }
}

/// An arm that reaches forward from halfway between hanging and level turns by 90 degrees, 64 of
/// them about the vertical; the arm level at the side takes the first part of it back.
TEST(CollarBones, ComeForwardWithTheArm) {
    const glm::dquat forward =
        collarOf(turning("LeftArm", turnDegrees(-90.0, {0, 1, 0})), makeRig());
    const double turn = 90.0 / std::sqrt(2.0);
    EXPECT_LT(angleBetween(forward, turnDegrees(-0.22 * turn, {0, 1, 0}) *
                                        turnDegrees(-0.12 * 45.0, {0, 0, 1})),
              1e-6);
    EXPECT_GT((forward * glm::dvec3(1, 0, 0)).z, 0.2);
}

TEST(CollarBones, StayAsTheMotionMovesThem) {
    Motion motion = turning("LeftArm", turnDegrees(60, {0, 0, 1}));
    const glm::dquat shrug = turnDegrees(2.0, {0, 0, 1});
    motion.rotations[motion.skeleton.joints.size() + jointIndex(motion.skeleton, "LeftShoulder")] =
        shrug;
    EXPECT_LT(angleBetween(collarOf(motion, makeRig()), shrug), 1e-6);
}

TEST(CollarBones, BringHelpersAlong) {
    RestSkeleton rig = makeRig();
    const auto collar = static_cast<int>(jointIndex(rig, "LeftShoulder"));
    rig.joints.push_back({"strap", collar, {1.5, 23.0, 0.0}, {}});
    const Clip clip = osgSkin::retarget(turning("LeftArm", turnDegrees(60, {0, 0, 1})), rig);
    EXPECT_LT(angleBetween(place(clip, rig, 1).turns.back(), turnDegrees(7.2, {0, 0, 1})), 1e-6);
}
