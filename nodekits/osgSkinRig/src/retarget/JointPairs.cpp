// SPDX-License-Identifier: MIT
#include "retarget/JointPairs.h"

#include <osgSkin/Error>

#include <algorithm>
#include <cmath>

namespace osgSkin {
namespace {

using ByName = std::map<std::string, int>;

void checkNames(const RestSkeleton& rig, const ByName& motion,
                const std::map<std::string, std::string>& names) {
    const ByName rigJoints = rig.byName();
    for (const auto& [rigName, motionName] : names) {
        if (rigJoints.count(rigName) == 0)
            throw Error("retarget: the map names the joint \"" + rigName +
                        "\", which the rig does not have");
        if (!motionName.empty() && motion.count(motionName) == 0)
            throw Error(std::string("retarget: the map gives \"")
                            .append(rigName)
                            .append("\" the joint \"")
                            .append(motionName)
                            .append("\", which the motion does not have"));
    }
}

/// A role that does a missing one's work: some hands have all fingers in one joint.
std::vector<std::string> substitutes(const std::string& role) {
    for (const std::string side : {"Left", "Right"})
        if (role == side + "Fingers") return {side + "Middle1", side + "Index1"};
    return {};
}

/// The motion joint with the part that rig joint `j` has in its body.
int byRole(const JointPairs& map, std::size_t j) {
    const std::string& role = map.rig.roles[j];
    if (role.empty() || !map.motion.known()) return -1;
    auto found = map.motion.joints.find(role);
    for (const std::string& other : substitutes(role))
        if (found == map.motion.joints.end()) found = map.motion.joints.find(other);
    if (found == map.motion.joints.end()) return -1;
    const std::vector<int>& theirs = found->second;
    const std::vector<int>& ours = map.rig.joints.at(role);
    const auto index = static_cast<std::size_t>(
        std::find(ours.begin(), ours.end(), static_cast<int>(j)) - ours.begin());
    if (ours.size() == 1) return theirs.back();
    const double fraction = static_cast<double>(index) / static_cast<double>(ours.size() - 1);
    return theirs[static_cast<std::size_t>(
        std::lround(fraction * static_cast<double>(theirs.size() - 1)))];
}

/// The motion joint of the same name, unless it is another part of the body.
int byName(const JointPairs& map, const ByName& motion, const std::string& name, std::size_t j) {
    const auto found = motion.find(name);
    if (found == motion.end()) return -1;
    const std::string& theirs = map.motion.roles[static_cast<std::size_t>(found->second)];
    const std::string& ours = map.rig.roles[j];
    const bool differs = map.rig.known() && map.motion.known() && theirs != ours;
    return differs ? -1 : found->second;
}

} // namespace

JointPairs mapJoints(const RestSkeleton& rig, const RestSkeleton& motion,
                     const RetargetOptions& options) {
    const ByName motionJoints = motion.byName();
    checkNames(rig, motionJoints, options.joints);
    JointPairs map;
    map.rig = recogniseJoints(rig, options.names);
    map.motion = recogniseJoints(motion, options.names);
    for (std::size_t j = 0; j < rig.joints.size(); ++j) {
        const std::string& name = rig.joints[j].name;
        const auto named = options.joints.find(name);
        if (named != options.joints.end()) {
            map.motionJoint.push_back(named->second.empty() ? -1 : motionJoints.at(named->second));
            continue;
        }
        const int found = byRole(map, j);
        map.motionJoint.push_back(found >= 0 ? found : byName(map, motionJoints, name, j));
    }
    if (std::all_of(map.motionJoint.begin(), map.motionJoint.end(), [](int m) { return m < 0; }))
        throw Error("retarget: no joint of the rig has a joint of the same name in the motion");
    return map;
}

} // namespace osgSkin
