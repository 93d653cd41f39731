// SPDX-License-Identifier: MIT
// For callbacks that act on bones after others have moved them.
#ifndef OSGSKINMOTION_BONES_BONECALLBACKS_H
#define OSGSKINMOTION_BONES_BONECALLBACKS_H

#include <osgSkin/BoneReader>
#include <osgSkin/GlmOsg>

#include <osg/MatrixTransform>
#include <osg/Matrixd>
#include <osg/NodeVisitor>
#include <osg/ref_ptr>
#include <osgAnimation/Bone>
#include <osgAnimation/Skeleton>

#include <glm/geometric.hpp>

#include <map>
#include <string>

namespace osgSkin {

/// The rotation of a matrix that is not singular.
inline glm::dquat axesOf(const osg::Matrixd& matrix) {
    glm::dmat3 m(toGlm(matrix));
    for (int i = 0; i < 3; ++i) m[i] = glm::normalize(m[i]);
    if (glm::determinant(m) < 0.0) m = -m;
    return glm::normalize(glm::quat_cast(m));
}

/// The bones at and below a node by name, hidden ones, too; of several with one name, as those of a
/// rider, the topmost.
inline std::map<std::string, osgAnimation::Bone*> bonesBelow(osg::Node& node) {
    struct Find : osg::NodeVisitor {
        Find() : osg::NodeVisitor(TRAVERSE_ALL_CHILDREN) { setNodeMaskOverride(~0u); }
        void apply(osg::MatrixTransform& transform) override {
            if (auto* bone = dynamic_cast<osgAnimation::Bone*>(&transform))
                bones.emplace(bone->getName(), bone);
            traverse(transform);
        }
        std::map<std::string, osgAnimation::Bone*> bones;
    } find;
    node.accept(find);
    return find.bones;
}

/// The skeleton at or above a traversed node; null where there is none.
/// \param[out] path to the skeleton
inline osgAnimation::Skeleton* skeletonAbove(const osg::NodeVisitor& nv, osg::NodePath& path) {
    path = nv.getNodePath();
    while (!path.empty() && !dynamic_cast<osgAnimation::Skeleton*>(path.back())) path.pop_back();
    return path.empty() ? nullptr : static_cast<osgAnimation::Skeleton*>(path.back());
}

} // namespace osgSkin

#endif
