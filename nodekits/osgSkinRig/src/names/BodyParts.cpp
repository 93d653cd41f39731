// SPDX-License-Identifier: MIT
#include "names/BodyParts.h"

#include "names/NameWords.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <limits>
#include <string>

namespace osgSkin {
namespace {

double bottom(const RestJoint& joint) {
    return joint.tip ? std::min(joint.centre.y, joint.tip->y) : joint.centre.y;
}

double top(const RestJoint& joint) {
    return joint.tip ? std::max(joint.centre.y, joint.tip->y) : joint.centre.y;
}

/// The head, a joint whose name has a head in it, or the highest one in a skeleton without either.
int headOf(const SkeletonTree& tree, const JointRoles& roles) {
    int named = -1, highest = 0;
    for (int j = 0; j < tree.size(); ++j) {
        if (roles.is(static_cast<std::size_t>(j), JointPart::Head)) return j;
        const std::string& name = tree.joint(j).name;
        if (named < 0 && nameContains(name, "head") && !nameContains(name, "forehead")) named = j;
        if (top(tree.joint(j)) > top(tree.joint(highest))) highest = j;
    }
    return named >= 0 ? named : highest;
}

/// Whether a child of the trunk only leads to a limb: a collar bone or a hip joint.
bool isGirdle(const SkeletonTree& tree, const JointRoles& roles, int j) {
    const JointPart part = roles.parts[static_cast<std::size_t>(j)];
    if (part == JointPart::Collar || part == JointPart::HipJoint) return true;
    if (part == JointPart::UpperArm || tree.children(j).size() != 1) return false;
    // A joint at its parent's centre has no bone to align.
    return glm::distance(tree.centre(j), tree.centre(tree.joint(j).parent)) < 1e-6 * tree.reach();
}

std::vector<bool> findLimbs(const SkeletonTree& tree, const JointRoles& roles) {
    const auto count = static_cast<std::size_t>(tree.size());
    std::vector<bool> isTrunk(count, false);
    const int head = headOf(tree, roles);
    for (int j = head; j >= 0; j = tree.joint(j).parent)
        isTrunk[static_cast<std::size_t>(j)] = true;
    std::vector<bool> isLimb(count, false);
    for (int j = 0; j < tree.size(); ++j) {
        const auto index = static_cast<std::size_t>(j);
        if (isTrunk[index]) continue;
        const auto parent = static_cast<std::size_t>(tree.joint(j).parent);
        const bool onHead = tree.rest().isInSubtree(j, head);
        isLimb[index] =
            !onHead && (isLimb[parent] || !isTrunk[parent] || !isGirdle(tree, roles, j));
    }
    return isLimb;
}

/// The joints of recognised legs: from the first joint to the foot and its descendants, or all
/// descendants of the first joint where no foot is recognised.
std::vector<bool> knownLegs(const SkeletonTree& tree, const JointRoles& roles) {
    std::vector<bool> isLeg(static_cast<std::size_t>(tree.size()), false);
    for (const std::string side : {"Left", "Right"}) {
        int top = -1;
        for (const char* part : {"UpperLeg", "LowerLeg", "Foot"})
            if (top < 0) top = roles.joint(side + part);
        if (top < 0) continue;
        int end = roles.joint(side + "Foot");
        if (end < 0 || !tree.rest().isInSubtree(end, top)) end = top;
        for (int j = end; j < tree.size(); ++j)
            if (tree.rest().isInSubtree(j, end)) isLeg[static_cast<std::size_t>(j)] = true;
        for (int j = end; j != top; j = tree.joint(j).parent)
            isLeg[static_cast<std::size_t>(j)] = true;
        isLeg[static_cast<std::size_t>(top)] = true;
    }
    return isLeg;
}

/// Whether a joint is an ancestor of a recognised foot: when a figure sits on the floor, these are
/// as low as the feet.
bool isAboveFoot(const SkeletonTree& tree, const JointRoles& roles, int j) {
    for (const char* foot : {"LeftFoot", "RightFoot"}) {
        const int end = roles.joint(foot);
        if (end >= 0 && end != j && tree.rest().isInSubtree(end, j)) return true;
    }
    return false;
}

/// The height of the recognised joints, without helpers.
double knownTop(const SkeletonTree& tree, const JointRoles& roles) {
    double highest = -std::numeric_limits<double>::infinity();
    for (int j = 0; j < tree.size(); ++j)
        if (!roles.roles[static_cast<std::size_t>(j)].empty())
            highest = std::max(highest, top(tree.joint(j)));
    return highest;
}

} // namespace

BodyParts findBodyParts(const SkeletonTree& tree, const JointRoles& roles) {
    BodyParts result;
    result.isLimb = findLimbs(tree, roles);
    std::vector<bool> isLeg = knownLegs(tree, roles);
    const auto any = [](const std::vector<bool>& of) {
        return std::find(of.begin(), of.end(), true) != of.end();
    };
    const bool legsKnown = any(isLeg);
    if (!legsKnown) {
        isLeg = result.isLimb;
        result.stands = !roles.known();
    }
    const bool hasLegs = any(isLeg);
    result.lowest = std::numeric_limits<double>::infinity();
    double highest = legsKnown ? knownTop(tree, roles) : -result.lowest;
    for (int j = 0; j < tree.size(); ++j) {
        if (isLeg[static_cast<std::size_t>(j)] || !hasLegs)
            result.lowest = std::min(result.lowest, bottom(tree.joint(j)));
        if (!legsKnown) highest = std::max(highest, top(tree.joint(j)));
    }
    // Hands hang down to the thighs at most; ankles are within a tenth of the body's height above
    // the floor.
    const double ankle = result.lowest + 0.1 * (highest - result.lowest);
    for (int j = 0; j < tree.size() && result.stands; ++j)
        if (isLeg[static_cast<std::size_t>(j)] && bottom(tree.joint(j)) <= ankle &&
            !isAboveFoot(tree, roles, j))
            result.feet.push_back(j);
    for (const int j : result.feet)
        if (std::count(result.feet.begin(), result.feet.end(), tree.joint(j).parent) == 0)
            result.ankles.push_back(j);
    return result;
}

} // namespace osgSkin
