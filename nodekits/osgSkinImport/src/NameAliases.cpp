// SPDX-License-Identifier: MIT
#include "JointMap.h"

namespace osgSkin {
namespace {

/// Each row: names of one joint. Only names that mean the same joint in every dialect belong here:
/// "LeftShoulder" is a collar bone in some files and the upper arm in others.
const std::vector<std::vector<std::string>>& sameJoints() {
    static const std::vector<std::vector<std::string>> rows{
        {"LeftHandFinger1", "LeftHandIndex1", "LFingers"},
        {"RightHandFinger1", "RightHandIndex1", "RFingers"},
    };
    return rows;
}

} // namespace

std::vector<std::string> aliasesOf(const std::string& name) {
    std::vector<std::string> result;
    for (const std::vector<std::string>& row : sameJoints()) {
        bool found = false;
        for (const std::string& member : row) found = found || member == name;
        if (!found) continue;
        for (const std::string& member : row)
            if (member != name) result.push_back(member);
    }
    return result;
}

} // namespace osgSkin
