// SPDX-License-Identifier: MIT
// Motions of one family of names on bodies of another: arms and legs must point where the actor's
// do.
#include "Figure.h"
#include "JointIndex.h"
#include "Paths.h"

#include <osgSkinImport/ImportMotion>
#include <osgSkinImport/ImportSkeleton>
#include <osgSkinRig/JointNames>
#include <osgSkinRig/JointRoles>
#include <osgSkinRig/Retarget>

#include <algorithm>
#include <map>

namespace {

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

TEST_P(EveryMotion, PlaysOnEveryBody) {
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

TEST(JointNames, RecognisesEveryFamily) {
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

TEST(JointNames, IgnoreCaseAndBlanks) {
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

TEST(JointNames, CallerMayAddAFamily) {
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
