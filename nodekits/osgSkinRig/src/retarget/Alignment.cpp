// SPDX-License-Identifier: MIT
#include "retarget/Alignment.h"

#include "retarget/BodyParts.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace osgSkin {
namespace {

bool hasLength(const glm::dvec3& bone, const SkeletonTree& tree) {
    return glm::length(bone) > 1e-6 * tree.reach();
}

/// Which of a joint's children carries the chain on: the middle finger before the others, and those
/// before the thumb.
int rank(const std::string& name) {
    if (nameContains(name, "thumb")) return 2;
    return nameContains(name, "mid") ? 0 : 1;
}

/// A joint's bone within one skeleton: to its tip, or else to the child that carries the chain on.
std::optional<glm::dvec3> ownBone(const SkeletonTree& tree, int j) {
    std::optional<glm::dvec3> result;
    if (tree.joint(j).tip) result = *tree.joint(j).tip - tree.centre(j);
    int best = 3;
    if (!result || !hasLength(*result, tree))
        for (const int child : tree.children(j)) {
            const glm::dvec3 bone = tree.centre(child) - tree.centre(j);
            const int childRank = rank(tree.joint(child).name);
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

class BoneFinder {
public:
    BoneFinder(const SkeletonTree& rig, const SkeletonTree& motion,
               const std::vector<int>& motionJoint)
        : _rig(rig), _motion(motion), _motionJoint(motionJoint) {}

    std::optional<BonePair> find(int j) const {
        std::optional<BonePair> result;
        int best = 3;
        std::vector<int> open = _rig.children(j);
        while (!open.empty()) {
            const int below = open.back();
            open.pop_back();
            const std::optional<BonePair> bone = boneTo(j, below);
            const int childRank = rank(_rig.joint(below).name);
            if (bone && childRank < best) {
                best = childRank;
                result = bone;
            }
            // The joint may stand between two that match, or in its parent's place.
            if (!bone)
                open.insert(open.end(), _rig.children(below).begin(), _rig.children(below).end());
        }
        if (result) return result;
        const std::optional<glm::dvec3> rigBone = ownBone(_rig, j);
        const std::optional<glm::dvec3> motionBone = ownBone(_motion, driver(j));
        if (rigBone && motionBone) result = BonePair{*rigBone, *motionBone};
        return result;
    }

private:
    int driver(int j) const { return _motionJoint[static_cast<std::size_t>(j)]; }

    std::optional<BonePair> boneTo(int j, int below) const {
        const int from = driver(j);
        const int to = driver(below);
        if (to < 0 || to == from || !_motion.rest().isInSubtree(to, from)) return std::nullopt;
        const BonePair bone{_rig.centre(below) - _rig.centre(j),
                            _motion.centre(to) - _motion.centre(from)};
        if (!hasLength(bone.rig, _rig) || !hasLength(bone.motion, _motion)) return std::nullopt;
        return bone;
    }

    const SkeletonTree& _rig;
    const SkeletonTree& _motion;
    const std::vector<int>& _motionJoint;
};

} // namespace

std::optional<BonePair> findBone(const SkeletonTree& rig, const SkeletonTree& motion,
                                 const std::vector<int>& motionJoint, int j) {
    return BoneFinder(rig, motion, motionJoint).find(j);
}

glm::dquat shortestTurn(const glm::dvec3& from, const glm::dvec3& to) {
    const glm::dvec3 a = glm::normalize(from);
    const glm::dvec3 b = glm::normalize(to);
    const glm::dvec3 sum = a + b;
    if (glm::dot(sum, sum) < 1e-20) {
        // Opposite directions: half a turn about any axis across the bone.
        const glm::dvec3 helper = std::abs(a.x) < 0.6 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
        return {0.0, glm::normalize(glm::cross(a, helper))};
    }
    const glm::dvec3 half = glm::normalize(sum);
    return glm::normalize(glm::dquat(glm::dot(a, half), glm::cross(a, half)));
}

std::vector<glm::dquat> alignBones(const SkeletonTree& rig, const SkeletonTree& motion,
                                   const std::vector<int>& motionJoint) {
    const BodyParts parts = findBodyParts(rig);
    const glm::dquat identity(1.0, 0.0, 0.0, 0.0);
    std::vector<glm::dquat> result(motionJoint.size(), identity);
    for (int j = 0; j < rig.size(); ++j) {
        const auto index = static_cast<std::size_t>(j);
        if (!parts.isLimb[index]) continue;
        std::optional<BonePair> bone;
        if (motionJoint[index] >= 0) bone = findBone(rig, motion, motionJoint, j);
        if (bone && std::count(parts.feet.begin(), parts.feet.end(), j) > 0)
            bone = alongFloor(*bone);
        if (bone)
            result[index] = shortestTurn(bone->rig, bone->motion);
        else
            result[index] = result[static_cast<std::size_t>(rig.joint(j).parent)];
    }
    return result;
}

} // namespace osgSkin
