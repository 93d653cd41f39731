// SPDX-License-Identifier: MIT
#include "retarget/RetargetNotes.h"

#include <algorithm>

namespace osgSkin {
namespace {

const char* const kEssential[] = {
    "Hips",         "Spine",         "Head",          "LeftUpperArm",  "LeftLowerArm",
    "LeftHand",     "RightUpperArm", "RightLowerArm", "RightHand",     "LeftUpperLeg",
    "LeftLowerLeg", "LeftFoot",      "RightUpperLeg", "RightLowerLeg", "RightFoot"};

/// The joints of essential roles for all of whose joints `isIdle` holds: the first of each role.
template <typename Idle>
std::vector<std::string> idleJoints(const JointRoles& roles, const RestSkeleton& skeleton,
                                    const Idle& isIdle) {
    std::vector<std::string> result;
    for (const char* role : kEssential) {
        const auto found = roles.joints.find(role);
        if (found != roles.joints.end() &&
            std::all_of(found->second.begin(), found->second.end(), isIdle))
            result.push_back(skeleton.joints[static_cast<std::size_t>(found->second[0])].name);
    }
    return result;
}

std::string listed(const std::vector<std::string>& names) {
    constexpr std::size_t kMost = 4;
    std::string result;
    for (std::size_t i = 0; i < std::min(names.size(), kMost); ++i)
        result += (i == 0 ? "\"" : ", \"") + names[i] + "\"";
    if (names.size() > kMost) result += " and " + std::to_string(names.size() - kMost) + " more";
    return result;
}

/// What a skeleton's shape told, where its names say nothing: a person had better look.
void noteShape(const JointRoles& roles, const RestSkeleton& skeleton, const std::string& whose,
               std::vector<std::string>& notes) {
    if (roles.family != kToldByShape) return;
    std::string told;
    for (const auto& [role, joints] : roles.joints)
        for (const char* shown : {"Hips", "Head", "LeftUpperArm", "LeftUpperLeg"})
            if (role == shown)
                told += (told.empty() ? "" : ", ") + role + " is \"" +
                        skeleton.joints[static_cast<std::size_t>(joints[0])].name + "\"";
    notes.push_back("the " + whose +
                    "'s joint names say nothing, its parts are told by its shape: " + told);
}

/// Where names alone tell, joints that are left over on both sides may be the same ones, spelled in
/// two ways.
void noteLeftOver(const JointPairs& map, const RestSkeleton& rig, const RestSkeleton& motion,
                  const RetargetOptions& options, const std::string& expected,
                  std::vector<std::string>& notes) {
    const std::vector<int>& drivers = map.motionJoint;
    std::vector<std::string> still, unused;
    for (std::size_t j = 0; j < rig.joints.size(); ++j)
        if (drivers[j] < 0 && options.joints.count(rig.joints[j].name) == 0)
            still.push_back(rig.joints[j].name);
    for (std::size_t m = 0; m < motion.joints.size(); ++m)
        if (std::find(drivers.begin(), drivers.end(), int(m)) == drivers.end())
            unused.push_back(motion.joints[m].name);
    if (!still.empty() && !unused.empty())
        notes.push_back("the motion has nothing for " + listed(still) +
                        " of the rig, and the rig nothing for " + listed(unused) +
                        " of the motion" + expected);
}

} // namespace

std::vector<std::string> notesOf(const JointPairs& map, const RestSkeleton& rig,
                                 const RestSkeleton& motion, const RetargetOptions& options) {
    const std::vector<int>& drivers = map.motionJoint;
    const std::string expected =
        "; expected joints of the same names, names of a known family, or a map";
    std::vector<std::string> notes;
    noteShape(map.rig, rig, "rig", notes);
    noteShape(map.motion, motion, "motion", notes);
    if (map.rig.known()) {
        const auto idle = idleJoints(map.rig, rig, [&](int j) {
            const auto joint = static_cast<std::size_t>(j);
            return drivers[joint] < 0 && options.joints.count(rig.joints[joint].name) == 0;
        });
        if (!idle.empty())
            notes.push_back("the motion has nothing for " + listed(idle) +
                            " of the rig, which stay as they rest" + expected);
    }
    if (map.motion.known()) {
        const auto idle = idleJoints(map.motion, motion, [&](int j) {
            return std::find(drivers.begin(), drivers.end(), j) == drivers.end();
        });
        if (!idle.empty())
            notes.push_back("the rig has nothing for " + listed(idle) + " of the motion" +
                            expected);
    }
    if (map.rig.known() || map.motion.known()) return notes;
    const auto driven = static_cast<std::size_t>(
        std::count_if(drivers.begin(), drivers.end(), [](int m) { return m >= 0; }));
    if (2 * driven < std::min(rig.joints.size(), motion.joints.size()))
        notes.push_back("only " + std::to_string(driven) + " of the rig's " +
                        std::to_string(rig.joints.size()) + " joints match one of the motion's " +
                        std::to_string(motion.joints.size()) + expected);
    else
        noteLeftOver(map, rig, motion, options, expected, notes);
    return notes;
}

} // namespace osgSkin
