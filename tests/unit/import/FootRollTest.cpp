// SPDX-License-Identifier: MIT
// Feet that a motion turns upside down.
#include "Figure.h"
#include "Paths.h"

#include <osgSkinImport/ImportMotion>
#include <osgSkinImport/ImportSkeleton>
#include <osgSkinRig/Retarget>

#include <algorithm>
#include <cmath>

namespace {

using osgSkin::Clip;
using osgSkin::Motion;
using osgSkin::RestSkeleton;
using osgSkin::RetargetReport;

constexpr std::size_t kFoot = 10;
const glm::dvec3 kToes = {0, -1, 2}; ///< the direction of makeFigure()'s foot

/// In frame d the foot nods a little and is rolled by d - 180 degrees about its own length.
Motion rollAround() {
    Motion motion = standStill(makeFigure(0.0), 361);
    for (std::size_t f = 0; f < motion.frames; ++f)
        motion.rotations[f * motion.skeleton.joints.size() + kFoot] =
            turnDegrees(20.0, {1, 0, 0}) * turnDegrees(double(f) - 180.0, kToes);
    return motion;
}

double rollFrom(const glm::dquat& shin, const glm::dquat& foot) {
    const glm::dquat turn =
        glm::conjugate(shin * turnDegrees(20.0, {1, 0, 0})) * foot; // about kToes only
    return angleBetween(glm::dquat(1, 0, 0, 0), turn);
}

TEST(FootRoll, IsLimitedTo90Degrees) {
    const Motion motion = rollAround();
    RetargetReport report;
    const Clip clip = osgSkin::retarget(motion, motion.skeleton, {}, &report);
    for (std::size_t f = 0; f < clip.frames; ++f) {
        const Placed posed = place(clip, motion.skeleton, f);
        const double rolled = std::abs(double(f) - 180.0);
        EXPECT_NEAR(rollFrom(posed.turns[kFoot - 1], posed.turns[kFoot]),
                    std::min(rolled, 180.0 - rolled), 1e-6)
            << f;
        EXPECT_LT(angleBetween(posed.turns[kFoot] * kToes, place(motion, f).turns[kFoot] * kToes),
                  1e-6)
            << f;
    }
    EXPECT_EQ(report.entries[kFoot].flippedFrames, 180u); // 91 to 180 degrees, both ways
    EXPECT_EQ(report.entries[kFoot - 1].flippedFrames, 0u);
    EXPECT_NE(report.text().find("upside down in 180 samples"), std::string::npos);
}

TEST(FootRoll, IsContinuous) {
    const Motion motion = rollAround();
    const Clip clip = osgSkin::retarget(motion, motion.skeleton);
    for (std::size_t f = 1; f < clip.frames; ++f)
        EXPECT_LT(angleBetween(clip.rotations[(f - 1) * clip.joints + kFoot],
                               clip.rotations[f * clip.joints + kFoot]),
                  1.001)
            << f;
}

TEST(FootRoll, RotatesToes) {
    RestSkeleton rig = makeFigure(0.0);
    rig.joints.push_back({"LeftToeBase", int(kFoot), {1, 0.2, 1.6}, {}});
    rig.joints[kFoot].tip.reset();
    rig.joints.back().tip = glm::dvec3(1, 0.2, 2.5);
    Motion motion = standStill(rig, 1);
    motion.rotations[kFoot] = turnDegrees(170.0, {0, -0.8, 1.6});
    motion.rotations[kFoot + 1] = turnDegrees(15.0, {1, 0, 0});
    const Clip clip = osgSkin::retarget(motion, rig);
    EXPECT_NEAR(angleBetween(clip.rotations[kFoot], glm::dquat(1, 0, 0, 0)), 10.0, 1e-6);
    EXPECT_NEAR(angleBetween(clip.rotations[kFoot + 1], motion.rotations[kFoot + 1]), 0.0, 1e-6);
}

/// A dancer whose feet are upside down in the file for most of its seven seconds.
TEST(FootRoll, StaysInTheAnklesRange) {
    const std::string dance = sharedData("cmu/daz/05_06.bvh");
    OSGSKIN_NEEDS(dance);
    const RestSkeleton rig =
        osgSkin::importSkeleton(sharedData("makehuman/rig/cmu_mb_neutral.bvh"));
    RetargetReport report;
    const Clip clip = osgSkin::retarget(osgSkin::importMotion(dance), rig, {}, &report);
    for (const char* name : {"LeftFoot", "RightFoot"}) {
        std::size_t foot = 0;
        while (rig.joints.at(foot).name != name) ++foot;
        EXPECT_GT(report.entries[foot].flippedFrames, clip.frames / 2);
        std::size_t wrung = 0;
        for (std::size_t f = 0; f < clip.frames; ++f)
            if (angleBetween(glm::dquat(1, 0, 0, 0), clip.rotations[f * clip.joints + foot]) > 90.0)
                ++wrung;
        // The remaining samples are those in which the file also bends the foot back.
        EXPECT_LT(wrung, report.entries[foot].flippedFrames / 7) << name;
    }
}

} // namespace
