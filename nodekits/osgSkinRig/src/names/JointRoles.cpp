// SPDX-License-Identifier: MIT
#include <osgSkinRig/JointRoles>

#include "names/GapRoles.h"
#include "names/LimbWords.h"
#include "names/NameWords.h"
#include "names/ShapeRoles.h"
#include "names/WordRoles.h"

#include <set>
#include <utility>

namespace osgSkin {
namespace {

constexpr std::size_t kFewestRoles = 4;

/// Names that tell fewer of the 14 joints that every body has are worth less than a shape that
/// tells them all.
constexpr std::size_t kFewestMain = 8;

/// A family's names in the form in which they are compared.
struct Dictionary {
    explicit Dictionary(const JointNames& names) : family(names.name) {
        for (const auto& [role, members] : names.roles)
            for (const std::string& member : members) roleOf.emplace(plainName(member), role);
    }
    std::string family;
    std::map<std::string, std::string> roleOf;
};

const std::vector<Dictionary>& knownDictionaries() {
    static const std::vector<Dictionary> known(knownJointNames().begin(), knownJointNames().end());
    return known;
}

/// How many roles a family fills: a caller may give thousands of families.
std::size_t filledBy(const Dictionary& names, const std::set<std::string>& plainNames) {
    std::set<std::string> filled;
    for (const auto& [name, role] : names.roleOf)
        if (plainNames.count(name) != 0) filled.insert(role);
    return filled.size();
}

JointRoles rolesBy(const Dictionary& names, const std::vector<std::string>& plainNames) {
    JointRoles result;
    result.family = names.family;
    for (std::size_t j = 0; j < plainNames.size(); ++j) {
        const auto found = names.roleOf.find(plainNames[j]);
        result.roles.push_back(found == names.roleOf.end() ? std::string() : found->second);
        if (found != names.roleOf.end())
            result.joints[found->second].push_back(static_cast<int>(j));
    }
    return result;
}

/// The family that fills most roles; of `extra`, where `byCaller` is set.
JointRoles rolesByFamily(const RestSkeleton& skeleton, const std::vector<JointNames>& extra,
                         bool& byCaller) {
    JointRoles best;
    best.roles.resize(skeleton.joints.size());
    byCaller = false;
    std::vector<std::string> plainNames;
    for (const RestJoint& joint : skeleton.joints) plainNames.push_back(plainName(joint.name));
    const std::set<std::string> known(plainNames.begin(), plainNames.end());
    const auto consider = [&](const Dictionary& names, bool callers) {
        const std::size_t filled = filledBy(names, known);
        if (filled < kFewestRoles) return;
        if (best.known() && filled <= best.joints.size()) return;
        best = rolesBy(names, plainNames);
        byCaller = callers;
    };
    for (auto names = extra.rbegin(); names != extra.rend(); ++names)
        consider(Dictionary(*names), true);
    for (const Dictionary& names : knownDictionaries()) consider(names, false);
    return best;
}

/// How many of the joints that every body has are told.
std::size_t mainRoles(const std::vector<std::string>& roles) {
    static const std::set<std::string> kMain = [] {
        std::set<std::string> main{"Hips", "Head"};
        for (const std::string side : {"Left", "Right"})
            for (const char* part :
                 {"UpperLeg", "LowerLeg", "Foot", "UpperArm", "LowerArm", "Hand"})
                main.insert(side + part);
        return main;
    }();
    std::set<std::string> found;
    for (const std::string& role : roles)
        if (kMain.count(role) != 0) found.insert(role);
    return found.size();
}

JointRoles madeOf(const std::vector<std::string>& roles, const std::string& family) {
    JointRoles result;
    result.family = family;
    result.roles = roles;
    for (std::size_t j = 0; j < roles.size(); ++j)
        if (!roles[j].empty()) result.joints[roles[j]].push_back(static_cast<int>(j));
    return result;
}

/// Adds what the family has no name for: a body of Unity's names may have Mixamo's toes.
void complete(JointRoles& roles, const std::vector<std::string>& words) {
    const JointRoles other = madeOf(words, "");
    for (const auto& [role, joints] : other.joints) {
        if (roles.joints.count(role) != 0) continue;
        for (const int j : joints) {
            std::string& own = roles.roles[static_cast<std::size_t>(j)];
            if (!own.empty()) continue;
            own = role;
            roles.joints[role].push_back(j);
        }
    }
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
    const auto child = readName(nameWords(skeleton.joints[std::size_t(children[0])].name));
    const bool isUpperArm =
        child && (child->word == BodyWord::Arm || child->word == BodyWord::UpperArm);
    return isUpperArm ? JointPart::Collar : JointPart::UpperArm;
}

/// What a joint without a role is: a second hand or collar bone of a limb, or a joint of a skeleton
/// that has too few names to be known.
JointPart partByWords(const RestSkeleton& skeleton, int joint,
                      const std::optional<NameReading>& reading) {
    const std::string& name = skeleton.joints[static_cast<std::size_t>(joint)].name;
    const std::string bare = bareName(name);
    if (bare == "head") return JointPart::Head;
    if (bare == "hand" || bare == "wrist") return JointPart::Hand;
    if (bare == "foot" || bare == "ankle") return JointPart::Foot;
    if (bare == "shoulder") return shoulder(skeleton, joint);
    static const std::set<std::string> kPrefixes{"", "bip", "mixamorig", "def", "org"};
    if (!reading || kPrefixes.count(reading->prefix) == 0) return JointPart::Other;
    switch (reading->word) {
    case BodyWord::Thumb:
        return JointPart::Thumb;
    case BodyWord::Middle:
        return JointPart::MiddleFinger;
    case BodyWord::Collar:
        return JointPart::Collar;
    case BodyWord::HipJoint:
        return JointPart::HipJoint;
    case BodyWord::Shoulder:
        return shoulder(skeleton, joint);
    default:
        return JointPart::Other;
    }
}

std::string roleOfNameAlone(const std::string& name) {
    for (const Dictionary& names : knownDictionaries()) {
        const auto found = names.roleOf.find(plainName(name));
        if (found != names.roleOf.end()) return found->second;
    }
    const auto reading = readName(nameWords(name));
    // A leg is the thigh here and the shin there.
    if (!reading || reading->foreign || reading->word == BodyWord::Leg) return {};
    return limbRoles({{{name, -1, glm::dvec3(0.0), {}}}}, {reading})[0];
}

} // namespace

JointRoles recogniseJoints(const RestSkeleton& skeleton, const std::vector<JointNames>& extra) {
    bool byCaller = false;
    JointRoles result = rolesByFamily(skeleton, extra, byCaller);
    const WordRoles words = wordRoles(skeleton);
    std::size_t told = mainRoles(result.roles);
    if (!byCaller) {
        // Of a family's skeleton that has one name changed, the others keep what they mean there.
        if (mainRoles(words.roles) > told + (result.known() ? 1 : 0))
            result = madeOf(words.roles, kToldByWords);
        else if (result.known())
            complete(result, words.roles);
        told = mainRoles(result.roles);
        if (told < kFewestMain) {
            const std::vector<std::string> shape = shapeRoles(skeleton);
            if (mainRoles(shape) > told) result = madeOf(shape, kToldByShape);
        }
        if (result.known()) {
            fillGaps(skeleton, result.roles);
            result = madeOf(result.roles, result.family);
        }
    }
    for (std::size_t j = 0; j < skeleton.joints.size(); ++j) {
        const std::string& role = result.roles[j];
        result.parts.push_back(role.empty()
                                   ? partByWords(skeleton, static_cast<int>(j), words.readings[j])
                                   : partOfRole(role));
    }
    return result;
}

std::vector<std::string> recogniseNames(const std::vector<std::string>& names) {
    RestSkeleton list; // that no tree orders
    list.add({}, -1, glm::dvec3(0.0));
    for (const std::string& name : names) list.add(name, 0, glm::dvec3(0.0));
    std::vector<std::string> roles = recogniseJoints(list).roles;
    roles.erase(roles.begin());
    for (std::size_t n = 0; n < names.size(); ++n)
        if (roles[n].empty()) roles[n] = roleOfNameAlone(names[n]);
    return roles;
}

} // namespace osgSkin
