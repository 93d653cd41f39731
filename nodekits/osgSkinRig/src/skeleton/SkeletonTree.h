// SPDX-License-Identifier: MIT
#ifndef OSGSKINRIG_SKELETON_SKELETONTREE_H
#define OSGSKINRIG_SKELETON_SKELETONTREE_H

#include <osgSkinRig/RestSkeleton>

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include <cmath>
#include <cstddef>
#include <vector>

namespace osgSkin {

/// The coordinate axis within 37 degrees of a direction: 1 to 3, negative for the opposite
/// direction; 0 where there is none, or the direction is zero.
inline int nearAxis(const glm::dvec3& direction) {
    for (int axis = 0; axis < 3; ++axis)
        if (std::abs(direction[axis]) > 0.8 * glm::length(direction))
            return direction[axis] > 0.0 ? axis + 1 : -axis - 1;
    return 0;
}

/// The unit direction of an axis that nearAxis() returns.
inline glm::dvec3 alongAxis(int axis) {
    glm::dvec3 result(0.0);
    result[std::abs(axis) - 1] = axis > 0 ? 1.0 : -1.0;
    return result;
}

/// The positions of all joints.
inline std::vector<glm::dvec3> centresOf(const RestSkeleton& skeleton) {
    std::vector<glm::dvec3> result;
    for (const RestJoint& joint : skeleton.joints) result.push_back(joint.centre);
    return result;
}

/// A RestSkeleton with lists of children, for repeated traversals.
class SkeletonTree {
public:
    explicit SkeletonTree(const RestSkeleton& skeleton);

    const RestSkeleton& rest() const { return *_skeleton; }
    const RestJoint& joint(int j) const { return _skeleton->joints[static_cast<std::size_t>(j)]; }
    int size() const { return static_cast<int>(_skeleton->joints.size()); }
    const std::vector<int>& children(int j) const { return _children[static_cast<std::size_t>(j)]; }
    const glm::dvec3& centre(int j) const { return joint(j).centre; }

    /// Largest distance of a joint from the root, to which zero lengths are relative.
    double reach() const { return _reach; }

private:
    const RestSkeleton* _skeleton;
    std::vector<std::vector<int>> _children;
    double _reach = 0.0;
};

} // namespace osgSkin

#endif
