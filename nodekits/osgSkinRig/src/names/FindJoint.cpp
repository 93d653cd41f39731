// SPDX-License-Identifier: MIT
#include <osgSkinRig/FindJoint>

#include <osgSkin/Error>
#include <osgSkin/ExpectedNames>

#include <algorithm>
#include <vector>

namespace osgSkin {

std::size_t findJoint(const RestSkeleton& rest, const std::string& name, const JointRoles& roles) {
    int joint = rest.find(name);
    if (joint < 0) joint = roles.joint(name);
    if (joint >= 0) return std::size_t(joint);
    std::vector<std::string> known;
    for (const RestJoint& each : rest.joints) known.push_back(each.name);
    for (const auto& [role, joints] : roles.joints)
        if (std::find(known.begin(), known.end(), role) == known.end()) known.push_back(role);
    throw Error("no joint is called \"" + name + '"' + expectedNames(name, known));
}

std::size_t findJoint(const RestSkeleton& rest, const std::string& name) {
    const int joint = rest.find(name);
    return joint >= 0 ? std::size_t(joint) : findJoint(rest, name, recogniseJoints(rest));
}

} // namespace osgSkin
