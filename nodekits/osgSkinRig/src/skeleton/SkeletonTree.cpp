// SPDX-License-Identifier: MIT
#include "skeleton/SkeletonTree.h"

#include <glm/geometric.hpp>

#include <algorithm>

namespace osgSkin {

SkeletonTree::SkeletonTree(const RestSkeleton& skeleton)
    : _skeleton(&skeleton), _children(skeleton.joints.size()) {
    for (int j = 0; j < size(); ++j) {
        if (joint(j).parent >= 0) _children[static_cast<std::size_t>(joint(j).parent)].push_back(j);
        _reach = std::max(_reach, glm::distance(centre(j), centre(0)));
    }
}

} // namespace osgSkin
