// SPDX-License-Identifier: GPL-3.0-or-later
#include "joints/RigidJoints.h"

#include <osgSkin/Error>

#include <map>

namespace osgSkin {

std::vector<std::size_t> extremities(const RestSkeleton& skeleton, const JointRoles& roles) {
    std::vector<std::size_t> result;
    std::vector<bool> inside(skeleton.joints.size(), false);
    for (std::size_t j = 1; j < skeleton.joints.size(); ++j) {
        inside[j] = inside[static_cast<std::size_t>(skeleton.joints[j].parent)];
        if (inside[j]) continue;
        for (const JointPart part : {JointPart::Head, JointPart::Hand, JointPart::Foot})
            if (roles.is(j, part)) inside[j] = true;
        if (inside[j]) result.push_back(j);
    }
    return result;
}

std::vector<std::string> automaticRigidJoints(const RestSkeleton& skeleton,
                                              const std::vector<JointNames>& names,
                                              const std::vector<bool>& isMoved) {
    const JointRoles roles = recogniseJoints(skeleton, names);
    std::vector<std::string> result;
    for (const std::size_t joint : extremities(skeleton, roles)) {
        bool bends = false;
        for (std::size_t j = joint + 1; j < skeleton.joints.size() && !bends; ++j) {
            if (!skeleton.isInSubtree(static_cast<int>(j), static_cast<int>(joint))) continue;
            const bool isEnd = !skeleton.joints[j].tip && roles.roles[j].empty() &&
                               skeleton.children(static_cast<int>(j)).empty();
            const JointPart part = roles.parts[j];
            const bool isSame = part == JointPart::Head || part == JointPart::Hand ||
                                part == JointPart::Foot; // a hand below its wrist
            bends = !isEnd && !isSame && (isMoved.empty() || isMoved[j]);
        }
        if (!bends) result.push_back(skeleton.joints[joint].name);
    }
    return result;
}

std::vector<int> rigidJoints(const RestSkeleton& skeleton, const BindOptions& options) {
    const std::map<std::string, int> jointOf = skeleton.byName();
    std::vector<bool> named(skeleton.joints.size(), false);
    for (const std::string& name :
         options.rigid ? *options.rigid : automaticRigidJoints(skeleton, options.names)) {
        const auto joint = jointOf.find(name);
        if (joint == jointOf.end())
            throw Error("bind: rigid joint \"" + name +
                        "\" is not in the skeleton, expected one of its joints");
        named[static_cast<std::size_t>(joint->second)] = true;
    }
    std::vector<int> result(skeleton.joints.size(), -1);
    for (std::size_t j = 0; j < result.size(); ++j) {
        const int parent = skeleton.joints[j].parent;
        if (parent >= 0) result[j] = result[static_cast<std::size_t>(parent)];
        if (result[j] < 0 && named[j]) result[j] = static_cast<int>(j);
    }
    return result;
}

} // namespace osgSkin
