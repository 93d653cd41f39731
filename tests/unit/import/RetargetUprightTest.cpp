// SPDX-License-Identifier: MIT
//
// Bodies that face other directions than the actor, in spaces with other up axes.
//
// Motions of one family of names on bodies of another: arms and legs must point where the actor's
// do.
#include "Figure.h"
#include "JointIndex.h"
#include "Paths.h"

#include <osgSkin/GlmOsg>
#include <osgSkinImport/ImportMotion>
#include <osgSkinImport/ImportSkeleton>
#include <osgSkinRig/JointNames>
#include <osgSkinRig/JointRoles>
#include <osgSkinRig/Prop>
#include <osgSkinRig/Retarget>

#include <algorithm>
#include <array>
#include <map>
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

TEST_P(UprightFrames, ATurnedBodyDoesTheSameTurned) {
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

TEST_P(UprightFrames, ATurnedActorIsTurnedBack) {
    const Clip clip = osgSkin::retarget(turned(motion, turn()), rig, {}, &report);
    expectTurned(clip, rig, {1, 0, 0, 0});
    EXPECT_LT(angleBetween(report.rotation, glm::conjugate(turn())), 1e-5);
}

/// Thighs that begin at one point, except for rounding: the shoulders decide, in any unit.
TEST(UprightBodies, HipsInOnePointDoNotTellWhereItFaces) {
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
TEST_P(UprightFrames, ABodyThatSitsAtRestDoesTheSame) {
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
TEST_P(UprightFrames, PropsTurnToo) {
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
TEST(Props, ArePutWhereTheActorIs) {
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
TEST(UprightActors, LimbsAreWhereTheTurnedActorsAre) {
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
TEST(UprightStrangers, IsToldByTheShape) {
    Motion motion = osgSkin::importMotion(OSGSKIN_DATA "/throw.bvh");
    for (std::size_t j = 0; j < motion.skeleton.joints.size(); ++j)
        motion.skeleton.joints[j].name = "part" + std::to_string(j);
    RetargetReport report;
    osgSkin::retarget(motion, turned(motion.skeleton, turnDegrees(90, kUp)), {}, &report);
    EXPECT_EQ(report.rigNames, osgSkin::kInferredFromGeometry);
    EXPECT_LT(angleBetween(report.rotation, turnDegrees(90, kUp)), 1e-5);
}

/// Nothing relates two bodies if neither their joints' names nor their shapes are known.
TEST(UprightStrangers, IsTakenToBeTheSame) {
    RestSkeleton figure = makeFigure(0.0); // one side only
    for (std::size_t j = 0; j < figure.joints.size(); ++j)
        figure.joints[j].name = "part" + std::to_string(j);
    RetargetReport report;
    osgSkin::retarget(standStill(figure, 2), turned(figure, turnDegrees(90, kUp)), {}, &report);
    EXPECT_TRUE(report.rigNames.empty());
    EXPECT_LT(angleBetween(report.rotation, {1, 0, 0, 0}), 1e-9);
}

/// The names of one skeleton suffice for both, with the caller's map.
TEST(UprightStrangers, FollowsTheMapToKnownNames) {
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

using osgSkin::Clip;
using osgSkin::Motion;
using osgSkin::RestSkeleton;
using osgSkin::RetargetOptions;
using osgSkin::RetargetReport;

/// The joints of the left arm and leg, shoulder to wrist and hip to ankle; for the right ones
/// replace `left` by `right`.
struct Limbs {
    const char* arm[3];
    const char* leg[3];
    const char* left;
    const char* right;
};

const Limbs kMotionBuilder{
    {"LeftArm", "LeftForeArm", "LeftHand"}, {"LeftUpLeg", "LeftLeg", "LeftFoot"}, "Left", "Right"};
const Limbs kMax{{"LeftShoulder", "LeftElbow", "LeftWrist"},
                 {"LeftHip", "LeftKnee", "LeftAnkle"},
                 "Left",
                 "Right"};
const Limbs kDaz{{"lShldr", "lForeArm", "lHand"}, {"lThigh", "lShin", "lFoot"}, "l", "r"};
const Limbs kUnreal{
    {"upperarm_l", "lowerarm_l", "hand_l"}, {"thigh_l", "calf_l", "foot_l"}, "_l", "_r"};
const Limbs kMixamo{{"mixamorig:LeftArm", "mixamorig:LeftForeArm", "mixamorig:LeftHand"},
                    {"mixamorig:LeftUpLeg", "mixamorig:LeftLeg", "mixamorig:LeftFoot"},
                    "Left",
                    "Right"};
const Limbs kVrm{{"J_Bip_L_UpperArm", "J_Bip_L_LowerArm", "J_Bip_L_Hand"},
                 {"J_Bip_L_UpperLeg", "J_Bip_L_LowerLeg", "J_Bip_L_Foot"},
                 "_L_",
                 "_R_"};
const Limbs kUnity{{"leftUpperArm", "leftLowerArm", "leftHand"},
                   {"leftUpperLeg", "leftLowerLeg", "leftFoot"},
                   "left",
                   "right"};
const Limbs kMakeHuman{{"upperarm01.L", "lowerarm01.L", "wrist.L"},
                       {"upperleg01.L", "lowerleg01.L", "foot.L"},
                       ".L",
                       ".R"};
const Limbs kBiped{{"Bip01 L UpperArm", "Bip01 L Forearm", "Bip01 L Hand"},
                   {"Bip01 L Thigh", "Bip01 L Calf", "Bip01 L Foot"},
                   " L ",
                   " R "};

std::string onSide(const std::string& name, const Limbs& limbs, bool right) {
    std::string result = name;
    if (!right) return result;
    const std::size_t at = result.find(limbs.left);
    return result.replace(at, std::string(limbs.left).size(), limbs.right);
}

/// Largest angle between a limb of the rig and the actor's, in degrees.
double worstLimb(const Clip& clip, const RestSkeleton& rig, const Limbs& rigLimbs,
                 const Motion& motion, const Limbs& motionLimbs) {
    double worst = 0.0;
    const std::size_t step = std::max<std::size_t>(1, clip.frames / 60);
    for (std::size_t f = 0; f < clip.frames; f += step) {
        const Placed ours = place(clip, rig, f);
        const Placed theirs = place(motion, f);
        for (const bool right : {false, true})
            for (const bool leg : {false, true})
                for (int bone = 0; bone < 2; ++bone) {
                    const auto way = [&](const Placed& placed, const RestSkeleton& skeleton,
                                         const Limbs& limbs) {
                        const char* const* names = leg ? limbs.leg : limbs.arm;
                        return placed.places[jointIndex(skeleton,
                                                        onSide(names[bone + 1], limbs, right))] -
                               placed
                                   .places[jointIndex(skeleton, onSide(names[bone], limbs, right))];
                    };
                    worst =
                        std::max(worst, angleBetween(way(ours, rig, rigLimbs),
                                                     way(theirs, motion.skeleton, motionLimbs)));
                }
    }
    return worst;
}

struct File {
    const char* path; ///< below the shared data, or absolute
    const Limbs* limbs;
    const char* family;
};

const File kMotions[] = {
    {"cmu/mb/01_01.bvh", &kMotionBuilder, "CMU (MotionBuilder)"},
    {"cmu/mb/01_03.bvh", &kMotionBuilder, "CMU (MotionBuilder)"},
    {"cmu/mb/12_01_walk_pybvh.bvh", &kMotionBuilder, "CMU (MotionBuilder)"},
    {"cmu/mb/124_01_pitch_excerpt_120hz.bvh", &kMotionBuilder, "CMU (MotionBuilder)"},
    {"cmu/max/131_01.bvh", &kMax, "CMU (3ds Max)"},
    {"cmu/daz/02_05.bvh", &kDaz, "CMU (DAZ)"},
    {"cmu/daz/05_06.bvh", &kDaz, "CMU (DAZ)"},
    {"cmu/daz/06_15.bvh", &kDaz, "CMU (DAZ)"},
    {"cmu/daz/07_01.bvh", &kDaz, "CMU (DAZ)"},
    {"cmu/daz/09_01.bvh", &kDaz, "CMU (DAZ)"},
    {"cmu/daz/13_30.bvh", &kDaz, "CMU (DAZ)"},
    {"/usr/share/assimp/models/BVH/01_01.bvh", &kMotionBuilder, "CMU (MotionBuilder)"},
    {"/usr/share/assimp/models/BVH/01_03.bvh", &kMotionBuilder, "CMU (MotionBuilder)"},
    {"/usr/share/assimp/models/BVH/Boxing_Toes.bvh", &kMax, "Biovision"},
};

const File kRigs[] = {
    {"makehuman/rig/cmu_mb_neutral.bvh", &kMotionBuilder, "CMU (MotionBuilder)"},
    {"makehuman/rig/cmu_mb_male.bvh", &kMotionBuilder, "CMU (MotionBuilder)"},
    {"makehuman/rig/game_engine_neutral.bvh", &kUnreal, "Unreal"},
    {OSGSKIN_DATA "/thrower.bvh", &kMotionBuilder, "CMU (MotionBuilder)"},
};

std::string pathOf(const File& file) {
    return file.path[0] == '/' ? file.path : sharedData(file.path);
}

class EveryMotion : public testing::TestWithParam<File> {};

/// The thrower with its joints renamed, part by part, to another family's names.
RestSkeleton renamed(const RestSkeleton& thrower, const std::string& family,
                     const std::string& prefix = {}) {
    const auto& known = osgSkin::knownJointNames();
    const auto named = [&](const std::string& name) {
        return *std::find_if(known.begin(), known.end(),
                             [&](const osgSkin::JointNames& names) { return names.name == name; });
    };
    const osgSkin::JointNames from = named("CMU (MotionBuilder)"), to = named(family);
    RestSkeleton result = thrower;
    for (osgSkin::RestJoint& joint : result.joints) {
        for (const auto& [role, members] : from.roles) {
            const auto member = std::find(members.begin(), members.end(), joint.name);
            const auto theirs = to.roles.find(role);
            if (member == members.end()) continue;
            const auto at = std::size_t(member - members.begin());
            joint.name = theirs != to.roles.end() && at < theirs->second.size()
                             ? prefix + theirs->second[at]
                             : "unknown " + joint.name;
            break;
        }
    }
    return result;
}

} // namespace

TEST_P(EveryMotion, PlaysOnEveryBodyWithoutSettings) {
    const std::string path = pathOf(GetParam());
    OSGSKIN_NEEDS(path);
    const Motion motion = osgSkin::importMotion(path);
    for (const File& body : kRigs) {
        if (!std::filesystem::exists(pathOf(body))) continue;
        SCOPED_TRACE(body.path);
        const RestSkeleton rig = osgSkin::importSkeleton(pathOf(body));
        RetargetReport report;
        const Clip clip = osgSkin::retarget(motion, rig, {}, &report);
        EXPECT_EQ(report.motionNames, GetParam().family);
        EXPECT_EQ(report.rigNames, body.family);
        EXPECT_LT(worstLimb(clip, rig, *body.limbs, motion, *GetParam().limbs), 1.0);
        for (const RetargetReport::Entry& entry : report.entries)
            if (entry.rigJoint == "Head" || entry.rigJoint == "head") {
                EXPECT_EQ(std::string(entry.motionJoint).substr(1), "ead");
            }
    }
}

INSTANTIATE_TEST_SUITE_P(Files, EveryMotion, testing::ValuesIn(kMotions), [](const auto& tested) {
    std::string name = std::filesystem::path(tested.param.path).stem().string();
    if (tested.param.path[0] == '/') name = "assimp_" + name;
    for (char& c : name)
        if (std::isalnum(static_cast<unsigned char>(c)) == 0) c = '_';
    return name;
});

TEST(JointNames, EveryFamilyIsToldByItsOwnNames) {
    const RestSkeleton thrower = osgSkin::importSkeleton(OSGSKIN_DATA "/thrower.bvh");
    const Motion motion = osgSkin::importMotion(OSGSKIN_DATA "/throw.bvh");
    const struct {
        const char* family;
        const char* prefix;
        const Limbs* limbs;
    } cases[] = {
        {"CMU (3ds Max)", "", &kMax}, {"CMU (DAZ)", "", &kDaz}, {"Mixamo", "mixamorig:", &kMixamo},
        {"Unreal", "", &kUnreal},     {"VRM", "", &kVrm},       {"MakeHuman", "", &kMakeHuman}};
    for (const auto& c : cases) {
        SCOPED_TRACE(c.family);
        const RestSkeleton rig = renamed(thrower, c.family, c.prefix);
        RetargetReport report;
        const Clip clip = osgSkin::retarget(motion, rig, {}, &report);
        EXPECT_EQ(report.rigNames, c.family);
        EXPECT_LT(worstLimb(clip, rig, *c.limbs, motion, kMotionBuilder), 1.0);
    }
}

TEST(JointNames, CapitalsAndBlanksDoNotMatter) {
    RestSkeleton thrower = osgSkin::importSkeleton(OSGSKIN_DATA "/thrower.bvh");
    const Motion motion = osgSkin::importMotion(OSGSKIN_DATA "/throw.bvh");
    RestSkeleton unity = renamed(thrower, "Unity humanoid");
    for (osgSkin::RestJoint& joint : unity.joints)
        if (joint.name[0] == 'L' || joint.name[0] == 'R')
            joint.name[0] = static_cast<char>(joint.name[0] + 'a' - 'A');
    RetargetReport report;
    const Clip clip = osgSkin::retarget(motion, unity, {}, &report);
    EXPECT_EQ(report.rigNames, "Unity humanoid");
    EXPECT_LT(worstLimb(clip, unity, kUnity, motion, kMotionBuilder), 1.0);

    RestSkeleton biped = renamed(thrower, "Biped");
    for (osgSkin::RestJoint& joint : biped.joints)
        for (const char side : {'L', 'R'}) {
            const std::string mark = std::string("Bip01") + side;
            if (joint.name.compare(0, mark.size(), mark) == 0)
                joint.name = std::string("Bip01 ") + side + " " + joint.name.substr(mark.size());
        }
    const Clip bipedClip = osgSkin::retarget(motion, biped, {}, &report);
    EXPECT_EQ(report.rigNames, "Biped");
    EXPECT_LT(worstLimb(bipedClip, biped, kBiped, motion, kMotionBuilder), 1.0);
}

TEST(JointNames, TheCallerMayAddAFamily) {
    RestSkeleton rig = osgSkin::importSkeleton(OSGSKIN_DATA "/thrower.bvh");
    const Motion motion = osgSkin::importMotion(OSGSKIN_DATA "/throw.bvh");
    const std::map<std::string, std::string> robot{
        {"Hips", "base"},         {"LeftArm", "servo1"},   {"LeftForeArm", "servo2"},
        {"LeftHand", "servo3"},   {"RightArm", "servo4"},  {"RightForeArm", "servo5"},
        {"RightHand", "servo6"},  {"LeftUpLeg", "servo7"}, {"LeftLeg", "servo8"},
        {"RightUpLeg", "servo9"}, {"RightLeg", "servo10"}, {"LeftFoot", "servo11"},
        {"RightFoot", "servo12"}};
    for (osgSkin::RestJoint& joint : rig.joints)
        joint.name = robot.count(joint.name) != 0 ? robot.at(joint.name) : "part " + joint.name;
    RetargetReport shape; // with meaningless names, which the skeleton's shape replaces
    osgSkin::retarget(motion, rig, {}, &shape);
    EXPECT_EQ(shape.rigNames, osgSkin::kInferredFromGeometry);

    RetargetOptions options;
    options.names.push_back({"robot",
                             {{"Hips", {"base"}},
                              {"LeftUpperArm", {"servo1"}},
                              {"LeftLowerArm", {"servo2"}},
                              {"LeftHand", {"servo3"}},
                              {"RightUpperArm", {"servo4"}},
                              {"RightLowerArm", {"servo5"}},
                              {"LeftUpperLeg", {"servo7"}},
                              {"LeftLowerLeg", {"servo8"}}}});
    RetargetReport report;
    osgSkin::retarget(motion, rig, options, &report);
    EXPECT_EQ(report.rigNames, "robot");
    EXPECT_NE(report.text().find("joint servo5: RightForeArm, aligned"), std::string::npos);
    EXPECT_NE(report.text().find("joint servo6: at rest"), std::string::npos);
    EXPECT_NE(report.text().find("not used: RightHand"), std::string::npos);
    for (const RetargetReport::Entry& entry : report.entries)
        if (entry.rigJoint == "servo5") {
            EXPECT_EQ(entry.motionJoint, "RightForeArm");
        }
}
