// SPDX-License-Identifier: MIT
// One pose at a time gives what the whole clip gives, where nothing needs the whole clip.
#include "ActorMotions.h"
#include "ExpectError.h"
#include "Figure.h"
#include "Paths.h"

#include <osgSkinImport/ImportMotion>
#include <osgSkinImport/ImportSkeleton>
#include <osgSkinRig/LiveRetarget>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

namespace {

using osgSkin::Clip;
using osgSkin::JointSample;
using osgSkin::LiveRetarget;
using osgSkin::Motion;
using osgSkin::RestSkeleton;

/// The largest differences between a motion transferred pose by pose and as a whole.
struct LiveDifference {
    double rotation = 0.0; ///< degrees
    double along = 0.0;    ///< of the root along the floor, in the rig's unit
    double rise = 0.0;     ///< by which the differences of the root's heights differ
};

LiveDifference compareWithWhole(LiveRetarget& live, const Motion& motion, const RestSkeleton& rig,
                                const osgSkin::RetargetOptions& options = {}) {
    const Clip whole = osgSkin::retarget(motion, rig, options);
    std::vector<JointSample> joints(rig.joints.size());
    LiveDifference result;
    double lowest = std::numeric_limits<double>::infinity(), highest = -lowest;
    for (std::size_t f = 0; f < motion.frames; ++f) {
        EXPECT_TRUE(live.apply(&motion.rotation(f, 0), motion.rootPositions[f], joints.data()));
        for (std::size_t j = 0; j < joints.size(); ++j)
            result.rotation =
                std::max(result.rotation,
                         angleBetween(joints[j].rotation, whole.rotations[f * whole.joints + j]));
        const glm::dvec3 off =
            joints[0].translation + rig.joints[0].centre - whole.rootPositions[f];
        result.along = std::max(result.along, std::hypot(off.x, off.z));
        lowest = std::min(lowest, off.y);
        highest = std::max(highest, off.y);
    }
    result.rise = highest - lowest;
    return result;
}

void expectLikeWhole(const Motion& motion, const RestSkeleton& rig) {
    osgSkin::RetargetOptions options;
    options.collarsFollow = false; // which needs a calibration
    LiveRetarget live(motion.skeleton, rig, options);
    LiveRetarget calibrated(motion, rig);
    EXPECT_LT(compareWithWhole(calibrated, motion, rig).rotation, 1e-6);
    const LiveDifference off = compareWithWhole(live, motion, rig, options);
    EXPECT_LT(off.rotation, 1e-6);
    EXPECT_LT(off.along, 1e-6 * rig.joints[0].centre.y);
    EXPECT_LT(off.rise, 1e-6 * rig.joints[0].centre.y);
}

class LiveCmu : public testing::TestWithParam<const char*> {};

} // namespace

TEST(LiveRetarget, MatchesTheWholeClip) {
    const Motion actor = osgSkin::importMotion(OSGSKIN_DATA "/throw.bvh");
    expectLikeWhole(actor, osgSkin::importSkeleton(OSGSKIN_DATA "/pedestrian.bvh"));
    expectLikeWhole(actor, osgSkin::importSkeleton(OSGSKIN_DATA "/thrower.bvh"));
    expectLikeWhole(osgSkin::importMotion(OSGSKIN_DATA "/pedestrian_run.bvh"),
                    osgSkin::importSkeleton(OSGSKIN_DATA "/thrower.bvh"));
}

TEST_P(LiveCmu, MatchesTheWholeClip) {
    const std::string path = sharedData(std::string("cmu/") + GetParam());
    OSGSKIN_NEEDS(path);
    expectLikeWhole(osgSkin::importMotion(path, 1),
                    osgSkin::importSkeleton(OSGSKIN_DATA "/pedestrian.bvh"));
}

INSTANTIATE_TEST_SUITE_P(Files, LiveCmu,
                         testing::Values("mb/01_01.bvh", "mb/12_01_walk_pybvh.bvh", "daz/02_05.bvh",
                                         "max/131_01.bvh"),
                         [](const auto& file) {
                             std::string name = file.param;
                             std::replace_if(
                                 name.begin(), name.end(), [](char c) { return !std::isalnum(c); },
                                 '_');
                             return name;
                         });

TEST(LiveRetarget, RotatesIntoTheRigsSpace) {
    const Motion motion = osgSkin::importMotion(OSGSKIN_DATA "/throw.bvh");
    RestSkeleton rig = osgSkin::importSkeleton(OSGSKIN_DATA "/thrower.bvh");
    const glm::dquat lying = turnDegrees(90.0, {1, 0, 0}); // z up
    for (osgSkin::RestJoint& joint : rig.joints) {
        joint.centre = lying * joint.centre;
        if (joint.tip) joint.tip = lying * *joint.tip;
    }
    osgSkin::RetargetReport report;
    LiveRetarget live(motion.skeleton, rig, {}, &report);
    EXPECT_LT(angleBetween(report.rotation, lying), 1e-6);
    EXPECT_LT(compareWithWhole(live, motion, rig).rotation, 1e-6);
}

TEST(LiveRetarget, ContinuesTheTwistOfAnElbow) {
    const RestSkeleton figure = makeFigure(0.0);
    RestSkeleton other = makeFigure(0.0, 1.1);
    other.joints[2].centre.z += 0.5; // another body: rotations are not copied
    Motion motion = standStill(figure, 110);
    for (std::size_t f = 0; f < motion.frames; ++f) // past 180 degrees, and back
        motion.rotations[f * figure.joints.size() + 5] =
            turnDegrees(f < 55 ? 4.0 * double(f) : 4.0 * double(110 - f), {1, 0, 0});
    LiveRetarget live(figure, other);
    EXPECT_LT(compareWithWhole(live, motion, other).rotation, 1e-6);
    // Without the poses before, 200 degrees are 160 to the other side.
    const std::size_t far = 50 * figure.joints.size();
    std::vector<JointSample> continued(other.joints.size()), alone(other.joints.size());
    const Motion rest = standStill(figure, 1);
    live.restart();
    for (std::size_t f = 0; f <= 50; ++f)
        live.apply(&motion.rotation(f, 0), rest.rootPositions[0], continued.data());
    live.restart();
    live.apply(&motion.rotations[far], rest.rootPositions[0], alone.data());
    EXPECT_GT(angleBetween(continued[4].rotation, alone[4].rotation), 60.0);
}

TEST(LiveRetarget, FindsStandingPoseInCalibration) {
    const Motion actor = osgSkin::importMotion(OSGSKIN_DATA "/throw.bvh");
    const RestSkeleton rig = osgSkin::importSkeleton(OSGSKIN_DATA "/thrower.bvh");
    const Motion folded = rebasedFrom(actor, ::folded(actor.skeleton.joints.size()));
    expectError([&] { LiveRetarget(folded.skeleton, rig); }, "does not stand");
    LiveRetarget live(folded, rig);
    EXPECT_LT(compareWithWhole(live, folded, rig).rotation, 1e-6);
}

TEST(LiveRetarget, RefusesUnusablePoses) {
    const RestSkeleton figure = makeFigure(0.0);
    LiveRetarget live(figure, figure);
    Motion motion = standStill(figure, 1);
    std::vector<JointSample> joints(figure.joints.size());
    const auto isTaken = [&] {
        return live.apply(motion.rotations.data(), motion.rootPositions[0], joints.data());
    };
    EXPECT_TRUE(isTaken());
    motion.rotations[3] = {2, 0, 0, 0};
    EXPECT_FALSE(isTaken());
    motion.rotations[3] = {std::nan(""), 0, 0, 0};
    EXPECT_FALSE(isTaken());
    motion.rotations[3] = {1, 0, 0, 0};
    motion.rootPositions[0].y = std::numeric_limits<double>::infinity();
    EXPECT_FALSE(isTaken());
    expectError([&] { LiveRetarget(RestSkeleton(), figure); }, "skeleton: no joint");
}
