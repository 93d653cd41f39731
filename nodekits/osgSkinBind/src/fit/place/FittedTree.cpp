// SPDX-License-Identifier: GPL-3.0-or-later
#include "fit/place/FittedTree.h"

namespace osgSkin {

const std::vector<FittedJoint>& fittedTree() {
    static const std::vector<FittedJoint> tree{
        {"Hips", -1},
        {"LowerBack", 0},
        {"Spine", 1},
        {"Spine1", 2},
        {"Neck", 3},
        {"Neck1", 4},
        {"Head", 5},
        {"LeftShoulder", 3},
        {"LeftArm", 7},
        {"LeftForeArm", 8},
        {"LeftHand", 9},
        {"LThumb", 10},
        {"LeftFingerBase", 10},
        {"LeftHandIndex1", 12},
        {"RightShoulder", 3},
        {"RightArm", 14},
        {"RightForeArm", 15},
        {"RightHand", 16},
        {"RThumb", 17},
        {"RightFingerBase", 17},
        {"RightHandIndex1", 19},
        {"LHipJoint", 0},
        {"LeftUpLeg", 21},
        {"LeftLeg", 22},
        {"LeftFoot", 23},
        {"LeftToeBase", 24},
        {"RHipJoint", 0},
        {"RightUpLeg", 26},
        {"RightLeg", 27},
        {"RightFoot", 28},
        {"RightToeBase", 29},
    };
    return tree;
}

const std::string& sidePrefix(std::size_t side) {
    static const std::string prefixes[] = {"Left", "Right"};
    return prefixes[side];
}

std::string mirroredName(const std::string& name) {
    if (name.rfind("Left", 0) == 0) return "Right" + name.substr(4);
    if (name.rfind("Right", 0) == 0) return "Left" + name.substr(5);
    if (name == "LHipJoint" || name == "LThumb") return "R" + name.substr(1);
    if (name == "RHipJoint" || name == "RThumb") return "L" + name.substr(1);
    return name;
}

} // namespace osgSkin
