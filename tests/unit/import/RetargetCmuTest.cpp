// SPDX-License-Identifier: MIT
#include "Figure.h"
#include "JointIndex.h"
#include "Paths.h"

#include <osgSkinImport/ImportMotion>
#include <osgSkinImport/ImportSkeleton>
#include <osgSkinRig/Retarget>

#include <algorithm>

namespace {

using osgSkin::Clip;
using osgSkin::Motion;
using osgSkin::RestSkeleton;

struct Limb {
    const char* from;
    const char* to;
};

constexpr Limb kLimbs[] = {
    {"Arm", "ForeArm"}, {"ForeArm", "Hand"}, {"UpLeg", "Leg"}, {"Leg", "Foot"}};

class CmuClip : public testing::TestWithParam<const char*> {
protected:
    void SetUp() override {
        const std::string rigPath = sharedData("makehuman/rig/cmu_mb_neutral.bvh");
        const std::string path = sharedData(std::string("cmu/mb/") + GetParam());
        OSGSKIN_NEEDS(rigPath);
        OSGSKIN_NEEDS(path);
        rig = osgSkin::importSkeleton(rigPath);
        motion = osgSkin::importMotion(path, 1);
        clip = osgSkin::retarget(motion, rig, {}, &report);
    }

    RestSkeleton rig;
    Motion motion;
    Clip clip;
    osgSkin::RetargetReport report;
};

TEST_P(CmuClip, LimbsPointWhereTheMotionsLimbsPoint) {
    for (std::size_t f = 0; f < clip.frames; f += 7) {
        const Placed ours = place(clip, rig, f);
        const Placed theirs = place(motion, f);
        for (const char* side : {"Left", "Right"})
            for (const Limb& bone : kLimbs) {
                const std::string from = std::string(side) + bone.from;
                const std::string to = std::string(side) + bone.to;
                const glm::dvec3 a =
                    ours.places[jointIndex(rig, to)] - ours.places[jointIndex(rig, from)];
                const glm::dvec3 b = theirs.places[jointIndex(motion.skeleton, to)] -
                                     theirs.places[jointIndex(motion.skeleton, from)];
                ASSERT_LT(angleBetween(a, b), 0.1) << from << ", frame " << f;
            }
    }
}

/// The rig's sole is as flat as the motion's is, however steep the two skeletons' foot bones are.
TEST_P(CmuClip, FeetTurnWithTheMotionButForTheirHeading) {
    for (const std::string name : {"LeftFoot", "RightFoot"}) {
        const auto ours = static_cast<std::size_t>(rig.find(name));
        for (std::size_t f = 0; f < clip.frames; f += 7) {
            const glm::dvec3 up(0, 1, 0); // the sole's normal at rest
            ASSERT_LT(angleBetween(place(clip, rig, f).turns[ours] * up,
                                   place(motion, f).turns[jointIndex(motion.skeleton, name)] * up),
                      1e-3)
                << name << ", frame " << f;
        }
    }
}

TEST_P(CmuClip, TrunkTurnsWithTheMotion) {
    for (std::size_t f = 0; f < clip.frames; f += 7) {
        const Placed ours = place(clip, rig, f);
        const Placed theirs = place(motion, f);
        for (const char* name : {"Hips", "Spine", "Spine1", "Neck", "Head", "LeftShoulder"})
            ASSERT_LT(angleBetween(ours.turns[jointIndex(rig, name)],
                                   theirs.turns[jointIndex(motion.skeleton, name)]),
                      1e-3)
                << name << ", frame " << f;
    }
}

TEST_P(CmuClip, MapsEveryRigJoint) {
    for (const osgSkin::RetargetReport::Entry& entry : report.entries)
        EXPECT_FALSE(entry.motionJoint.empty()) << entry.rigJoint;
    EXPECT_TRUE(report.unusedMotionJoints.empty());
}

INSTANTIATE_TEST_SUITE_P(Files, CmuClip,
                         testing::Values("12_01_walk_pybvh.bvh", "01_01.bvh",
                                         "124_01_pitch_excerpt_120hz.bvh"),
                         [](const auto& file) {
                             return "clip" + std::string(file.param).substr(0, 5);
                         });

class CmuWalk : public CmuClip {};

TEST_P(CmuWalk, FeetStandOnTheFloorOfTheRestPose) {
    constexpr double bodyHeight = 16.4; // decimeters
    const std::size_t feet[] = {jointIndex(rig, "LeftFoot"), jointIndex(rig, "RightFoot"),
                                jointIndex(rig, "LeftToeBase"), jointIndex(rig, "RightToeBase")};
    for (std::size_t f = 0; f < clip.frames; ++f) {
        const Placed placed = place(clip, rig, f);
        double lowest = 1e9;
        for (const std::size_t j : feet)
            lowest = std::min(lowest, placed.places[j].y - rig.joints[j].centre.y);
        ASSERT_LT(std::abs(lowest), 0.03 * bodyHeight) << "frame " << f;
    }
}

TEST_P(CmuWalk, HandsHangBelowTheShoulders) {
    for (std::size_t f = 0; f < clip.frames; ++f) {
        const Placed placed = place(clip, rig, f);
        for (const char* side : {"Left", "Right"})
            ASSERT_LT(placed.places[jointIndex(rig, std::string(side) + "Hand")].y,
                      placed.places[jointIndex(rig, std::string(side) + "Arm")].y - 2.0)
                << side << ", frame " << f;
    }
}

INSTANTIATE_TEST_SUITE_P(Files, CmuWalk, testing::Values("12_01_walk_pybvh.bvh"));

} // namespace
