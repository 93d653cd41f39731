// SPDX-License-Identifier: MIT
#pragma once

#include <osgSkinRig/JointNames>
#include <osgSkinRig/RestSkeleton>

#include <algorithm>
#include <cstddef>
#include <map>
#include <string>
#include <vector>

/// Skeletons with renamed joints.
namespace test {

/// The known family of joint names that has this name.
inline osgSkin::JointNames knownNames(const std::string& family) {
    const std::vector<osgSkin::JointNames>& known = osgSkin::knownJointNames();
    return *std::find_if(known.begin(), known.end(),
                         [&](const osgSkin::JointNames& names) { return names.name == family; });
}

/// The skeleton without a joint, whose children move to its parent.
inline osgSkin::RestSkeleton without(const osgSkin::RestSkeleton& skeleton,
                                     const std::string& name) {
    osgSkin::RestSkeleton result;
    const int gone = skeleton.find(name);
    for (std::size_t j = 0; j < skeleton.joints.size(); ++j) {
        osgSkin::RestJoint joint = skeleton.joints[j];
        if (static_cast<int>(j) == gone) continue;
        if (joint.parent == gone)
            joint.parent = skeleton.joints[static_cast<std::size_t>(gone)].parent;
        if (joint.parent > gone) --joint.parent;
        result.joints.push_back(joint);
    }
    return result;
}

/// Maps the joints of a skeleton with CMU MotionBuilder names to their names in another family.
/// Joints that the family has no name for are called "extra1" and so on, which is meaningless.
inline std::map<std::string, std::string> namesIn(const osgSkin::RestSkeleton& skeleton,
                                                  const osgSkin::JointNames& family) {
    std::map<std::string, std::string> result;
    std::map<std::string, std::size_t> used;
    for (const osgSkin::RestJoint& joint : skeleton.joints) {
        result[joint.name] = "extra" + std::to_string(result.size());
        for (const auto& [role, members] : knownNames("CMU (MotionBuilder)").roles) {
            if (std::find(members.begin(), members.end(), joint.name) == members.end()) continue;
            const auto theirs = family.roles.find(role);
            if (theirs == family.roles.end() || used[role] >= theirs->second.size()) continue;
            result[joint.name] = theirs->second[used[role]++];
        }
    }
    return result;
}

/// The skeleton with other names.
inline osgSkin::RestSkeleton renamed(osgSkin::RestSkeleton skeleton,
                                     const std::map<std::string, std::string>& names) {
    for (osgSkin::RestJoint& joint : skeleton.joints) joint.name = names.at(joint.name);
    return skeleton;
}

/// Made-up names for every role that CMU's files have.
inline osgSkin::JointNames robotNames() {
    osgSkin::JointNames robot{"robot", {}};
    std::size_t servo = 0;
    for (const auto& [role, members] : knownNames("CMU (MotionBuilder)").roles)
        for (std::size_t i = 0; i < members.size(); ++i)
            robot.roles[role].push_back(role == "Hips" ? "base"
                                                       : "servo" + std::to_string(++servo));
    return robot;
}

} // namespace test
