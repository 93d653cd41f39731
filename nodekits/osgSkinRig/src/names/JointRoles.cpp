// SPDX-License-Identifier: MIT
#include <osgSkinRig/JointRoles>

#include "names/NameWords.h"

#include <utility>

namespace osgSkin {
namespace {

constexpr std::size_t kFewestRoles = 4;

JointRoles rolesBy(const JointNames& names, const RestSkeleton& skeleton) {
    std::map<std::string, std::string> roleOf;
    for (const auto& [role, members] : names.roles)
        for (const std::string& member : members) roleOf.emplace(plainName(member), role);
    JointRoles result;
    result.family = names.name;
    for (std::size_t j = 0; j < skeleton.joints.size(); ++j) {
        const auto found = roleOf.find(plainName(skeleton.joints[j].name));
        result.roles.push_back(found == roleOf.end() ? std::string() : found->second);
        if (found != roleOf.end()) result.joints[found->second].push_back(static_cast<int>(j));
    }
    return result;
}

JointRoles rolesByFamily(const RestSkeleton& skeleton, const std::vector<JointNames>& extra) {
    JointRoles best;
    best.roles.resize(skeleton.joints.size());
    const auto consider = [&](const JointNames& names) {
        JointRoles roles = rolesBy(names, skeleton);
        if (roles.joints.size() < kFewestRoles) return;
        if (!best.known() || roles.joints.size() > best.joints.size()) best = std::move(roles);
    };
    for (auto names = extra.rbegin(); names != extra.rend(); ++names) consider(*names);
    for (const JointNames& names : knownJointNames()) consider(names);
    return best;
}

JointPart partOfRole(const std::string& role) {
    static const std::map<std::string, JointPart> kParts = [] {
        std::map<std::string, JointPart> parts{{"Head", JointPart::Head}};
        for (const std::string side : {"Left", "Right"}) {
            parts[side + "Collar"] = JointPart::Collar;
            parts[side + "UpperArm"] = JointPart::UpperArm;
            parts[side + "Hand"] = JointPart::Hand;
            parts[side + "HipJoint"] = JointPart::HipJoint;
            parts[side + "Foot"] = JointPart::Foot;
            for (const std::string joint : {"1", "2", "3"}) {
                parts[side + "Thumb" + joint] = JointPart::Thumb;
                parts[side + "Middle" + joint] = JointPart::MiddleFinger;
            }
        }
        return parts;
    }();
    const auto found = kParts.find(role);
    return found == kParts.end() ? JointPart::Other : found->second;
}

/// A shoulder is the collar bone in some skeletons and the upper arm in others: what hangs on it
/// tells.
JointPart shoulder(const RestSkeleton& skeleton, int joint) {
    const std::vector<int> children = skeleton.children(joint);
    if (children.size() != 1) return JointPart::UpperArm;
    const std::string& child = skeleton.joints[static_cast<std::size_t>(children[0])].name;
    const bool isUpperArm = (nameContains(child, "arm") && !nameContains(child, "fore") &&
                             !nameContains(child, "lower")) ||
                            nameContains(child, "shldr");
    return isUpperArm ? JointPart::Collar : JointPart::UpperArm;
}

JointPart partByWords(const RestSkeleton& skeleton, int joint) {
    const std::string& name = skeleton.joints[static_cast<std::size_t>(joint)].name;
    const std::string bare = bareName(name);
    if (bare == "head") return JointPart::Head;
    if (bare == "hand" || bare == "wrist") return JointPart::Hand;
    if (bare == "foot" || bare == "ankle") return JointPart::Foot;
    if (bare.find("thumb") != std::string::npos) return JointPart::Thumb;
    for (const char* word : {"collar", "clavicle"})
        if (nameContains(name, word)) return JointPart::Collar;
    for (const char* word : {"hipjoint", "buttock"})
        if (nameContains(name, word)) return JointPart::HipJoint;
    if (nameContains(name, "shoulder")) return shoulder(skeleton, joint);
    if (nameContains(name, "mid")) return JointPart::MiddleFinger;
    return JointPart::Other;
}

} // namespace

JointRoles recogniseJoints(const RestSkeleton& skeleton, const std::vector<JointNames>& extra) {
    JointRoles result = rolesByFamily(skeleton, extra);
    for (std::size_t j = 0; j < skeleton.joints.size(); ++j) {
        const std::string& role = result.roles[j];
        result.parts.push_back(role.empty() ? partByWords(skeleton, static_cast<int>(j))
                                            : partOfRole(role));
    }
    return result;
}

} // namespace osgSkin
