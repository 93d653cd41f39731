// SPDX-License-Identifier: MIT
#include "retarget/Alignment.h"

#include "names/BodyWord.h"
#include "names/NameWords.h"

#include <osgSkin/GlmTypes>

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace osgSkin {
namespace {

bool hasLength(const glm::dvec3& bone, const SkeletonTree& tree) {
    return glm::length(bone) > 1e-6 * tree.reach();
}

/// Which of a joint's children carries the chain on: the middle finger before the others, and those
/// before the thumb.
int rank(const JointRoles& roles, int j) {
    const JointPart part = roles.parts[static_cast<std::size_t>(j)];
    if (part == JointPart::Thumb) return 2;
    return part == JointPart::MiddleFinger ? 0 : 1;
}

/// Whether a hand's child is one of its fingers or its end, and not what the hand holds: that has
/// no role, and seldom a brother.
bool isOfHand(const SkeletonTree& tree, const JointRoles& roles, int hand, int child) {
    const auto isKnown = [&](int j) { return !roles.roles[static_cast<std::size_t>(j)].empty(); };
    if (isKnown(child) || rank(roles, child) != 1) return true;
    const std::vector<std::string> words = nameWords(tree.joint(child).name);
    const auto has = [&](const std::string& word) {
        return std::count(words.begin(), words.end(), word) > 0;
    };
    if (has("end") || has("nub") || has("tip") || has("finger") || has("fingers")) return true;
    if (std::any_of(words.begin(), words.end(), isForeign)) return false;
    const std::vector<int>& all = tree.children(hand);
    return all.size() > 1 && std::none_of(all.begin(), all.end(), isKnown);
}

/// A joint's bone within one skeleton: to its tip, or else to the child that carries the chain on.
std::optional<glm::dvec3> ownBone(const SkeletonTree& tree, const JointRoles& roles, int j) {
    std::optional<glm::dvec3> result;
    if (tree.joint(j).tip) result = *tree.joint(j).tip - tree.centre(j);
    int best = 3;
    const bool isHand = roles.is(static_cast<std::size_t>(j), JointPart::Hand);
    if (!result || !hasLength(*result, tree))
        for (const int child : tree.children(j)) {
            if (isHand && !isOfHand(tree, roles, j, child)) continue;
            const glm::dvec3 bone = tree.centre(child) - tree.centre(j);
            const int childRank = rank(roles, child);
            if (childRank >= best || !hasLength(bone, tree)) continue;
            best = childRank;
            result = bone;
        }
    if (result && !hasLength(*result, tree)) result.reset();
    return result;
}

/// A foot's bone falls from the ankle to the sole, more or less steeply from one skeleton to the
/// next, but both soles stand flat: where both feet lie, only their headings are to be aligned.
BonePair alongFloor(const BonePair& bone) {
    const auto lies = [](const glm::dvec3& b) { return std::abs(b.y) < 0.8 * glm::length(b); };
    if (!lies(bone.rig) || !lies(bone.motion)) return bone;
    return {{bone.rig.x, 0.0, bone.rig.z}, {bone.motion.x, 0.0, bone.motion.z}};
}

/// The bone from rig joint `j` to `below` and from the one's driver to the other's.
std::optional<BonePair> boneTo(const DrivenRig& body, int j, int below) {
    const int from = body.driver(j);
    const int to = body.driver(below);
    if (to < 0 || to == from || !body.motion.rest().isInSubtree(to, from)) return std::nullopt;
    const BonePair bone{body.rig.centre(below) - body.rig.centre(j),
                        body.motion.centre(to) - body.motion.centre(from)};
    if (!hasLength(bone.rig, body.rig) || !hasLength(bone.motion, body.motion)) return std::nullopt;
    return bone;
}

} // namespace

std::optional<BonePair> findBone(const DrivenRig& body, int j) {
    std::optional<BonePair> result;
    int best = 3;
    std::vector<int> open = body.rig.children(j);
    while (!open.empty()) {
        const int below = open.back();
        open.pop_back();
        const std::optional<BonePair> bone = boneTo(body, j, below);
        const int childRank = rank(body.map.rig, below);
        if (bone && childRank < best) {
            best = childRank;
            result = bone;
        }
        // The joint may stand between two that match, or where its parent is.
        if (!bone)
            open.insert(open.end(), body.rig.children(below).begin(),
                        body.rig.children(below).end());
    }
    if (result) return result;
    const std::optional<glm::dvec3> rigBone = ownBone(body.rig, body.map.rig, j);
    const std::optional<glm::dvec3> motionBone =
        ownBone(body.motion, body.map.motion, body.driver(j));
    if (rigBone && motionBone) result = BonePair{*rigBone, *motionBone};
    return result;
}

std::vector<glm::dquat> alignBones(const DrivenRig& body) {
    const BodyParts& parts = body.rigParts;
    const glm::dquat identity(1.0, 0.0, 0.0, 0.0);
    std::vector<glm::dquat> result(parts.isLimb.size(), identity);
    for (int j = 0; j < body.rig.size(); ++j) {
        const auto index = static_cast<std::size_t>(j);
        if (!parts.isLimb[index]) continue;
        std::optional<BonePair> bone;
        if (body.driver(j) >= 0) bone = findBone(body, j);
        if (bone && std::count(parts.feet.begin(), parts.feet.end(), j) > 0)
            bone = alongFloor(*bone);
        if (bone)
            result[index] = shortestRotation(bone->rig, bone->motion);
        else
            result[index] = result[static_cast<std::size_t>(body.rig.joint(j).parent)];
    }
    return result;
}

} // namespace osgSkin
