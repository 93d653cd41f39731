// SPDX-License-Identifier: MIT
// Bodies that face other directions than the actor, in spaces with other up axes.
#include "Figure.h"
#include "Paths.h"

#include <osgSkin/GlmOsg>
#include <osgSkinImport/ImportMotion>
#include <osgSkinImport/ImportSkeleton>
#include <osgSkinMotion/Prop>
#include <osgSkinRig/JointRoles>
#include <osgSkinRig/Retarget>

#include <algorithm>
#include <utility>

namespace {

using osgSkin::Clip;
using osgSkin::Motion;
using osgSkin::RestSkeleton;
using osgSkin::RetargetReport;

RestSkeleton turned(RestSkeleton skeleton, const glm::dquat& turn) {
    for (osgSkin::RestJoint& joint : skeleton.joints) {
        joint.centre = turn * joint.centre;
        if (joint.tip) joint.tip = turn * *joint.tip;
    }
    return skeleton;
}

Motion turned(Motion motion, const glm::dquat& turn) {
    motion.skeleton = turned(motion.skeleton, turn);
    for (glm::dquat& q : motion.rotations) q = turn * q * glm::conjugate(turn);
    for (glm::dvec3& place : motion.rootPositions) place = turn * place;
    return motion;
}

enum class Seat { Chair, Floor };

/// The same body on a chair, thighs level and shins upright, or with straight legs on the floor.
RestSkeleton seated(RestSkeleton skeleton, double degrees, Seat seat = Seat::Chair) {
    const RestSkeleton standing = skeleton;
    std::vector<glm::dquat> turns;
    for (std::size_t j = 0; j < skeleton.joints.size(); ++j) {
        const osgSkin::RestJoint& from = standing.joints[j];
        osgSkin::RestJoint& to = skeleton.joints[j];
        const auto p = static_cast<std::size_t>(std::max(from.parent, 0));
        glm::dquat turn = from.parent < 0 ? glm::dquat(1, 0, 0, 0) : turns[p];
        if (from.parent >= 0)
            to.centre =
                skeleton.joints[p].centre + turn * (from.centre - standing.joints[p].centre);
        if (from.name.find("UpLeg") != std::string::npos)
            turn = turn * turnDegrees(-degrees, {1, 0, 0});
        if (seat == Seat::Chair && (from.name == "LeftLeg" || from.name == "RightLeg"))
            turn = turn * turnDegrees(degrees, {1, 0, 0});
        if (to.tip) to.tip = to.centre + turn * (*from.tip - from.centre);
        turns.push_back(turn);
    }
    return skeleton;
}

struct Turn {
    const char* name;
    glm::dquat turn;
};

const glm::dvec3 kUp(0, 1, 0);
const glm::dquat kZUp = turnDegrees(90, {1, 0, 0}); ///< y up, facing +z -> z up, facing -y

const Turn kTurns[] = {
    {"by90", turnDegrees(90, kUp)},
    {"by180", turnDegrees(180, kUp)},
    {"byMinus90", turnDegrees(-90, kUp)},
    {"by37", turnDegrees(37, kUp)},
    {"byMinus152", turnDegrees(-152, kUp)},
    {"by3", turnDegrees(3, kUp)},
    {"zUp", kZUp},
    {"zUpBy90", turnDegrees(90, {0, 0, 1}) * kZUp},
    {"zUpBy37", turnDegrees(37, {0, 0, 1}) * kZUp},
    {"xUp", turnDegrees(-90, {0, 0, 1})},
    {"yDown", turnDegrees(180, {0, 0, 1})},
    {"zDownBy37", turnDegrees(37, {0, 0, 1}) * turnDegrees(-90, {1, 0, 0})},
};

class UprightFrames : public testing::TestWithParam<Turn> {
protected:
    void SetUp() override {
        rig = osgSkin::importSkeleton(OSGSKIN_DATA "/thrower.bvh");
        motion = osgSkin::importMotion(OSGSKIN_DATA "/throw.bvh");
        straight = osgSkin::retarget(motion, rig, {}, &straightReport);
    }

    const glm::dquat& turn() const { return GetParam().turn; }

    /// Expects `clip` to be the unrotated body's motion, rotated, except for rounding.
    void expectTurned(const Clip& clip, const RestSkeleton& turnedRig, const glm::dquat& by) const {
        for (std::size_t f = 0; f < clip.frames; f += 9) {
            const Placed ours = place(clip, turnedRig, f), theirs = place(straight, rig, f);
            for (std::size_t j = 0; j < rig.joints.size(); ++j)
                ASSERT_LT(glm::length(ours.places[j] - by * theirs.places[j]), 1e-6)
                    << rig.joints[j].name << ", frame " << f;
        }
    }

    RestSkeleton rig;
    Motion motion;
    Clip straight;
    RetargetReport straightReport, report;
};

TEST_P(UprightFrames, RotatedBodyMovesAlike) {
    const RestSkeleton body = turned(rig, turn());
    const Clip clip = osgSkin::retarget(motion, body, {}, &report);
    expectTurned(clip, body, turn());
    EXPECT_LT(angleBetween(report.rotation, turn()), 1e-5);
    EXPECT_NEAR(report.scale, straightReport.scale, 1e-9);
    ASSERT_EQ(report.feet.size(), 2u);
    for (std::size_t i = 0; i < 2; ++i) {
        EXPECT_EQ(report.feet[i].rigJoint, straightReport.feet[i].rigJoint);
        EXPECT_EQ(report.feet[i].contacts, straightReport.feet[i].contacts);
        EXPECT_NEAR(report.feet[i].worst, straightReport.feet[i].worst, 1e-6);
    }
}

TEST_P(UprightFrames, RotatedActorIsRotatedBack) {
    const Clip clip = osgSkin::retarget(turned(motion, turn()), rig, {}, &report);
    expectTurned(clip, rig, {1, 0, 0, 0});
    EXPECT_LT(angleBetween(report.rotation, glm::conjugate(turn())), 1e-5);
}

/// Thighs that begin at one point, except for rounding: the shoulders decide, in any unit.
TEST(UprightBodies, CoincidentHipsGiveNoFacing) {
    const Motion motion = osgSkin::importMotion(OSGSKIN_DATA "/throw.bvh");
    for (const double unit : {0.01, 1.0, 100.0}) {
        RestSkeleton body = osgSkin::importSkeleton(OSGSKIN_DATA "/thrower.bvh");
        for (osgSkin::RestJoint& joint : body.joints) {
            joint.centre *= unit;
            if (joint.tip) *joint.tip *= unit;
        }
        osgSkin::RestJoint& left = body.joints[std::size_t(body.find("LeftUpLeg"))];
        osgSkin::RestJoint& right = body.joints[std::size_t(body.find("RightUpLeg"))];
        left.centre = 0.5 * (left.centre + right.centre);
        right.centre = left.centre + glm::dvec3(0.0, 0.0, 1e-4 * glm::length(left.centre));
        RetargetReport report;
        osgSkin::retarget(motion, body, {}, &report);
        EXPECT_LT(angleBetween(report.rotation, {1, 0, 0, 0}), 1e-5) << unit;
    }
}

/// A driver's body gets up and throws: its bones equal those of the standing body.
TEST_P(UprightFrames, SittingBodyMovesAlike) {
    // For a body on the floor that is also laid down, nothing determines which axis is up.
    const bool isTilted = (turn() * glm::dvec3(0, 1, 0)).y < 0.5;
    for (const auto& [seat, degrees] :
         {std::pair(Seat::Chair, 50.0), std::pair(Seat::Chair, 85.0), std::pair(Seat::Chair, 100.0),
          std::pair(Seat::Floor, 85.0)}) {
        if (seat == Seat::Floor && isTilted) continue;
        SCOPED_TRACE(degrees);
        const RestSkeleton body = turned(seated(rig, degrees, seat), turn());
        const Clip clip = osgSkin::retarget(motion, body, {}, &report);
        // Its steps are as long; feet on the floor do not determine the height of the ankles.
        EXPECT_NEAR(report.scale, straightReport.scale, seat == Seat::Floor ? 0.07 : 0.03);
        for (std::size_t f = 0; f < clip.frames; f += 30) {
            const Placed ours = place(clip, body, f), theirs = place(straight, rig, f);
            for (std::size_t j = 0; j < rig.joints.size(); ++j)
                ASSERT_LT(glm::length(ours.places[j] - ours.places[0] -
                                      turn() * (theirs.places[j] - theirs.places[0])),
                          0.05)
                    << rig.joints[j].name << ", frame " << f;
        }
    }
}

/// A ball stays in the hand.
TEST_P(UprightFrames, RotatesProps) {
    const RestSkeleton body = turned(rig, turn());
    osgSkin::retarget(motion, body, {}, &report);
    Motion way = standStill(RestSkeleton{{{"ball", -1, {0, 0, 0}, {}}}}, 1);
    way.rootPositions[0] = {0.3, 1.2, 0.4};
    const osg::ref_ptr<osgAnimation::Animation> animation = new osgAnimation::Animation;
    const auto inSpace = [&](const RetargetReport& by) {
        const auto node = osgSkin::makeProp("prop", {}, way, by, *animation);
        return osgSkin::toGlm(osg::Vec3d(node->getMatrix().getTrans()));
    };
    EXPECT_LT(glm::length(inSpace(report) - turn() * inSpace(straightReport)), 1e-6);
}

/// Transformed like the actor: scaled, rotated, and moved.
TEST(Props, FollowTheActor) {
    osgSkin::RetargetReport report;
    report.scale = 2.0;
    report.rotation = turnDegrees(90.0, {0, 0, 1});
    report.offset = {10, 20, 30};
    Motion way = standStill(RestSkeleton{{{"ball", -1, {0, 0, 0}, {}}}}, 1);
    way.rootPositions[0] = {0.3, 1.2, 0.4};
    const osg::ref_ptr<osgAnimation::Animation> animation = new osgAnimation::Animation;
    const auto node = osgSkin::makeProp("prop", {}, way, report, *animation);
    const glm::dvec3 place = osgSkin::toGlm(osg::Vec3d(node->getMatrix().getTrans()));
    EXPECT_LT(glm::length(place - glm::dvec3(10 - 2.4, 20 + 0.6, 30 + 0.8)), 1e-6);
}

INSTANTIATE_TEST_SUITE_P(Turns, UprightFrames, testing::ValuesIn(kTurns),
                         [](const auto& tested) { return std::string(tested.param.name); });

struct ExpectedBone {
    const char* from;
    const char* to;
};

/// The limit: limbs within a degree of the rotated actor's own, left ones left.
TEST(UprightActors, LimbsMatchTheRotatedActor) {
    const std::string rigPath = sharedData("makehuman/rig/cmu_mb_neutral.bvh");
    OSGSKIN_NEEDS(rigPath);
    const RestSkeleton rig = osgSkin::importSkeleton(rigPath);
    for (const char* file :
         {"12_01_walk_pybvh.bvh", "01_01.bvh", "124_01_pitch_excerpt_120hz.bvh"}) {
        const std::string path = sharedData(std::string("cmu/mb/") + file);
        if (!std::filesystem::exists(path)) continue;
        const Motion motion = osgSkin::importMotion(path, 1);
        for (const double degrees : {90.0, 180.0, 37.0}) {
            const glm::dquat turn = turnDegrees(degrees, kUp);
            const RestSkeleton body = turned(rig, turn);
            const Clip clip = osgSkin::retarget(motion, body);
            double worst = 0.0;
            for (std::size_t f = 0; f < clip.frames; f += 50) {
                const Placed ours = place(clip, body, f), theirs = place(motion, f);
                for (const std::string side : {"Left", "Right"})
                    for (const ExpectedBone& bone :
                         {ExpectedBone{"Arm", "ForeArm"}, ExpectedBone{"ForeArm", "Hand"},
                          ExpectedBone{"UpLeg", "Leg"}, ExpectedBone{"Leg", "Foot"}}) {
                        const auto way = [&](const Placed& placed, const RestSkeleton& skeleton) {
                            const auto at = [&](const char* end) {
                                return placed.places.at(std::size_t(skeleton.find(side + end)));
                            };
                            return at(bone.to) - at(bone.from);
                        };
                        worst = std::max(worst, angleBetween(way(ours, body),
                                                             turn * way(theirs, motion.skeleton)));
                    }
            }
            EXPECT_LT(worst, 1.0) << file << ", turned by " << degrees;
        }
    }
}

/// Joints with meaningless names, on a body that its shape identifies.
TEST(UprightStrangers, AreRecognisedByShape) {
    Motion motion = osgSkin::importMotion(OSGSKIN_DATA "/throw.bvh");
    for (std::size_t j = 0; j < motion.skeleton.joints.size(); ++j)
        motion.skeleton.joints[j].name = "part" + std::to_string(j);
    RetargetReport report;
    osgSkin::retarget(motion, turned(motion.skeleton, turnDegrees(90, kUp)), {}, &report);
    EXPECT_EQ(report.rigNames, osgSkin::kInferredFromGeometry);
    EXPECT_LT(angleBetween(report.rotation, turnDegrees(90, kUp)), 1e-5);
}

/// Nothing relates two bodies if neither their joints' names nor their shapes are known.
TEST(UprightStrangers, EqualNamesMapDirectly) {
    RestSkeleton figure = makeFigure(0.0); // one side only
    for (std::size_t j = 0; j < figure.joints.size(); ++j)
        figure.joints[j].name = "part" + std::to_string(j);
    RetargetReport report;
    osgSkin::retarget(standStill(figure, 2), turned(figure, turnDegrees(90, kUp)), {}, &report);
    EXPECT_TRUE(report.rigNames.empty());
    EXPECT_LT(angleBetween(report.rotation, {1, 0, 0, 0}), 1e-9);
}

/// The names of one skeleton suffice for both, with the caller's map.
TEST(UprightStrangers, FollowTheNameMap) {
    const RestSkeleton rig = osgSkin::importSkeleton(OSGSKIN_DATA "/thrower.bvh");
    const Motion motion = osgSkin::importMotion(OSGSKIN_DATA "/throw.bvh");
    RestSkeleton body = turned(rig, turnDegrees(90, kUp));
    osgSkin::RetargetOptions options;
    for (std::size_t j = 0; j < body.joints.size(); ++j) {
        body.joints[j].name = "part" + std::to_string(j);
        options.joints[body.joints[j].name] = rig.joints[j].name;
    }
    RetargetReport report;
    osgSkin::retarget(motion, body, options, &report);
    EXPECT_LT(angleBetween(report.rotation, turnDegrees(90, kUp)), 1e-5);
    EXPECT_NE(report.text().find("rotated by 90 degrees about 0 1 0"), std::string::npos)
        << report.text();
}

} // namespace
