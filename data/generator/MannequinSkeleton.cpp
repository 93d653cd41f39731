// SPDX-License-Identifier: MIT
#include "MannequinSkeleton.h"

#include <map>

namespace mannequin {
namespace {

struct Row {
    const char* name;
    const char* parent;
    glm::dvec3 centre;
    glm::dvec3 endSite; ///< zero if the joint has children
};

const Row kTrunk[] = {
    {"Hips", "", {0, 0.970, 0.000}, {}},
    {"LowerBack", "Hips", {0, 1.020, -0.020}, {}},
    {"Spine", "LowerBack", {0, 1.130, -0.030}, {}},
    {"Spine1", "Spine", {0, 1.280, -0.040}, {}},
    {"Neck", "Spine1", {0, 1.485, -0.045}, {}},
    {"Neck1", "Neck", {0, 1.535, -0.030}, {}},
    {"Head", "Neck1", {0, 1.590, -0.015}, {0, 1.800, 0.005}},
};

// The left side; the right side mirrors x.
const Row kLimbs[] = {
    {"LHipJoint", "Hips", {0, 0.970, 0.000}, {}}, // zero length, like in the CMU files
    {"LeftUpLeg", "LHipJoint", {0.090, 0.930, 0.000}, {}},
    {"LeftLeg", "LeftUpLeg", {0.112, 0.513, 0.012}, {}},
    {"LeftFoot", "LeftLeg", {0.132, 0.078, -0.022}, {}},
    {"LeftToeBase", "LeftFoot", {0.153, 0.022, 0.125}, {0.163, 0.015, 0.205}},
    {"LeftShoulder", "Spine1", {0.030, 1.430, 0.020}, {}},
    {"LeftArm", "LeftShoulder", {0.183, 1.435, -0.030}, {}},
    {"LeftForeArm", "LeftArm", {0.4205, 1.2357, -0.036}, {}},
    {"LeftHand", "LeftForeArm", {0.6180, 1.0697, 0.0115}, {}},
    {"LThumb", "LeftHand", {0.6340, 1.0530, 0.0440}, {0.6720, 1.0080, 0.0980}},
    {"LeftFingerBase", "LeftHand", {0.6880, 1.0090, 0.0330}, {}},
    {"LeftHandIndex1", "LeftFingerBase", {0.7190, 0.9800, 0.0430}, {0.7560, 0.9420, 0.0540}},
};

std::string mirrored(const std::string& name) {
    if (name.rfind("Left", 0) == 0) return "Right" + name.substr(4);
    if (name == "LHipJoint" || name == "LThumb") return "R" + name.substr(1);
    return name;
}

} // namespace

std::vector<RestJoint> restSkeleton() {
    std::vector<RestJoint> joints;
    std::map<std::string, int> index;
    const auto add = [&](const Row& row, bool right) {
        const auto side = [right](glm::dvec3 p) { return right ? p * glm::dvec3(-1, 1, 1) : p; };
        const std::string name = right ? mirrored(row.name) : row.name;
        const std::string parent = right ? mirrored(row.parent) : row.parent;
        const bool leaf = row.endSite != glm::dvec3(0);
        index[name] = static_cast<int>(joints.size());
        joints.push_back({name, parent.empty() ? -1 : index.at(parent), side(row.centre),
                          side(row.endSite), leaf});
    };
    for (const Row& row : kTrunk) add(row, false);
    for (const Row& row : kLimbs) add(row, false);
    for (const Row& row : kLimbs) add(row, true);
    return joints;
}

} // namespace mannequin
