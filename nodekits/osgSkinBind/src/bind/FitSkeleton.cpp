// SPDX-License-Identifier: MIT
#include <osgSkinBind/FitSkeleton>

#include "bind/Binder.h"
#include "bind/FittedTree.h"

#include <osgSkinRig/JointRoles>

#include <algorithm>
#include <iomanip>
#include <sstream>

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

std::string FitReport::text() const {
    std::ostringstream out;
    out << "fitted " << joints.size() << " joints, height " << height << ", facing " << facing
        << std::fixed << std::setprecision(4) << ", symmetry error " << symmetryError
        << " of the height, " << std::setprecision(3) << seconds << " s\n";
    for (const Joint& joint : joints)
        out << "joint " << joint.name << ": " << joint.how
            << (joint.pushed ? ", moved inside the skin" : "") << "\n";
    for (const std::string& note : notes) out << "note: " << note << "\n";
    return out.str();
}

RestSkeleton fitSkeleton(const SkinMesh& mesh, const FitOptions& options, FitReport* report) {
    return Binder::find("fitting a skeleton")->fit(mesh, options, report);
}

const std::vector<std::string>& fittedJointNames() {
    static const std::vector<std::string> names = [] {
        std::vector<std::string> result;
        for (const FittedJoint& joint : fittedTree()) result.emplace_back(joint.name);
        return result;
    }();
    return names;
}

std::map<std::string, std::string> fittedNamesOf(const std::vector<std::string>& names) {
    static const std::map<std::string, std::string> ofRole = [] {
        std::map<std::string, std::string> result;
        const std::vector<std::string>& own = fittedJointNames();
        const std::vector<std::string> roles = recogniseNames(own);
        for (std::size_t j = 0; j < own.size(); ++j)
            if (!roles[j].empty()) result.emplace(roles[j], own[j]);
        return result;
    }();
    const std::vector<std::string>& fitted = fittedJointNames();
    const auto isOwn = [&](const std::string& name) {
        return std::find(fitted.begin(), fitted.end(), name) != fitted.end();
    };
    // "LeftShoulder" is a collar bone here, but an upper arm beside a "LeftCollar".
    const bool allOwn = std::all_of(names.begin(), names.end(), isOwn);
    const std::vector<std::string> roles = recogniseNames(names);
    std::map<std::string, std::string> result;
    for (std::size_t n = 0; n < names.size(); ++n) {
        const auto found = ofRole.find(roles[n]);
        // The role does not identify one of the several joints of a spine or neck.
        const bool told = found != ofRole.end() && roles[n] != "Spine" && roles[n] != "Neck";
        if (told && !allOwn)
            result[names[n]] = found->second;
        else if (isOwn(names[n]))
            result[names[n]] = names[n];
    }
    return result;
}

} // namespace osgSkin
