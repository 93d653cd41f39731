// SPDX-License-Identifier: GPL-3.0-or-later
#include "joints/RigidJoints.h"

#include "joints/JointNames.h"

#include <osgSkin/Error>
#include <osgSkinBind/Bind>

namespace osgSkin {

std::vector<std::string> automaticRigidJoints(const RestSkeleton& skeleton) {
    std::vector<std::string> result;
    std::vector<bool> inside(skeleton.joints.size(), false);
    for (std::size_t j = 1; j < skeleton.joints.size(); ++j) { // never the root: nothing would bend
        const RestJoint& joint = skeleton.joints[j];
        inside[j] = inside[static_cast<std::size_t>(joint.parent)];
        if (inside[j]) continue;
        if (!isHeadName(joint.name) && !isHandName(joint.name) && !isFootName(joint.name)) continue;
        inside[j] = true;
        result.push_back(joint.name);
    }
    return result;
}

std::vector<int> rigidJoints(const RestSkeleton& skeleton, const BindOptions& options) {
    std::vector<bool> named(skeleton.joints.size(), false);
    for (const std::string& name :
         options.rigid ? *options.rigid : automaticRigidJoints(skeleton)) {
        const int joint = skeleton.find(name);
        if (joint < 0)
            throw Error("bind: rigid joint \"" + name +
                        "\" is not in the skeleton, expected one of its joints");
        named[static_cast<std::size_t>(joint)] = true;
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
