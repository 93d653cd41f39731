// SPDX-License-Identifier: MIT
#include <osgSkinRig/JointRoles>

#include "names/NameReading.h"
#include "names/NameWords.h"
#include "names/RoleTree.h"
#include "names/Sides.h"

#include <osgSkinRig/RestSkeleton>

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace osgSkin {
namespace {

class Filler {
public:
    Filler(const RestSkeleton& skeleton, std::vector<std::string>& roles)
        : _skeleton(skeleton), _roles(roles) {}

    void fill() {
        for (const std::string side : {"Left", "Right"}) {
            fillLimb(side + "UpperLeg", side + "LowerLeg", side + "Foot", {side + "Toe"});
            fillLimb(side + "UpperArm", side + "LowerArm", side + "Hand",
                     {side + "Middle1", side + "Index1", side + "Thumb1", side + "Fingers"});
        }
        fillTrunk();
    }

private:
    std::string& role(int j) { return _roles[static_cast<std::size_t>(j)]; }
    const RestJoint& joint(int j) const { return _skeleton.joints[static_cast<std::size_t>(j)]; }

    int find(const std::string& wanted) const {
        const auto found = std::find(_roles.begin(), _roles.end(), wanted);
        return found == _roles.end() ? -1 : static_cast<int>(found - _roles.begin());
    }

    bool isFree(int j) {
        const std::vector<std::string> words = nameWords(joint(j).name);
        return role(j).empty() && !isPivot(joint(j).name) &&
               std::none_of(words.begin(), words.end(), isAccessory);
    }

    /// The joints without a role between two joints, the lowest first; none where `below` is no
    /// descendant of `above`.
    std::vector<int> freeBetween(int above, int below) {
        std::vector<int> result;
        if (above < 0 || below < 0 || !_skeleton.isInSubtree(below, above)) return result;
        for (int j = joint(below).parent; j >= 0 && j != above; j = joint(j).parent)
            if (isFree(j)) result.push_back(j);
        return result;
    }

    /// The joint without a role that is nearest to the middle between two joints.
    int middle(int above, int below) {
        int best = -1;
        double nearest = 0.0;
        for (const int j : freeBetween(above, below)) {
            const double off = std::abs(glm::distance(joint(j).centre, joint(above).centre) -
                                        glm::distance(joint(j).centre, joint(below).centre));
            if (best >= 0 && off >= nearest) continue;
            best = j;
            nearest = off;
        }
        return best;
    }

    /// The joint without a role directly above the fingers or toes, or else the only child.
    int endOf(int lower, const std::vector<std::string>& below) {
        for (const std::string& hung : below) {
            const std::vector<int> free = freeBetween(lower, find(hung));
            if (!free.empty()) return free.front();
        }
        int only = -1;
        for (const int child : _skeleton.children(lower)) {
            if (!isFree(child)) continue;
            if (only >= 0) return -1;
            only = child;
        }
        return only;
    }

    void fillLimb(const std::string& upper, const std::string& lower, const std::string& end,
                  const std::vector<std::string>& below) {
        const int top = find(upper);
        if (find(end) < 0 && find(lower) >= 0) give(endOf(find(lower), below), end);
        if (find(lower) < 0) give(middle(top, find(end)), lower);
    }

    void fillTrunk() {
        const int left = find("LeftUpperArm"), right = find("RightUpperArm");
        if (left < 0 || right < 0) return;
        const int hips = find("Hips"), chest = commonAncestor(_skeleton, left, right);
        if (chest < 0 || chest == hips) return;
        if (hips >= 0 && _skeleton.isInSubtree(chest, hips)) {
            for (const int j : freeBetween(hips, chest)) give(j, "Spine");
            if (isFree(chest)) give(chest, "Spine");
        }
        for (const int j : freeBetween(chest, find("Head"))) give(j, "Neck");
        for (const auto& [side, arm] : {std::make_pair("Left", left), {"Right", right}}) {
            const std::vector<int> free = freeBetween(chest, arm);
            const std::string collar = std::string(side) + "Collar";
            if (free.size() == 1 && find(collar) < 0) give(free[0], collar);
        }
    }

    void give(int j, const std::string& to) {
        if (j >= 0) role(j) = to;
    }

    const RestSkeleton& _skeleton;
    std::vector<std::string>& _roles;
};

/// Gives unrecognised joints the role that follows from their position in the tree: the
/// knee between a thigh and its foot, the foot above the toes, the hand above its fingers or alone
/// below the lower arm, the spine from the hips up to the joint that carries both arms, the neck
/// from there to the head, the collar bone before an arm. Skips joints whose names say that
/// they are helpers (twists, ends, props), and keeps existing roles.
/// \param roles [joint] as in JointNames, empty for none
void inferMissingRoles(const RestSkeleton& skeleton, std::vector<std::string>& roles) {
    Filler(skeleton, roles).fill();
}

constexpr std::size_t kMinRoles = 4;

/// Names that identify fewer of the 14 joints that every body has are worth less than a shape that
/// identifies all of them.
constexpr std::size_t kMinMain = 8;

/// A family's names, normalised for comparison.
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

/// The family that fills most roles; where `byCaller` is set, it is one of `extra`.
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
        if (filled < kMinRoles) return;
        if (best.known() && filled <= best.joints.size()) return;
        best = rolesBy(names, plainNames);
        byCaller = callers;
    };
    for (auto names = extra.rbegin(); names != extra.rend(); ++names)
        consider(Dictionary(*names), true);
    for (const Dictionary& names : knownDictionaries()) consider(names, false);
    return best;
}

/// How many of the joints that every body has are identified.
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

/// Adds roles for which the family has no name: a body with Unity's names may have Mixamo's toes.
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

/// "Shoulder" is the collar bone in some skeletons and the upper arm in others: its children
/// decide.
JointPart shoulder(const RestSkeleton& skeleton, int joint) {
    const std::vector<int> children = skeleton.children(joint);
    if (children.size() != 1) return JointPart::UpperArm;
    const auto child = readName(nameWords(skeleton.joints[std::size_t(children[0])].name));
    const bool isUpperArm =
        child && (child->word == BodyWord::Arm || child->word == BodyWord::UpperArm);
    return isUpperArm ? JointPart::Collar : JointPart::UpperArm;
}

/// The part of a joint without a role: a second hand or collar bone of a limb, or a joint of a
/// skeleton with too few known names.
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

/// The roles of a skeleton's joints as one figure.
JointRoles rolesOfFigure(const RestSkeleton& skeleton, const std::vector<JointNames>& extra) {
    bool byCaller = false;
    JointRoles result = rolesByFamily(skeleton, extra, byCaller);
    const WordRoles words = wordRoles(skeleton);
    std::size_t identified = mainRoles(result.roles);
    std::vector<std::string> stated;
    for (const RestJoint& joint : skeleton.joints) stated.push_back(joint.role);
    if (!byCaller && mainRoles(stated) >= kMinMain) {
        inferMissingRoles(skeleton, stated);
        result = madeOf(stated, kStatedByFile);
    } else if (!byCaller) {
        // Where one name of a family's skeleton was changed, the other names keep their meaning.
        if (mainRoles(words.roles) > identified + (result.known() ? 1 : 0))
            result = madeOf(words.roles, kMixedNames);
        else if (result.known())
            complete(result, words.roles);
        identified = mainRoles(result.roles);
        if (identified < kMinMain) {
            const std::vector<std::string> shape = shapeRoles(skeleton);
            if (mainRoles(shape) > identified) result = madeOf(shape, kInferredFromGeometry);
        }
        if (result.known()) {
            inferMissingRoles(skeleton, result.roles);
            result = madeOf(result.roles, result.family);
            if (areSidesExchanged(skeleton, result)) exchangeSides(result);
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

constexpr std::size_t kMinFigure = 12; ///< joints

/// A part of a skeleton: a joint and all joints below it.
struct Figure {
    std::vector<int> joints; ///< the topmost first
    JointRoles roles;        ///< of these
};

/// The figures of a skeleton that has several, side by side, recognised by their names.
std::vector<Figure> figuresOf(const RestSkeleton& skeleton, const std::vector<JointNames>& extra) {
    if (skeleton.joints.size() < 2 * kMinFigure) return {};
    std::vector<std::vector<int>> children(skeleton.joints.size());
    std::vector<std::size_t> below(skeleton.joints.size(), 1);
    for (std::size_t j = skeleton.joints.size(); j-- > 1;) {
        const auto parent = static_cast<std::size_t>(skeleton.joints[j].parent);
        children[parent].push_back(static_cast<int>(j));
        below[parent] += below[j];
    }
    const auto isLarge = [&](int j) { return below[static_cast<std::size_t>(j)] >= kMinFigure; };
    std::vector<int> large{0};
    while (large.size() == 1) {
        std::vector<int>& next = children[static_cast<std::size_t>(large.front())];
        next.erase(std::partition(next.begin(), next.end(), isLarge), next.end());
        large = next;
    }
    std::sort(large.begin(), large.end());
    std::vector<Figure> result;
    for (const int top : large) {
        Figure figure;
        RestSkeleton own;
        std::vector<int> indexOf(skeleton.joints.size(), -1);
        for (auto j = static_cast<std::size_t>(top); j < skeleton.joints.size(); ++j) {
            const RestJoint& joint = skeleton.joints[j];
            const bool isTop = static_cast<int>(j) == top;
            if (!isTop && indexOf[static_cast<std::size_t>(joint.parent)] < 0) continue;
            indexOf[j] = static_cast<int>(own.joints.size());
            own.joints.push_back(joint);
            own.joints.back().parent = isTop ? -1 : indexOf[static_cast<std::size_t>(joint.parent)];
            figure.joints.push_back(static_cast<int>(j));
        }
        figure.roles = rolesOfFigure(own, extra);
        if (mainRoles(figure.roles.roles) >= kMinMain &&
            figure.roles.family != kInferredFromGeometry)
            result.push_back(std::move(figure));
    }
    if (result.size() < 2) result.clear();
    return result;
}

} // namespace

JointRoles recogniseJoints(const RestSkeleton& skeleton, const std::vector<JointNames>& extra) {
    JointRoles result = rolesOfFigure(skeleton, extra);
    const std::vector<Figure> figures = figuresOf(skeleton, extra);
    if (figures.empty()) return result;
    const Figure& first = figures.front();
    result.roles.assign(skeleton.joints.size(), {});
    for (std::size_t j = 0; j < first.joints.size(); ++j)
        result.roles[static_cast<std::size_t>(first.joints[j])] = first.roles.roles[j];
    std::vector<JointPart> parts = std::move(result.parts);
    result = madeOf(result.roles, first.roles.family);
    result.parts = std::move(parts); // a head is one in every figure
    return result;
}

std::vector<int> topsOfFigures(const RestSkeleton& skeleton, const std::vector<JointNames>& extra) {
    std::vector<int> result;
    for (const Figure& figure : figuresOf(skeleton, extra)) result.push_back(figure.joints.front());
    return result;
}

std::vector<std::string> recogniseNames(const std::vector<std::string>& names) {
    RestSkeleton list; // without a hierarchy
    list.add({}, -1, glm::dvec3(0.0));
    for (const std::string& name : names) list.add(name, 0, glm::dvec3(0.0));
    std::vector<std::string> roles = recogniseJoints(list).roles;
    roles.erase(roles.begin());
    for (std::size_t n = 0; n < names.size(); ++n)
        if (roles[n].empty()) roles[n] = roleOfNameAlone(names[n]);
    return roles;
}

} // namespace osgSkin
