// SPDX-License-Identifier: GPL-3.0-or-later
#include "fit/PlacedJoints.h"

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

void PlacedJoints::addLandmark(const std::string& name, const glm::dvec3& centre,
                               const std::string& how) {
    _entries[name] = {centre, how, std::nullopt, true, false};
}

glm::dvec3 PlacedJoints::place(const std::string& name, const glm::dvec3& centre,
                               const std::string& how) {
    Entry& entry = _entries[name];
    if (!entry.isLandmark) entry = {centre, how, std::nullopt, false, false};
    return entry.centre;
}

namespace {

glm::dvec3 mirrored(const glm::dvec3& p) {
    return {-p.x, p.y, p.z};
}

} // namespace

void mirrorLandmarks(PlacedJoints& placed) {
    const auto given = placed.entries();
    for (const auto& [name, entry] : given)
        if (given.count(mirroredName(name)) == 0)
            placed.addLandmark(mirroredName(name), mirrored(entry.centre), "mirror of a landmark");
}

void symmetrise(PlacedJoints& placed) {
    for (const FittedJoint& joint : fittedTree()) {
        PlacedJoints::Entry& left = placed.entries().at(joint.name);
        PlacedJoints::Entry& right = placed.entries().at(mirroredName(joint.name));
        if (left.isLandmark || right.isLandmark) continue;
        left.centre = 0.5 * (left.centre + mirrored(right.centre));
        right.centre = mirrored(left.centre);
        if (!left.tip || !right.tip) continue;
        left.tip = 0.5 * (*left.tip + mirrored(*right.tip));
        right.tip = mirrored(*left.tip);
    }
}

} // namespace osgSkin
