// SPDX-License-Identifier: MIT
#pragma once

#include <osgSkinRig/RestSkeleton>

#include <glm/vec3.hpp>

#include <cstddef>
#include <vector>

namespace osgSkin {

/// A RestSkeleton with its children's lists, for walking it many times.
class SkeletonTree {
public:
    explicit SkeletonTree(const RestSkeleton& skeleton);

    const RestSkeleton& rest() const { return *_skeleton; }
    const RestJoint& joint(int j) const { return _skeleton->joints[static_cast<std::size_t>(j)]; }
    int size() const { return static_cast<int>(_skeleton->joints.size()); }
    const std::vector<int>& children(int j) const { return _children[static_cast<std::size_t>(j)]; }
    const glm::dvec3& centre(int j) const { return joint(j).centre; }

    /// Largest distance of a joint from the root: a measure for what counts as zero length.
    double reach() const { return _reach; }

private:
    const RestSkeleton* _skeleton;
    std::vector<std::vector<int>> _children;
    double _reach = 0.0;
};

} // namespace osgSkin
