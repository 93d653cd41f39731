// SPDX-License-Identifier: MIT
#include "scene/RootJoint.h"

#include "files/FileText.h"

#include <osgSkinRig/JointRoles>

#include <glm/geometric.hpp>

#include <algorithm>

namespace osgSkin {
namespace {

/// For each joint, whether both upper legs are below it.
std::vector<bool> leadsToBothLegs(const RestSkeleton& skeleton) {
    const JointRoles roles = recogniseJoints(skeleton);
    std::vector<int> legs(skeleton.joints.size(), 0);
    for (const char* role : {"LeftUpperLeg", "RightUpperLeg"}) {
        const auto found = roles.joints.find(role);
        if (found == roles.joints.end()) continue;
        for (int a = skeleton.joints[static_cast<std::size_t>(found->second.front())].parent;
             a >= 0; a = skeleton.joints[static_cast<std::size_t>(a)].parent)
            ++legs[static_cast<std::size_t>(a)];
    }
    std::vector<bool> result(legs.size());
    for (std::size_t j = 0; j < legs.size(); ++j) result[j] = legs[j] == 2;
    return result;
}

} // namespace

bool isMoved(const glm::dvec3& position, const glm::dvec3& atRest) {
    return glm::distance(position, atRest) > 1e-3 * (1.0 + glm::length(atRest));
}

std::size_t rootMotionJoint(const RestSkeleton& skeleton, const std::vector<bool>& moved) {
    const std::vector<bool> towardsLegs = leadsToBothLegs(skeleton);
    std::size_t result = 0;
    for (int j = 0;;) {
        const std::vector<int> children = skeleton.children(j);
        if (moved[static_cast<std::size_t>(j)] && !children.empty())
            result = static_cast<std::size_t>(j);
        const auto next = children.size() == 1
                              ? children.begin()
                              : std::find_if(children.begin(), children.end(), [&](int c) {
                                    return towardsLegs[static_cast<std::size_t>(c)];
                                });
        if (next == children.end()) return result;
        j = *next;
    }
}

ReducedSkeleton::ReducedSkeleton(const RestSkeleton& skeleton, std::size_t root) {
    for (int a = skeleton.joints[root].parent; a >= 0;
         a = skeleton.joints[static_cast<std::size_t>(a)].parent)
        above.push_back(static_cast<std::size_t>(a));
    std::reverse(above.begin(), above.end());
    constexpr int kOpen = -1;
    std::vector<int> newIndex(skeleton.joints.size(), kOpen);
    newIndex[root] = 0;
    for (const std::size_t a : above) newIndex[a] = 0; // maps to the root
    joints.push_back(root);
    for (std::size_t j = 0; j < skeleton.joints.size(); ++j) {
        if (newIndex[j] != kOpen) continue;
        newIndex[j] = static_cast<int>(joints.size());
        joints.push_back(j);
    }
    for (const std::size_t j : joints) {
        rest.joints.push_back(skeleton.joints[j]);
        int& parent = rest.joints.back().parent;
        parent = j == root ? -1 : newIndex[static_cast<std::size_t>(parent)];
    }
}

void warnUnusedMoves(const RestSkeleton& skeleton, const std::vector<bool>& moved,
                     const ReducedSkeleton& carried, const std::string& path) {
    constexpr std::size_t kMaxNames = 6;
    const std::vector<std::size_t>& joints = carried.joints;
    std::string names;
    std::size_t count = 0;
    for (std::size_t i = 1; i < joints.size(); ++i) {
        if (!moved[joints[i]]) continue;
        if (++count <= kMaxNames)
            names += (count > 1 ? ", " : "") + inQuotes(skeleton.joints[joints[i]].name);
    }
    if (count > kMaxNames) names += " and " + std::to_string(count - kMaxNames) + " more";
    if (count > 0)
        warn(path, (count == 1 ? "joint " + names + " is" : "joints " + names + " are") +
                       " translated; only translations of " +
                       inQuotes(skeleton.joints[joints.front()].name) + " are used");
}

} // namespace osgSkin
