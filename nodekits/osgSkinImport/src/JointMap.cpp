// SPDX-License-Identifier: MIT
#include "JointMap.h"

#include <osgSkin/Error>

#include <algorithm>

namespace osgSkin {
namespace {

std::map<std::string, int> indices(const RestSkeleton& skeleton) {
    std::map<std::string, int> result;
    for (std::size_t j = 0; j < skeleton.joints.size(); ++j)
        result.emplace(skeleton.joints[j].name, static_cast<int>(j));
    return result;
}

int lookUp(const std::map<std::string, int>& table, const std::string& name) {
    const auto found = table.find(name);
    return found == table.end() ? -1 : found->second;
}

} // namespace

std::vector<int> mapJoints(const RestSkeleton& rig, const RestSkeleton& motion,
                           const std::map<std::string, std::string>& names) {
    const std::map<std::string, int> rigJoints = indices(rig);
    const std::map<std::string, int> motionJoints = indices(motion);
    for (const auto& [rigName, motionName] : names) {
        if (lookUp(rigJoints, rigName) < 0)
            throw Error("retarget: the map names the joint \"" + rigName +
                        "\", which the rig does not have");
        if (!motionName.empty() && lookUp(motionJoints, motionName) < 0)
            throw Error(std::string("retarget: the map gives \"")
                            .append(rigName)
                            .append("\" the joint \"")
                            .append(motionName)
                            .append("\", which the motion does not have"));
    }
    std::vector<int> result;
    for (const RestJoint& joint : rig.joints) {
        const auto named = names.find(joint.name);
        if (named != names.end()) {
            result.push_back(lookUp(motionJoints, named->second));
            continue;
        }
        int found = lookUp(motionJoints, joint.name);
        for (const std::string& alias : aliasesOf(joint.name))
            if (found < 0) found = lookUp(motionJoints, alias);
        result.push_back(found);
    }
    if (std::all_of(result.begin(), result.end(), [](int m) { return m < 0; }))
        throw Error("retarget: no joint of the rig has a joint of the same name in the motion");
    return result;
}

} // namespace osgSkin
