// SPDX-License-Identifier: MIT
// Every exporter's spelling of a body's joints, and names that are not joints of the body.
#include "JointSpellings.h"

#include <osgSkinRig/JointRoles>

#include <gtest/gtest.h>

#include <string>
#include <utility>

using namespace osgSkin;

namespace {

struct Bone {
    const char* role;
    int parent;
};

/// A body's main joints, parents first.
const Bone kBody[] = {
    {"Hips", -1},         {"Spine", 0},          {"Neck", 1},          {"Head", 2},
    {"LeftCollar", 1},    {"LeftUpperArm", 4},   {"LeftLowerArm", 5},  {"LeftHand", 6},
    {"RightCollar", 1},   {"RightUpperArm", 8},  {"RightLowerArm", 9}, {"RightHand", 10},
    {"LeftUpperLeg", 0},  {"LeftLowerLeg", 12},  {"LeftFoot", 13},     {"LeftToe", 14},
    {"RightUpperLeg", 0}, {"RightLowerLeg", 16}, {"RightFoot", 17},    {"RightToe", 18}};

RestSkeleton spelledBody(const test::Dialect& dialect, const test::SideStyle& side,
                         const std::string& prefix, const std::string& suffix) {
    RestSkeleton body;
    for (const Bone& bone : kBody)
        body.add(test::spelled(dialect, bone.role, side, prefix, suffix, body.joints.size()),
                 bone.parent, glm::dvec3(0.0)); // no shape to recognise
    return body;
}

/// Names of the joints with a wrong role.
std::string wrong(const RestSkeleton& body) {
    const JointRoles roles = recogniseJoints(body);
    std::string result;
    for (std::size_t j = 0; j < std::size(kBody); ++j)
        if (roles.roles[j] != kBody[j].role)
            result +=
                body.joints[j].name + " is \"" + roles.roles[j] + "\", not " + kBody[j].role + "; ";
    return result;
}

/// A single lower-case letter directly beside other lower-case letters is no side mark.
bool isLegible(const test::Dialect& dialect, const test::SideStyle& side, const std::string& prefix,
               const std::string& suffix) {
    if (!std::string(side.separator).empty()) return true;
    const std::string name = dialect.names.at("UpperLeg");
    const bool small = std::islower(static_cast<unsigned char>(side.left[0])) != 0;
    if (!side.before) return !small || suffix != "Bone";
    const char before = prefix.empty() ? ' ' : prefix.back();
    const bool word = std::string(side.left).size() > 1;
    return word || !small || !std::isalnum(static_cast<unsigned char>(before));
}

/// Accessories of bodies, and the controls of rigs.
// clang-format off
const char* const kOthers[] = {
    "Tail", "Tail1", "Tail_01", "tail.001", "TailBase", "TailEnd", "DEF-tail.003", "Wing_L",
    "Wing_R", "LeftWing", "RightWing1", "wing_upper_l", "wing_lower_r", "WingTip.L", "Weapon",
    "weapon_l", "weapon_r", "Weapon_R_Hand_Attach", "WeaponMount", "Sword", "sword_r", "SwordHilt",
    "Shield", "shield_l", "LeftShield", "Gun", "gun_muzzle", "Bow", "arrow_head", "Axe", "AxeBlade",
    "Staff", "Cloth", "cloth_01", "ClothFront", "ClothBack_L", "Skirt", "skirt_l_01",
    "SkirtFront.R", "Skirt_04", "Cape", "cape_01", "CapeEnd", "Coat_L", "CoatTail", "Robe_01",
    "Scarf", "scarf_02", "Belt", "Buckle", "Sleeve_L", "sleeve_r_02", "Hood", "Hat", "HatBrim",
    "Glove.L", "Shoe_L", "Boot.R", "upperarm_twist_01_l", "upperarm_twist_02_r",
    "lowerarm_twist_01_l", "lowerarm_twist_01_r", "thigh_twist_01_l", "calf_twist_01_r",
    "LeftArmTwist", "RightForeArmTwist", "LeftUpLegTwist1", "lThighTwist", "rShldrTwist",
    "lForearmTwist", "ForeTwist1_L", "Bip01LThighTwist", "LeftForeArmRoll", "RightArmRoll",
    "LeftLegRoll", "leg_roll_r", "forearm_roll.L", "hand_ik_l", "hand_ik_r", "foot_ik_l",
    "ik_foot_root", "ik_hand_root", "ik_hand_gun", "ik_hand_l", "ik_hand_r", "ik_foot_l",
    "ik_foot_r", "IK-foot.L", "kneeIK.l", "elbowIK.r", "LegIK_L", "ArmIK.R", "head_ik",
    "knee_pole_l", "elbow_pole.R", "PoleTarget.L", "pole_leg_l", "KneeTarget_L", "elbow_target_r",
    "hand_target", "foot_target.L", "LookAt", "aim_head", "HeadAim", "eye_target", "ctrl_hand_l",
    "hand_ctrl_r", "Foot_Control.L", "HeadControl", "master", "root_ctrl", "hips_ctrl",
    "chest_ctrl", "CTRL_Head", "fk_hand_l", "upper_arm_fk.L", "forearm_fk.R", "thigh_fk.L",
    "shin_fk.R", "MCH-hand.L", "MCH-upper_arm_ik.L", "MCH-foot_roll", "WGT-hand.L", "hand_tweak.L",
    "upper_arm_tweak.L.001", "thigh_tweak.R", "spine_fk", "head_tweak", "handslot.l", "handslot.r",
    "hand_attach_l", "attach_hand_l", "attach_foot_r", "HeadSocket", "socket_head", "socket_hand_r",
    "Prop_L", "prop1", "LeftHandProp", "hand_prop_r", "item_r", "holster_l", "Quiver", "Backpack",
    "backpack_attach", "mount_head", "camera", "CameraBone", "light_01", "muzzle", "Hair",
    "hair_01", "HairFront", "hair_l_02", "Ponytail", "ponytail_03", "Bangs.L", "braid_r_01",
    "Beard", "Moustache", "J_Sec_Hair1_01", "J_Sec_L_Bust1", "J_Sec_R_SkirtBack0_01", "Eye_L",
    "LeftEye", "RightEye", "eye.R", "EyeLid_L", "eyelid_upper_r", "Eyeball.L", "Brow_L",
    "eyebrow_r", "Jaw", "jaw_master", "Tongue", "tongue_02", "TeethUpper", "Lip_Upper", "lip.B.L",
    "Cheek.R", "Nose", "nostril_l", "Ear.L", "ear_r", "Forehead", "Temple.L", "chin", "HeadTop_End",
    "Head_end", "HeadNub", "Head_Nub", "LeftToe_End", "LeftHandIndex4_end", "Toe0Nub",
    "LeftFootNub", "hand_end_l", "FingerNub", "Breast_L", "breast.R", "pectoral_l", "Bust1.L",
    "lat_r", "Glute_L", "Buttcheek.R", "belly_01", "Pec_R", "trapezius_l", "deltoid_r", "bicep_l",
    "quad_r", "muscle_l", "scap_helper_l", "LeftHandle", "RightPalmRest", "handle_l", "footprint",
    "footstep_l", "headlight", "headphone_l", "armor_l", "Armor.R", "armrest_r", "legend_l",
    "charm_r", "alarm_l", "firearm", "warhead", "arrowhead", "bighead_l", "kneecap.L", "elbowpad_r",
    "kneepad_l", "shoulderpad_l", "ShoulderPad_R", "neckTie", "necklace", "chestplate",
    "ChestArmor", "spineguard", "waistband", "hipflask_l", "toering", "anklet_l", "handbag_r",
    "ringmaster", "thumbnail", "indexer", "middleman", "pinkyring_l", "ballgown", "football",
    "handball", "metacarpal1.L", "index_metacarpal_l", "palm.01.L", "lCarpal1", "lMetatarsals",
    "carpal_r", "tarsal_l", "Mesh", "Body", "Armature", "Camera01", "Light", "Lamp", "Cube",
    "Sphere001", "Plane", "Dummy01", "Null", "Group1", "locator1", "joint1", "bone_12", "Bone.007",
    "effector", "end_effector", "Reference", "Trajectory", "center_of_mass", "interaction",
    "heel_l", "heel.02.R", "Heel_Roll.L", "RootNode", "World", "scene", "geometry"};
// clang-format on

/// The body with another joint below the one that its name mentions, or below the spine.
RestSkeleton withOther(RestSkeleton body, const std::string& name) {
    static const std::pair<const char*, std::size_t> kOn[] = {
        {"hand", 7}, {"arm", 5}, {"foot", 14}, {"leg", 13}, {"head", 3}, {"hair", 3}};
    std::string lower = name;
    for (char& c : lower) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    std::size_t on = 1;
    for (const auto& [word, joint] : kOn)
        if (lower.find(word) != std::string::npos) on = joint;
    body.add(name, static_cast<int>(on), glm::dvec3(0.0));
    return body;
}

} // namespace

TEST(JointSpelling, RecognisesEverySpelling) {
    std::size_t bodies = 0, failed = 0;
    for (const test::Dialect& dialect : test::dialects())
        for (const test::SideStyle& side : test::sideStyles())
            for (const std::string& prefix : test::namePrefixes())
                for (const std::string& suffix : test::nameSuffixes()) {
                    if (!isLegible(dialect, side, prefix, suffix)) continue;
                    ++bodies;
                    const std::string what = wrong(spelledBody(dialect, side, prefix, suffix));
                    if (what.empty()) continue;
                    if (++failed <= 20)
                        ADD_FAILURE() << dialect.name << ", side " << side.text() << ", prefix '"
                                      << prefix << "', suffix '" << suffix << "': " << what;
                }
    EXPECT_EQ(failed, 0u);
    EXPECT_GT(bodies, 80000u);
    RecordProperty("bodies", static_cast<int>(bodies));
}

TEST(JointSpelling, KeepsInvalidEscapes) {
    const test::SideStyle before{"Left", "Right", true, ""};
    const test::Dialect& mixamo = test::dialects().front();
    for (const char* prefix :
         {"FBXASC:", "FBXASC9_mixamorig:", "FBXASC999FBXASCFBXASC058", "rig:FBXASC999:"})
        EXPECT_EQ(wrong(spelledBody(mixamo, before, prefix, "")), "") << prefix;
}

/// A figure's name runs into the side and the part without a separator.
TEST(JointSpelling, SideMayFollowWithoutSeparator) {
    RestSkeleton body =
        spelledBody(test::dialects().front(), {"left", "right", true, ""}, "neo", "");
    for (RestJoint& joint : body.joints)
        for (char& c : joint.name)
            c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    EXPECT_EQ(wrong(body), "");
}

TEST(JointSpelling, IgnoresOtherNames) {
    EXPECT_GE(std::size(kOthers), 200u);
    const test::SideStyle before{"Left", "Right", true, ""}, after{"L", "R", false, "."};
    for (const test::Dialect& dialect : test::dialects())
        for (const test::SideStyle& side : {before, after}) {
            const RestSkeleton body = spelledBody(dialect, side, "", "");
            RestSkeleton all = body;
            for (const char* other : kOthers) {
                SCOPED_TRACE(std::string(dialect.name) + ": " + other);
                const RestSkeleton more = withOther(body, other);
                EXPECT_EQ(wrong(more), "");
                const JointRoles roles = recogniseJoints(more);
                EXPECT_EQ(roles.roles.back(), "");
                EXPECT_EQ(roles.parts.back(), JointPart::Other);
                all = withOther(all, other);
            }
            EXPECT_EQ(wrong(all), "") << dialect.name;
            const JointRoles roles = recogniseJoints(all);
            for (std::size_t j = std::size(kBody); j < all.joints.size(); ++j) {
                EXPECT_EQ(roles.roles[j], "") << all.joints[j].name;
                EXPECT_EQ(roles.parts[j], JointPart::Other) << all.joints[j].name;
            }
        }
}

/// Nor does a single name, without others, belong to the body.
TEST(JointSpelling, OtherNamesAloneGiveNoRoles) {
    RestSkeleton skeleton;
    for (const char* other : kOthers)
        skeleton.add(other, static_cast<int>(skeleton.joints.size()) - 1, glm::dvec3(0.0));
    const JointRoles roles = recogniseJoints(skeleton);
    EXPECT_FALSE(roles.known());
    for (std::size_t j = 0; j < skeleton.joints.size(); ++j)
        EXPECT_EQ(roles.parts[j], JointPart::Other) << skeleton.joints[j].name;
}
