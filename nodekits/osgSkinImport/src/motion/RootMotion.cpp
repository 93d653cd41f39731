// SPDX-License-Identifier: MIT
#include "motion/RootMotion.h"

#include "text/FileText.h"

#include <glm/geometric.hpp>

namespace osgSkin {

bool isMoved(const glm::dvec3& position, const glm::dvec3& atRest) {
    return glm::distance(position, atRest) > 1e-3 * (1.0 + glm::length(atRest));
}

std::size_t rootMotionJoint(const RestSkeleton& skeleton, const std::vector<bool>& moved) {
    std::size_t result = 0;
    for (int j = 0;;) {
        const std::vector<int> children = skeleton.children(j);
        if (moved[static_cast<std::size_t>(j)] && !children.empty())
            result = static_cast<std::size_t>(j);
        if (children.size() != 1) return result;
        j = children[0];
    }
}

RestSkeleton skeletonFrom(const RestSkeleton& skeleton, std::size_t root) {
    RestSkeleton result;
    for (std::size_t j = root; j < skeleton.joints.size(); ++j) {
        result.joints.push_back(skeleton.joints[j]);
        result.joints.back().parent -= static_cast<int>(root);
    }
    result.joints[0].parent = -1;
    return result;
}

void noticeUnusedMoves(const RestSkeleton& skeleton, const std::vector<bool>& moved,
                       std::size_t root, const std::string& path) {
    for (std::size_t j = root + 1; j < moved.size(); ++j) {
        if (!moved[j]) continue;
        tellOf(path, "joint \"" + skeleton.joints[j].name +
                         "\" moves from its place; only moves of \"" + skeleton.joints[root].name +
                         "\" are used");
        return;
    }
}

} // namespace osgSkin
