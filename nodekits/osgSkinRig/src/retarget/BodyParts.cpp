// SPDX-License-Identifier: MIT
#include "retarget/BodyParts.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cctype>
#include <limits>

namespace osgSkin {
namespace {

double bottom(const RestJoint& joint) {
    return joint.tip ? std::min(joint.centre.y, joint.tip->y) : joint.centre.y;
}

double top(const RestJoint& joint) {
    return joint.tip ? std::max(joint.centre.y, joint.tip->y) : joint.centre.y;
}

/// The joint called head, or the highest one in a skeleton without such a name.
int headOf(const SkeletonTree& tree) {
    int highest = 0;
    for (int j = 0; j < tree.size(); ++j) {
        const std::string& name = tree.joint(j).name;
        if (nameContains(name, "head") && !nameContains(name, "forehead")) return j;
        if (top(tree.joint(j)) > top(tree.joint(highest))) highest = j;
    }
    return highest;
}

/// Whether a child of the trunk only leads to a limb: a collar bone or the inside of a hip.
bool isGirdle(const SkeletonTree& tree, int j) {
    const std::string& name = tree.joint(j).name;
    for (const char* word : {"collar", "clavicle", "hipjoint", "buttock"})
        if (nameContains(name, word)) return true;
    const std::vector<int>& children = tree.children(j);
    if (children.size() != 1) return false;
    // A shoulder is the collar bone in some dialects and the upper arm in others.
    const std::string& child = tree.joint(children[0]).name;
    if (nameContains(name, "shoulder"))
        return (nameContains(child, "arm") && !nameContains(child, "fore") &&
                !nameContains(child, "lower")) ||
               nameContains(child, "shldr");
    // A joint in its parent's place has no bone of its own to align.
    return glm::distance(tree.centre(j), tree.centre(tree.joint(j).parent)) < 1e-6 * tree.reach();
}

std::vector<bool> findLimbs(const SkeletonTree& tree) {
    const auto count = static_cast<std::size_t>(tree.size());
    std::vector<bool> isTrunk(count, false);
    const int head = headOf(tree);
    for (int j = head; j >= 0; j = tree.joint(j).parent)
        isTrunk[static_cast<std::size_t>(j)] = true;
    std::vector<bool> isLimb(count, false);
    for (int j = 0; j < tree.size(); ++j) {
        const auto index = static_cast<std::size_t>(j);
        if (isTrunk[index]) continue;
        const auto parent = static_cast<std::size_t>(tree.joint(j).parent);
        const bool onHead = tree.rest().isInSubtree(j, head);
        isLimb[index] = !onHead && (isLimb[parent] || !isTrunk[parent] || !isGirdle(tree, j));
    }
    return isLimb;
}

} // namespace

bool nameContains(const std::string& name, const char* part) {
    std::string lower = name;
    for (char& c : lower) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return lower.find(part) != std::string::npos;
}

BodyParts findBodyParts(const SkeletonTree& tree) {
    BodyParts result;
    result.isLimb = findLimbs(tree);

    const auto isLimb = [&](int j) { return bool(result.isLimb[static_cast<std::size_t>(j)]); };
    const bool hasLimbs =
        std::find(result.isLimb.begin(), result.isLimb.end(), true) != result.isLimb.end();
    result.lowest = std::numeric_limits<double>::infinity();
    double highest = -result.lowest;
    for (int j = 0; j < tree.size(); ++j) {
        if (isLimb(j) || !hasLimbs) result.lowest = std::min(result.lowest, bottom(tree.joint(j)));
        highest = std::max(highest, top(tree.joint(j)));
    }
    // Hands hang to the thigh at most, ankles lie within a tenth of the body above the floor.
    const double ankle = result.lowest + 0.1 * (highest - result.lowest);
    for (int j = 0; j < tree.size(); ++j)
        if (isLimb(j) && bottom(tree.joint(j)) <= ankle) result.feet.push_back(j);
    for (const int j : result.feet)
        if (std::count(result.feet.begin(), result.feet.end(), tree.joint(j).parent) == 0)
            result.ankles.push_back(j);
    return result;
}

} // namespace osgSkin
