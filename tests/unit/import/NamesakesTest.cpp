// SPDX-License-Identifier: MIT
// Clips of the rig's own skeleton, which has further joints in the clip or in the rig.
#include "ActorMotions.h"
#include "Figure.h"

#include <osgSkinImport/ImportMotion>
#include <osgSkinImport/ImportSkeleton>
#include <osgSkinRig/Retarget>

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include <cmath>
#include <string>
#include <vector>

using namespace osgSkin;

namespace {

/// Adds a joint halfway between one and its parent.
void addBetween(RestSkeleton& skeleton, std::size_t place) {
    RestJoint between = skeleton.joints[place];
    const RestJoint& above = skeleton.joints[std::size_t(between.parent)];
    between.name = "Spine"; // which has the role of the one below it
    between.centre = 0.5 * (above.centre + between.centre);
    between.frame = above.frame;
    for (RestJoint& joint : skeleton.joints)
        if (joint.parent >= int(place)) ++joint.parent;
    skeleton.joints[place].parent = int(place);
    skeleton.joints.insert(skeleton.joints.begin() + std::ptrdiff_t(place), between);
}

class Namesakes : public testing::Test {
protected:
    const Motion actor = importMotion(OSGSKIN_DATA "/throw.bvh");
    const RestSkeleton rig = importSkeleton(OSGSKIN_DATA "/thrower.bvh");
    const std::size_t joints = actor.skeleton.joints.size();
};

} // namespace

/// One more joint, on the floor, with a name that would have another role.
TEST_F(Namesakes, ArePairedBeforeRoles) {
    RestSkeleton pelvic = rig;
    Motion without = actor;
    without.skeleton = rig;
    for (glm::dvec3& position : without.rootPositions) position.y -= 0.02 * rig.joints[0].centre.y;
    Motion motion = rebasedFrom(without, folded(joints), true);
    for (RestSkeleton* each : {&pelvic, &without.skeleton, &motion.skeleton})
        each->joints[0].name = "Pelvis";
    RestJoint hips = motion.skeleton.joints[0];
    hips.name = "Hips";
    hips.frame = kIdentity;
    const glm::dvec3 height(0.0, hips.centre.y, 0.0);
    hips.centre -= height;
    for (glm::dvec3& position : motion.rootPositions) position -= height;
    for (RestJoint& joint : motion.skeleton.joints) ++joint.parent;
    motion.skeleton.joints.insert(motion.skeleton.joints.begin(), hips);
    for (std::size_t f = 0; f < motion.frames; ++f)
        motion.rotations.insert(motion.rotations.begin() + std::ptrdiff_t(f * (joints + 1)),
                                kIdentity);
    const Clip expected = retarget(without, pelvic);
    for (const char* prefix : {"", "Rig:"}) {
        for (RestJoint& joint : motion.skeleton.joints) joint.name = prefix + joint.name;
        RetargetReport report;
        const Clip clip = retarget(motion, pelvic, {}, &report);
        EXPECT_TRUE(saysOf(report, "local rotations are copied")) << report.text().substr(0, 300);
        for (std::size_t i = 0; i < clip.rotations.size(); ++i)
            ASSERT_LT(angleBetween(clip.rotations[i], expected.rotations[i]), 1e-4);
        for (std::size_t f = 0; f < clip.frames; ++f)
            ASSERT_LT(glm::distance(clip.rootPositions[f], expected.rootPositions[f]), 1e-6) << f;
    }
}

TEST_F(Namesakes, OneMoreJointBetweenTurnsAndMovesTheOneBelow) {
    Motion without = actor, folds = rebasedFrom(actor, folded(joints), true);
    const auto place = std::size_t(rig.find("Spine1"));
    RestSkeleton body = rig;
    for (RestSkeleton* each : {&body, &without.skeleton, &folds.skeleton})
        for (std::size_t j = 1; j <= 3; ++j)
            each->joints[place - 3 + j].name = "Spine" + std::to_string(j);
    const Clip expected = retarget(without, body);
    for (const double angle : {0.0, 20.0}) {
        Motion motion = folds;
        addBetween(motion.skeleton, place);
        const glm::dquat turn = turnDegrees(angle, {1, 0, 0});
        for (std::size_t f = 0; f < motion.frames; ++f) {
            const auto at = motion.rotations.begin() + std::ptrdiff_t(f * (joints + 1) + place);
            *at = glm::conjugate(turn) * *at;
            motion.rotations.insert(at, turn);
        }
        const Clip clip = retarget(motion, body);
        for (std::size_t i = 0; i < clip.rotations.size(); ++i)
            ASSERT_LT(angleBetween(clip.rotations[i], expected.rotations[i]), 1e-4) << i;
        ASSERT_EQ(clip.moves.size(), angle > 0.0 ? 1u : 0u);
        if (angle == 0.0) continue;
        const double bone = glm::distance(body.joints[place].centre, body.joints[place - 1].centre);
        for (const glm::dvec3& offset : clip.moves.at(place))
            ASSERT_NEAR(glm::length(offset), bone * std::cos(glm::radians(angle / 2.0)), 1e-3);
    }
    addBetween(body, place);
    const Clip clip = retarget(folds, body);
    for (std::size_t i = 0; i < clip.rotations.size(); ++i) {
        const std::size_t f = i / (joints + 1), j = i % (joints + 1);
        const glm::dquat& before = expected.rotations[f * joints + j - (j > place ? 1 : 0)];
        ASSERT_LT(angleBetween(clip.rotations[i], j == place ? kIdentity : before), 1e-4) << j;
    }
}
