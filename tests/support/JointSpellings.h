// SPDX-License-Identifier: MIT
#pragma once

#include <cctype>
#include <cstddef>
#include <cstdio>
#include <map>
#include <string>
#include <vector>

/// Spellings of joint names in the files of various exporters.
namespace test {

/// A tool's names for the joints of a body, without sides.
struct Dialect {
    const char* name;
    std::map<std::string, std::string> names; ///< role, without its side -> name
};

inline const std::vector<Dialect>& dialects() {
    const auto of = [](const char* name, const std::vector<std::string>& words) {
        static const char* const kRoles[] = {"Hips",     "Spine",    "Neck",     "Head",
                                             "UpperLeg", "LowerLeg", "Foot",     "Toe",
                                             "Collar",   "UpperArm", "LowerArm", "Hand"};
        Dialect dialect{name, {}};
        for (std::size_t i = 0; i < words.size(); ++i) dialect.names[kRoles[i]] = words[i];
        return dialect;
    };
    static const std::vector<Dialect> all{
        of("Mixamo", {"Hips", "Spine", "Neck", "Head", "UpLeg", "Leg", "Foot", "ToeBase",
                      "Shoulder", "Arm", "ForeArm", "Hand"}),
        of("Biovision", {"Hips", "Chest", "Neck", "Head", "Hip", "Knee", "Ankle", "Toe", "Collar",
                         "Shoulder", "Elbow", "Wrist"}),
        of("Daz", {"hip", "abdomen", "neck", "head", "Thigh", "Shin", "Foot", "Toe", "Collar",
                   "Shldr", "ForeArm", "Hand"}),
        of("DazGenesis", {"hip", "abdomenLower", "neckLower", "head", "ThighBend", "Shin", "Foot",
                          "Toe", "Collar", "ShldrBend", "ForearmBend", "Hand"}),
        of("Unreal", {"pelvis", "spine_01", "neck_01", "head", "thigh", "calf", "foot", "ball",
                      "clavicle", "upperarm", "lowerarm", "hand"}),
        of("Vrm", {"Hips", "Spine", "Neck", "Head", "UpperLeg", "LowerLeg", "Foot", "ToeBase",
                   "Shoulder", "UpperArm", "LowerArm", "Hand"}),
        of("Blender", {"hips", "spine", "neck", "head", "thigh", "shin", "foot", "toe", "shoulder",
                       "upper_arm", "forearm", "hand"}),
        of("MakeHuman", {"root", "spine05", "neck01", "head", "upperleg01", "lowerleg01", "foot",
                         "toe1-1", "clavicle", "upperarm01", "lowerarm01", "wrist"}),
        of("Biped", {"Pelvis", "Spine", "Neck", "Head", "Thigh", "Calf", "Foot", "Toe0", "Clavicle",
                     "UpperArm", "Forearm", "Hand"}),
        of("SecondLife", {"Pelvis", "Torso", "Neck", "Head", "Hip", "Knee", "Ankle", "Toe",
                          "Collar", "Shoulder", "Elbow", "Wrist"}),
        of("CmuAsf", {"root", "lowerback", "lowerneck", "head", "femur", "tibia", "foot", "toes",
                      "clavicle", "humerus", "radius", "wrist"}),
        of("Rokoko", {"Hips", "Spine", "Neck", "Head", "Thigh", "Shin", "Foot", "Toe", "Shoulder",
                      "Arm", "ForeArm", "Hand"}),
        of("AutoRig", {"root", "spine_01", "neck", "head", "thigh_stretch", "leg_stretch", "foot",
                       "toes_01", "shoulder", "arm_stretch", "forearm_stretch", "hand"}),
        of("VrChat", {"Hips", "Spine", "Neck", "Head", "Leg", "Knee", "Ankle", "Toe", "Shoulder",
                      "Arm", "Elbow", "Wrist"}),
        of("Quake", {"hips", "chest", "neck", "head", "upleg", "loleg", "foot", "ball", "shoulder",
                     "uparm", "loarm", "hand"})};
    return all;
}

/// How and where a tool marks the side.
struct SideStyle {
    const char* left;
    const char* right;
    bool before;
    const char* separator;
    std::string text() const {
        return std::string(before ? "before" : "after") + " '" + left + separator + "'";
    }
};

inline std::vector<SideStyle> sideStyles() {
    std::vector<SideStyle> result;
    const char* const kSides[][2] = {
        {"Left", "Right"}, {"left", "right"}, {"L", "R"}, {"l", "r"}, {"Lft", "Rgt"}};
    for (const auto& side : kSides)
        for (const bool before : {true, false})
            for (const char* separator : {"", "_", "-", ".", " "})
                result.push_back({side[0], side[1], before, separator});
    return result;
}

/// Prefixes and suffixes that tools add to names; "#" at the end stands for a joint counter.
inline const std::vector<std::string>& namePrefixes() {
    static const std::vector<std::string> all{
        "",       "mixamorig:", "mixamorig_", "mixamorig1:",       "DEF-",  "Neo_",
        "Bip01 ", "Bip001_",    "J_Bip_",     "CC_Base_",          "NPC ",  "Armature|",
        "m_avg_", "SKEL_",      "Wing_",      "ValveBiped.Bip01_", "Bone_", "mixamorigFBXASC058"};
    return all;
}
inline const std::vector<std::string>& nameSuffixes() {
    static const std::vector<std::string> all{"",      "_#",   ".001",   "Bone",
                                              "_Bone", "_JNT", "_jnt_#", " [x#y]"};
    return all;
}

/// One joint's name; `role` as in osgSkin::JointNames.
inline std::string spelled(const Dialect& dialect, const std::string& role, const SideStyle& side,
                           const std::string& prefix, const std::string& suffix,
                           std::size_t count) {
    const bool left = role.rfind("Left", 0) == 0, right = role.rfind("Right", 0) == 0;
    const std::string part = dialect.names.at(role.substr(left ? 4 : right ? 5 : 0));
    std::string name = part;
    if (left || right) {
        const std::string mark = left ? side.left : side.right;
        name = side.before ? mark + side.separator + part : part + side.separator + mark;
    }
    char number[8];
    std::snprintf(number, sizeof number, "%02u", static_cast<unsigned>(count + 1));
    std::string end = suffix;
    if (end.find('#') != std::string::npos) end.replace(end.find('#'), 1, number);
    return prefix + name + end;
}

} // namespace test
