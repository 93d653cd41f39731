// SPDX-License-Identifier: MIT
#include <osgSkinRig/JointNames>

#include "names/NameWords.h"

#include <utility>

namespace osgSkin {
namespace {

/// A role and its names, with a blank between them. In roles and names, "%Side" stands for Left or
/// Right, "%S" for L or R, "%s" for l or r, "%J" for the same in Japanese, and "%f" for a finger's
/// joint 1, 2 and 3.
using Row = std::pair<const char*, const char*>;

struct Family {
    const char* name;
    std::vector<Row> rows;
};

std::vector<Row> with(std::vector<Row> rows, const std::vector<Row>& more) {
    rows.insert(rows.end(), more.begin(), more.end());
    return rows;
}

const std::vector<Family>& families() {
    // CMU's motions and Mixamo's models name joints by the bone that they rotate.
    static const std::vector<Row> byBones{{"Hips", "Hips"},
                                          {"Head", "Head"},
                                          {"%SideUpperLeg", "%SideUpLeg"},
                                          {"%SideLowerLeg", "%SideLeg"},
                                          {"%SideFoot", "%SideFoot"},
                                          {"%SideToe", "%SideToeBase"},
                                          {"%SideCollar", "%SideShoulder"},
                                          {"%SideUpperArm", "%SideArm"},
                                          {"%SideLowerArm", "%SideForeArm"},
                                          {"%SideHand", "%SideHand"}};

    // 3ds Max and Biovision name the joints themselves.
    static const std::vector<Row> byJoints{{"Hips", "Hips"},
                                           {"Head", "Head"},
                                           {"%SideUpperLeg", "%SideHip"},
                                           {"%SideLowerLeg", "%SideKnee"},
                                           {"%SideFoot", "%SideAnkle"},
                                           {"%SideCollar", "%SideCollar"},
                                           {"%SideUpperArm", "%SideShoulder"},
                                           {"%SideLowerArm", "%SideElbow"},
                                           {"%SideHand", "%SideWrist"}};
    static const std::vector<Family> all{
        {"CMU (MotionBuilder)",
         with(byBones, {{"Spine", "LowerBack Spine Spine1"},
                        {"Neck", "Neck Neck1"},
                        {"%SideHipJoint", "%SHipJoint"},
                        {"%SideFingerBase", "%SideFingerBase"},
                        {"%SideFingers", "%SideHandIndex1 %SideHandFinger1 %SFingers"},
                        {"%SideThumb1", "%SThumb"}})},
        {"CMU (3ds Max)", with(byJoints, {{"Spine", "LowerBack Chest Chest2"},
                                          {"Neck", "LowerNeck Neck"},
                                          {"%SideHipJoint", "%SHipJoint"},
                                          {"%SideToe", "%SideToe"},
                                          {"%SideFingerBase", "%sHand"},
                                          {"%SideFingers", "%SFingers"},
                                          {"%SideThumb1", "%SThumb"}})},
        {"CMU (DAZ)",
         {{"Hips", "hip"},
          {"Spine", "abdomen abdomen2 chest"},
          {"Neck", "neck"},
          {"Head", "head"},
          {"%SideHipJoint", "%sButtock"},
          {"%SideUpperLeg", "%sThigh"},
          {"%SideLowerLeg", "%sShin"},
          {"%SideFoot", "%sFoot"},
          {"%SideToe", "%sToe"},
          {"%SideCollar", "%sCollar"},
          {"%SideUpperArm", "%sShldr"},
          {"%SideLowerArm", "%sForeArm"},
          {"%SideHand", "%sHand"},
          {"%SideThumb%f", "%sThumb%f"},
          {"%SideIndex%f", "%sIndex%f"},
          {"%SideMiddle%f", "%sMid%f"},
          {"%SideRing%f", "%sRing%f"},
          {"%SideLittle%f", "%sPinky%f"}}},
        {"Biovision", with(byJoints, {{"Spine", "Ab Chest Chest2 Chest3 Chest4"},
                                      {"Neck", "Neck"},
                                      {"%SideToe", "%SideToes %SideToe"}})},
        {"Mixamo", with(byBones, {{"Spine", "Spine Spine1 Spine2"},
                                  {"Neck", "Neck"},
                                  {"%SideThumb%f", "%SideHandThumb%f"},
                                  {"%SideIndex%f", "%SideHandIndex%f"},
                                  {"%SideMiddle%f", "%SideHandMiddle%f"},
                                  {"%SideRing%f", "%SideHandRing%f"},
                                  {"%SideLittle%f", "%SideHandPinky%f"}})},
        {"Unreal",
         {{"Hips", "pelvis"},
          {"Spine", "spine_01 spine_02 spine_03 spine_04 spine_05"},
          {"Neck", "neck_01 neck_02"},
          {"Head", "head"},
          {"%SideUpperLeg", "thigh_%s"},
          {"%SideLowerLeg", "calf_%s"},
          {"%SideFoot", "foot_%s"},
          {"%SideToe", "ball_%s"},
          {"%SideCollar", "clavicle_%s"},
          {"%SideUpperArm", "upperarm_%s"},
          {"%SideLowerArm", "lowerarm_%s"},
          {"%SideHand", "hand_%s"},
          {"%SideThumb%f", "thumb_0%f_%s"},
          {"%SideIndex%f", "index_0%f_%s"},
          {"%SideMiddle%f", "middle_0%f_%s"},
          {"%SideRing%f", "ring_0%f_%s"},
          {"%SideLittle%f", "pinky_0%f_%s"}}},
        {"VRM",
         {{"Hips", "J_Bip_C_Hips"},
          {"Spine", "J_Bip_C_Spine J_Bip_C_Chest J_Bip_C_UpperChest"},
          {"Neck", "J_Bip_C_Neck"},
          {"Head", "J_Bip_C_Head"},
          {"%SideUpperLeg", "J_Bip_%S_UpperLeg"},
          {"%SideLowerLeg", "J_Bip_%S_LowerLeg"},
          {"%SideFoot", "J_Bip_%S_Foot"},
          {"%SideToe", "J_Bip_%S_ToeBase"},
          {"%SideCollar", "J_Bip_%S_Shoulder"},
          {"%SideUpperArm", "J_Bip_%S_UpperArm"},
          {"%SideLowerArm", "J_Bip_%S_LowerArm"},
          {"%SideHand", "J_Bip_%S_Hand"},
          {"%SideThumb%f", "J_Bip_%S_Thumb%f"},
          {"%SideIndex%f", "J_Bip_%S_Index%f"},
          {"%SideMiddle%f", "J_Bip_%S_Middle%f"},
          {"%SideRing%f", "J_Bip_%S_Ring%f"},
          {"%SideLittle%f", "J_Bip_%S_Little%f"}}},
        {"Unity humanoid",
         {{"Hips", "Hips"},
          {"Spine", "Spine Chest UpperChest"},
          {"Neck", "Neck"},
          {"Head", "Head"},
          {"%SideUpperLeg", "%SideUpperLeg"},
          {"%SideLowerLeg", "%SideLowerLeg"},
          {"%SideFoot", "%SideFoot"},
          {"%SideToe", "%SideToes"},
          {"%SideCollar", "%SideShoulder"},
          {"%SideUpperArm", "%SideUpperArm"},
          {"%SideLowerArm", "%SideLowerArm"},
          {"%SideHand", "%SideHand"},
          {"%SideThumb1", "%SideThumbProximal"},
          {"%SideThumb2", "%SideThumbIntermediate"},
          {"%SideThumb3", "%SideThumbDistal"},
          {"%SideIndex1", "%SideIndexProximal"},
          {"%SideIndex2", "%SideIndexIntermediate"},
          {"%SideIndex3", "%SideIndexDistal"},
          {"%SideMiddle1", "%SideMiddleProximal"},
          {"%SideMiddle2", "%SideMiddleIntermediate"},
          {"%SideMiddle3", "%SideMiddleDistal"},
          {"%SideRing1", "%SideRingProximal"},
          {"%SideRing2", "%SideRingIntermediate"},
          {"%SideRing3", "%SideRingDistal"},
          {"%SideLittle1", "%SideLittleProximal"},
          {"%SideLittle2", "%SideLittleIntermediate"},
          {"%SideLittle3", "%SideLittleDistal"}}},
        {"Rokoko",
         {{"Hips", "Hips"},
          {"Spine", "Spine1 Spine2 Spine3 Spine4"},
          {"Neck", "Neck"},
          {"Head", "Head"},
          {"%SideUpperLeg", "%SideThigh"},
          {"%SideLowerLeg", "%SideShin"},
          {"%SideFoot", "%SideFoot"},
          {"%SideToe", "%SideToe"},
          {"%SideCollar", "%SideShoulder"},
          {"%SideUpperArm", "%SideArm"},
          {"%SideLowerArm", "%SideForeArm"},
          {"%SideHand", "%SideHand"},
          {"%SideThumb1", "%SideFinger1Metacarpal"},
          {"%SideThumb2", "%SideFinger1Proximal"},
          {"%SideThumb3", "%SideFinger1Distal"},
          {"%SideIndex1", "%SideFinger2Proximal"},
          {"%SideIndex2", "%SideFinger2Medial"},
          {"%SideIndex3", "%SideFinger2Distal"},
          {"%SideMiddle1", "%SideFinger3Proximal"},
          {"%SideMiddle2", "%SideFinger3Medial"},
          {"%SideMiddle3", "%SideFinger3Distal"},
          {"%SideRing1", "%SideFinger4Proximal"},
          {"%SideRing2", "%SideFinger4Medial"},
          {"%SideRing3", "%SideFinger4Distal"},
          {"%SideLittle1", "%SideFinger5Proximal"},
          {"%SideLittle2", "%SideFinger5Medial"},
          {"%SideLittle3", "%SideFinger5Distal"}}},
        {"MakeHuman",
         {{"Hips", "root"},
          {"Spine", "spine05 spine04 spine03 spine02 spine01"},
          {"Neck", "neck01 neck02 neck03"},
          {"Head", "head"},
          {"%SideHipJoint", "pelvis.%S"},
          {"%SideUpperLeg", "upperleg01.%S"},
          {"%SideLowerLeg", "lowerleg01.%S"},
          {"%SideFoot", "foot.%S"},
          {"%SideToe", "toe1-1.%S"},
          {"%SideCollar", "clavicle.%S"},
          {"%SideUpperArm", "upperarm01.%S"},
          {"%SideLowerArm", "lowerarm01.%S"},
          {"%SideHand", "wrist.%S"},
          {"%SideThumb%f", "finger1-%f.%S"},
          {"%SideIndex%f", "finger2-%f.%S"},
          {"%SideMiddle%f", "finger3-%f.%S"},
          {"%SideRing%f", "finger4-%f.%S"},
          {"%SideLittle%f", "finger5-%f.%S"}}},
        {"Biped",
         {{"Hips", "Bip01Pelvis Bip001Pelvis"},
          {"Spine", "Bip01Spine Bip01Spine1 Bip01Spine2 Bip001Spine Bip001Spine1 Bip001Spine2"},
          {"Neck", "Bip01Neck Bip001Neck"},
          {"Head", "Bip01Head Bip001Head"},
          {"%SideUpperLeg", "Bip01%SThigh Bip001%SThigh"},
          {"%SideLowerLeg", "Bip01%SCalf Bip001%SCalf"},
          {"%SideFoot", "Bip01%SFoot Bip001%SFoot"},
          {"%SideToe", "Bip01%SToe0 Bip001%SToe0"},
          {"%SideCollar", "Bip01%SClavicle Bip001%SClavicle"},
          {"%SideUpperArm", "Bip01%SUpperArm Bip001%SUpperArm"},
          {"%SideLowerArm", "Bip01%SForearm Bip001%SForearm"},
          {"%SideHand", "Bip01%SHand Bip001%SHand"}}},
        {"MikuMikuDance",
         {{"Hips", "センター"},
          {"Spine", "上半身 上半身2"},
          {"Neck", "首"},
          {"Head", "頭"},
          {"%SideUpperLeg", "%J足"},
          {"%SideLowerLeg", "%Jひざ"},
          {"%SideFoot", "%J足首"},
          {"%SideToe", "%Jつま先"},
          {"%SideCollar", "%J肩"},
          {"%SideUpperArm", "%J腕"},
          {"%SideLowerArm", "%Jひじ"},
          {"%SideHand", "%J手首"}}},
    };
    return all;
}

std::string replaced(std::string text, const std::string& mark, const std::string& by) {
    for (std::size_t at = text.find(mark); at != std::string::npos; at = text.find(mark, at))
        text.replace(at, mark.size(), by);
    return text;
}

void addRow(const std::string& role, const std::string& names, JointNames& result) {
    if (role.find("%Side") != std::string::npos) {
        for (const std::string side : {"Left", "Right"}) {
            const auto sided = [&side](std::string text) {
                text = replaced(text, "%Side", side);
                text = replaced(text, "%S", side.substr(0, 1));
                text = replaced(text, "%J", side == "Left" ? "左" : "右");
                return replaced(text, "%s", side == "Left" ? "l" : "r");
            };
            addRow(sided(role), sided(names), result);
        }
        return;
    }
    if (role.find("%f") != std::string::npos) {
        for (const std::string joint : {"1", "2", "3"})
            addRow(replaced(role, "%f", joint), replaced(names, "%f", joint), result);
        return;
    }
    result.roles[role] = split(names);
}

} // namespace

const std::vector<JointNames>& knownJointNames() {
    static const std::vector<JointNames> known = [] {
        std::vector<JointNames> result;
        for (const Family& family : families()) {
            result.push_back({family.name, {}});
            for (const auto& [role, names] : family.rows) addRow(role, names, result.back());
        }
        return result;
    }();
    return known;
}

} // namespace osgSkin
