// SPDX-License-Identifier: MIT
// Complete skeletons with tools' own names: their peculiarities beyond spelling.
#include <osgSkinRig/JointRoles>

#include <gtest/gtest.h>

#include <map>
#include <sstream>
#include <string>

using namespace osgSkin;

namespace {

std::string withBlanks(std::string name) {
    for (char& c : name)
        if (c == '+') c = ' ';
    return name;
}

/// A skeleton from its names, each followed by its parent's: "Hips LeftLeg<Hips ...". "+" stands
/// for a space in a name.
RestSkeleton makeNamed(const std::string& joints) {
    RestSkeleton skeleton;
    std::istringstream words(joints);
    for (std::string word; words >> word;) {
        const std::size_t at = word.find('<');
        const int parent =
            at == std::string::npos ? -1 : skeleton.find(withBlanks(word.substr(at + 1)));
        skeleton.add(withBlanks(word.substr(0, at)), parent, glm::dvec3(0.0));
    }
    return skeleton;
}

/// Expands a list of joints with "@" for the side to both sides.
std::string bothSides(const std::string& joints, const std::string& left,
                      const std::string& right) {
    std::string result;
    std::istringstream words(joints);
    for (std::string word; words >> word;)
        for (const std::string& side : {left, right}) {
            std::string name = word;
            for (std::size_t at = name.find('@'); at != std::string::npos; at = name.find('@'))
                name.replace(at, 1, side);
            result += name + " ";
            if (name == word) break;
        }
    return result;
}

void expectRoles(const std::string& tool, const std::string& joints, const std::string& left,
                 const std::string& right, const std::map<std::string, std::string>& expected) {
    SCOPED_TRACE(tool);
    const std::string all = bothSides(joints, left, right);
    const RestSkeleton skeleton = makeNamed(all);
    skeleton.validate();
    const JointRoles roles = recogniseJoints(skeleton);
    for (const auto& [role, name] : expected)
        for (const bool isLeft : {true, false}) {
            const bool sided = name.find('@') != std::string::npos;
            std::string joint = withBlanks(name);
            if (sided) joint.replace(joint.find('@'), 1, isLeft ? left : right);
            const std::string key = (!sided ? "" : isLeft ? "Left" : "Right") + role;
            const auto found = roles.joints.find(key);
            ASSERT_NE(found, roles.joints.end()) << key;
            EXPECT_EQ(skeleton.joints[std::size_t(found->second[0])].name, joint) << key;
        }
}

} // namespace

TEST(NamedRigs, Rigify) {
    expectRoles("Rigify",
                "rig DEF-spine_01<rig DEF-spine.001_02<DEF-spine_01 "
                "DEF-spine.002_03<DEF-spine.001_02 DEF-spine.003_04<DEF-spine.002_03 "
                "DEF-spine.004_05<DEF-spine.003_04 DEF-spine.005_06<DEF-spine.004_05 "
                "DEF-spine.006_07<DEF-spine.005_06 DEF-shoulder.@_08<DEF-spine.003_04 "
                "DEF-upper_arm.@_09<DEF-shoulder.@_08 DEF-upper_arm.@.001_10<DEF-upper_arm.@_09 "
                "DEF-forearm.@_11<DEF-upper_arm.@.001_10 DEF-forearm.@.001_12<DEF-forearm.@_11 "
                "DEF-hand.@_13<DEF-forearm.@.001_12 DEF-f_index.01.@_14<DEF-hand.@_13 "
                "DEF-f_index.02.@_15<DEF-f_index.01.@_14 DEF-pelvis.@_16<DEF-spine_01 "
                "DEF-thigh.@_17<DEF-spine_01 DEF-thigh.@.001_18<DEF-thigh.@_17 "
                "DEF-shin.@_19<DEF-thigh.@.001_18 DEF-shin.@.001_20<DEF-shin.@_19 "
                "DEF-foot.@_21<DEF-shin.@.001_20 DEF-toe.@_22<DEF-foot.@_21 "
                "ORG-thigh.@_23<DEF-spine_01 ORG-shin.@_24<ORG-thigh.@_23 "
                "MCH-thigh_ik.@_25<DEF-spine_01 thigh_fk.@_26<rig hand_ik.@_27<rig head_28<rig",
                "L", "R",
                {{"Hips", "DEF-spine_01"},
                 {"Spine", "DEF-spine.001_02"},
                 {"Neck", "DEF-spine.004_05"},
                 {"Head", "DEF-spine.006_07"},
                 {"Collar", "DEF-shoulder.@_08"},
                 {"UpperArm", "DEF-upper_arm.@_09"},
                 {"LowerArm", "DEF-forearm.@_11"},
                 {"Hand", "DEF-hand.@_13"},
                 {"Index1", "DEF-f_index.01.@_14"},
                 {"Index2", "DEF-f_index.02.@_15"},
                 {"HipJoint", "DEF-pelvis.@_16"},
                 {"UpperLeg", "DEF-thigh.@_17"},
                 {"LowerLeg", "DEF-shin.@_19"},
                 {"Foot", "DEF-foot.@_21"},
                 {"Toe", "DEF-toe.@_22"}});
}

TEST(NamedRigs, LegsBelowPelvis) {
    expectRoles("Roblox",
                "HumanoidRootPart LowerTorso<HumanoidRootPart UpperTorso<LowerTorso "
                "Head<UpperTorso @UpperArm<UpperTorso @LowerArm<@UpperArm @Hand<@LowerArm "
                "@UpperLeg<LowerTorso @LowerLeg<@UpperLeg @Foot<@LowerLeg",
                "Left", "Right",
                {{"Hips", "LowerTorso"}, {"UpperLeg", "@UpperLeg"}, {"Hand", "@Hand"}});
    expectRoles("Kinect",
                "SpineBase SpineMid<SpineBase SpineShoulder<SpineMid Neck<SpineShoulder Head<Neck "
                "Shoulder@<SpineShoulder Elbow@<Shoulder@ Wrist@<Elbow@ Hand@<Wrist@ "
                "Hip@<SpineBase Knee@<Hip@ Ankle@<Knee@ Foot@<Ankle@",
                "Left", "Right",
                {{"Hips", "SpineBase"},
                 {"UpperArm", "Shoulder@"},
                 {"Hand", "Wrist@"},
                 {"UpperLeg", "Hip@"},
                 {"Foot", "Ankle@"}});
    expectRoles("Rig of numbered limbs",
                "torso_1 torso_2<torso_1 neck_1<torso_2 arm_joint_@_1<torso_2 "
                "arm_joint_@_2<arm_joint_@_1 arm_joint_@_3<arm_joint_@_2 leg_joint_@_1<torso_1 "
                "leg_joint_@_2<leg_joint_@_1 leg_joint_@_3<leg_joint_@_2 "
                "leg_joint_@_5<leg_joint_@_3",
                "L", "R",
                {{"Hips", "torso_1"},
                 {"UpperArm", "arm_joint_@_1"},
                 {"Hand", "arm_joint_@_3"},
                 {"UpperLeg", "leg_joint_@_1"},
                 {"Foot", "leg_joint_@_3"},
                 {"Toe", "leg_joint_@_5"}});
}

TEST(NamedRigs, PositionWords) {
    expectRoles("Fallout",
                "Root COM<Root Pelvis<COM SPINE1<COM SPINE2<SPINE1 Chest<SPINE2 Neck<Chest "
                "Head<Neck @Arm_Collarbone<Chest @Arm_UpperArm<@Arm_Collarbone "
                "@Arm_ForeArm1<@Arm_UpperArm @Arm_ForeArm2<@Arm_ForeArm1 @Arm_Hand<@Arm_ForeArm2 "
                "@Leg_Thigh<Pelvis @Leg_Calf<@Leg_Thigh @Leg_Foot<@Leg_Calf @Leg_Toe1<@Leg_Foot",
                "L", "R",
                {{"Hips", "Pelvis"},
                 {"Collar", "@Arm_Collarbone"},
                 {"LowerArm", "@Arm_ForeArm1"},
                 {"Hand", "@Arm_Hand"},
                 {"UpperLeg", "@Leg_Thigh"}});
    expectRoles("Limbs first",
                "Hips Spine<Hips Head<Spine Arm_@_Upper<Spine Arm_@_Lower<Arm_@_Upper "
                "Hand_@<Arm_@_Lower Leg_@_Upper<Hips Leg_@_Lower<Leg_@_Upper Foot_@<Leg_@_Lower",
                "L", "R",
                {{"UpperArm", "Arm_@_Upper"}, {"LowerLeg", "Leg_@_Lower"}, {"Hand", "Hand_@"}});
    expectRoles(
        "Skyrim",
        "NPC+Root+[Root] NPC+COM+[COM+]<NPC+Root+[Root] NPC+Pelvis+[Pelv]<NPC+COM+[COM+] "
        "NPC+Spine+[Spn0]<NPC+COM+[COM+] NPC+Spine1+[Spn1]<NPC+Spine+[Spn0] "
        "NPC+Neck+[Neck]<NPC+Spine1+[Spn1] NPC+Head+[Head]<NPC+Neck+[Neck] "
        "NPC+@+Clavicle+[@Clv]<NPC+Spine1+[Spn1] NPC+@+UpperArm+[@Uar]<NPC+@+Clavicle+[@Clv] "
        "NPC+@+UpperarmTwist1+[@Ut1]<NPC+@+UpperArm+[@Uar] "
        "NPC+@+Forearm+[@Lar]<NPC+@+UpperArm+[@Uar] NPC+@+Hand+[@Hnd]<NPC+@+Forearm+[@Lar] "
        "NPC+@+Thigh+[@Thg]<NPC+Pelvis+[Pelv] NPC+@+Calf+[@Clf]<NPC+@+Thigh+[@Thg] "
        "NPC+@+Foot+[@ft+]<NPC+@+Calf+[@Clf]",
        "L", "R", {{"Hips", "NPC+Pelvis+[Pelv]"}, {"Head", "NPC+Head+[Head]"}});
    expectRoles("Reallusion",
                "CC_Base_BoneRoot CC_Base_Hip<CC_Base_BoneRoot CC_Base_Pelvis<CC_Base_Hip "
                "CC_Base_@_Thigh<CC_Base_Pelvis CC_Base_@_ThighTwist01<CC_Base_@_Thigh "
                "CC_Base_@_Calf<CC_Base_@_Thigh CC_Base_@_KneeShareBone<CC_Base_@_Calf "
                "CC_Base_@_Foot<CC_Base_@_Calf CC_Base_@_ToeBase<CC_Base_@_Foot "
                "CC_Base_@_BigToe1<CC_Base_@_ToeBase CC_Base_Waist<CC_Base_Hip "
                "CC_Base_Spine01<CC_Base_Waist CC_Base_NeckTwist01<CC_Base_Spine01 "
                "CC_Base_NeckTwist02<CC_Base_NeckTwist01 CC_Base_Head<CC_Base_NeckTwist02 "
                "CC_Base_@_Clavicle<CC_Base_Spine01 CC_Base_@_Upperarm<CC_Base_@_Clavicle "
                "CC_Base_@_UpperarmTwist01<CC_Base_@_Upperarm "
                "CC_Base_@_Forearm<CC_Base_@_Upperarm CC_Base_@_Hand<CC_Base_@_Forearm "
                "CC_Base_@_Mid1<CC_Base_@_Hand",
                "L", "R",
                {{"Hips", "CC_Base_Hip"},
                 {"Neck", "CC_Base_NeckTwist01"},
                 {"UpperArm", "CC_Base_@_Upperarm"},
                 {"Toe", "CC_Base_@_ToeBase"},
                 {"Middle1", "CC_Base_@_Mid1"}});
}

TEST(NamedRigs, CaptureSystemsAndRiggingTools) {
    expectRoles("OptiTrack",
                "Skeleton Hip<Skeleton Ab<Hip Chest<Ab Neck<Chest Head<Neck @Shoulder<Chest "
                "@UArm<@Shoulder @FArm<@UArm @Hand<@FArm @Thigh<Hip @Shin<@Thigh @Foot<@Shin "
                "@Toe<@Foot",
                "L", "R",
                {{"Collar", "@Shoulder"},
                 {"UpperArm", "@UArm"},
                 {"LowerArm", "@FArm"},
                 {"Hand", "@Hand"},
                 {"UpperLeg", "@Thigh"}});
    expectRoles("mGear",
                "spine_C0_pelvis_jnt spine_C0_01_jnt<spine_C0_pelvis_jnt "
                "spine_C0_02_jnt<spine_C0_01_jnt neck_C0_0_jnt<spine_C0_02_jnt "
                "neck_C0_head_jnt<neck_C0_0_jnt shoulder_@0_shoulder_jnt<spine_C0_02_jnt "
                "arm_@0_0_jnt<shoulder_@0_shoulder_jnt arm_@0_1_jnt<arm_@0_0_jnt "
                "arm_@0_2_jnt<arm_@0_1_jnt arm_@0_end_jnt<arm_@0_2_jnt "
                "leg_@0_0_jnt<spine_C0_pelvis_jnt leg_@0_1_jnt<leg_@0_0_jnt "
                "leg_@0_2_jnt<leg_@0_1_jnt leg_@0_end_jnt<leg_@0_2_jnt",
                "L", "R",
                {{"Hips", "spine_C0_pelvis_jnt"},
                 {"Head", "neck_C0_head_jnt"},
                 {"Collar", "shoulder_@0_shoulder_jnt"},
                 {"UpperArm", "arm_@0_0_jnt"},
                 {"Hand", "arm_@0_2_jnt"},
                 {"Foot", "leg_@0_2_jnt"}});
    expectRoles("AdvancedSkeleton",
                "Root_M Spine1_M<Root_M Chest_M<Spine1_M Neck_M<Chest_M Head_M<Neck_M "
                "Scapula_@<Chest_M Shoulder_@<Scapula_@ ShoulderPart1_@<Shoulder_@ "
                "Elbow_@<ShoulderPart1_@ Wrist_@<Elbow_@ IndexFinger1_@<Wrist_@ Hip_@<Root_M "
                "Knee_@<Hip_@ Ankle_@<Knee_@ Toes_@<Ankle_@",
                "L", "R",
                {{"Hips", "Root_M"},
                 {"Collar", "Scapula_@"},
                 {"UpperArm", "Shoulder_@"},
                 {"Index1", "IndexFinger1_@"},
                 {"UpperLeg", "Hip_@"}});
    expectRoles("MikuMikuDance in English",
                "center upper_body<center upper_body2<upper_body neck<upper_body2 head<neck "
                "shoulder_@<upper_body2 arm_@<shoulder_@ arm_twist_@<arm_@ elbow_@<arm_twist_@ "
                "wrist_@<elbow_@ lower_body<center leg_@<lower_body knee_@<leg_@ ankle_@<knee_@ "
                "toe_@<ankle_@ leg_IK_@<center",
                "L", "R",
                {{"Hips", "lower_body"},
                 {"Spine", "upper_body"},
                 {"UpperArm", "arm_@"},
                 {"LowerArm", "elbow_@"},
                 {"UpperLeg", "leg_@"}});
    expectRoles("Genesis",
                "hip pelvis<hip @ThighBend<pelvis @ThighTwist<@ThighBend @Shin<@ThighTwist "
                "@Foot<@Shin @Metatarsals<@Foot @Toe<@Metatarsals @BigToe<@Toe abdomenLower<hip "
                "chestLower<abdomenLower @Collar<chestLower @ShldrBend<@Collar "
                "@ShldrTwist<@ShldrBend @ForearmBend<@ShldrTwist @ForearmTwist<@ForearmBend "
                "@Hand<@ForearmTwist @Thumb1<@Hand neckLower<chestLower head<neckLower",
                "l", "r",
                {{"Hips", "hip"},
                 {"UpperLeg", "@ThighBend"},
                 {"Toe", "@Toe"},
                 {"UpperArm", "@ShldrBend"},
                 {"LowerArm", "@ForearmBend"}});
}

TEST(NamedRigs, Japanese) {
    const RestSkeleton skeleton = makeNamed(
        "全ての親 センター<全ての親 下半身<センター 上半身<センター 上半身2<上半身 首<上半身2 "
        "頭<首 "
        "左肩<上半身2 左腕<左肩 左腕捩<左腕 左ひじ<左腕捩 左手首<左ひじ 右肩<上半身2 右腕<右肩 "
        "右ひじ<右腕 右手首<右ひじ 左足<下半身 左ひざ<左足 左足首<左ひざ 左つま先<左足首 "
        "左足ＩＫ<全ての親 右足<下半身 右ひざ<右足 右足首<右ひざ");
    const JointRoles roles = recogniseJoints(skeleton);
    EXPECT_EQ(roles.family, "MikuMikuDance");
    EXPECT_EQ(roles.roles[std::size_t(skeleton.find("左手首"))], "LeftHand");
    EXPECT_EQ(roles.roles[std::size_t(skeleton.find("右ひざ"))], "RightLowerLeg");
    EXPECT_EQ(roles.roles[std::size_t(skeleton.find("左足ＩＫ"))], "");
}

/// All joints below one root, as glTF lists a skin's joints if their nodes are missing: no joint is
/// above another, and the trunk's last joint is not the head.
TEST(NamedRigs, FlatListHasNoHead) {
    const RestSkeleton skeleton =
        makeNamed("root Hips<root Neck<root Spine<root LeftArm<root RightArm<root "
                  "LeftForeArm<root RightForeArm<root");
    const JointRoles roles = recogniseJoints(skeleton);
    EXPECT_EQ(roles.joints.count("Head"), 0u);
    EXPECT_EQ(roles.joints.count("Neck"), 1u);
    EXPECT_EQ(roles.joints.count("Spine"), 1u);
}

/// Unknown names between known ones: the tree determines their roles.
TEST(NamedRigs, FillsGapsByHierarchy) {
    expectRoles("gaps",
                "pelvis vert1<pelvis vert2<vert1 trunk<vert2 cerv<trunk head<cerv "
                "@_qq<trunk @_upperarm<@_qq @_xx_twist<@_upperarm @_xx<@_upperarm @_yy<@_xx "
                "@_yy_end<@_yy @_thigh<pelvis @_zz<@_thigh @_ww<@_zz @_toe<@_ww",
                "l", "r",
                {{"Hips", "pelvis"},
                 {"Spine", "vert1"},
                 {"Neck", "cerv"},
                 {"Head", "head"},
                 {"Collar", "@_qq"},
                 {"UpperArm", "@_upperarm"},
                 {"UpperLeg", "@_thigh"},
                 {"Toe", "@_toe"}});
    expectRoles("biomechanics",
                "pelvis abdomen<pelvis thorax_low<abdomen thorax<thorax_low neck<thorax head<neck "
                "@_shoulder<thorax @_uarm<@_shoulder @_larm<@_uarm @_hand<@_larm @_thigh<pelvis "
                "@_shank<@_thigh @_foot<@_shank @_toes<@_foot",
                "l", "r", {{"LowerArm", "@_larm"}, {"LowerLeg", "@_shank"}, {"Hand", "@_hand"}});
    expectRoles("one letter a side",
                "PelvisSeg LowerTorso<PelvisSeg UpperTorso<LowerTorso Neck<UpperTorso Head<Neck "
                "@Clav<UpperTorso @UArm<@Clav @LArm<@UArm @Hand<@LArm @Thigh<PelvisSeg "
                "@LLeg<@Thigh @Foot<@LLeg @Toe<@Foot",
                "L", "R", {{"LowerArm", "@LArm"}, {"LowerLeg", "@LLeg"}, {"UpperArm", "@UArm"}});
    expectRoles("vertebrae",
                "Pelvis L5<Pelvis L3<L5 T8<L3 Neck<T8 Head<Neck @Shoulder<T8 "
                "@UpperArm<@Shoulder @ForeArm<@UpperArm @Hand<@ForeArm @UpperLeg<Pelvis "
                "@LowerLeg<@UpperLeg @Foot<@LowerLeg @Toe<@Foot",
                "Left", "Right", {{"Spine", "L5"}, {"Hips", "Pelvis"}});
    expectRoles("two words",
                "Hips SpineLower<Hips SpineUpper<SpineLower Neck<SpineUpper Head<Neck "
                "@Shoulder<SpineUpper @ArmUpper<@Shoulder @ArmLower<@ArmUpper "
                "@HandWrist<@ArmLower @HandPalm<@HandWrist @UpperLeg<Hips @LowerLeg<@UpperLeg "
                "@FootAnkle<@LowerLeg @FootBall<@FootAnkle",
                "Left", "Right", {{"Hand", "@HandWrist"}, {"Foot", "@FootAnkle"}});
}

/// A hand or a foot with an unknown name is below a limb with a known one.
TEST(NamedRigs, FillsLimbEndsByHierarchy) {
    expectRoles("ends",
                "hips spine<hips neck<spine head<neck @_clavicle<spine @_upperarm<@_clavicle "
                "@_forearm<@_upperarm @_forearm_twist<@_forearm @_aa<@_forearm "
                "@_thumb1<@_aa @_bb<@_aa @_thigh<hips @_calf<@_thigh @_cc<@_calf @_toe<@_cc",
                "l", "r", {{"Hand", "@_aa"}, {"Foot", "@_cc"}});
}
