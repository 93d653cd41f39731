// SPDX-License-Identifier: MIT
// For callbacks that act on all bones of a skeleton after others have moved them.
#ifndef OSGSKINRIG_SKELETON_BONECALLBACKS_H
#define OSGSKINRIG_SKELETON_BONECALLBACKS_H

#include <osgSkin/BoneReader>
#include <osgSkin/GlmOsg>

#include <osg/Matrixd>
#include <osg/ref_ptr>
#include <osgAnimation/Bone>
#include <osgAnimation/Skeleton>

#include <glm/geometric.hpp>

namespace osgSkin {

/// The rotation of a matrix that is not singular.
inline glm::dquat axesOf(const osg::Matrixd& matrix) {
    glm::dmat3 m(toGlm(matrix));
    for (int i = 0; i < 3; ++i) m[i] = glm::normalize(m[i]);
    if (glm::determinant(m) < 0.0) m = -m;
    return glm::normalize(glm::quat_cast(m));
}

/// The callback of a class that some bone has; null where none has.
template <typename Callback>
Callback* callbackOf(osgAnimation::Skeleton& skeleton) {
    for (const auto& [name, bone] : bonesOf(skeleton))
        for (osg::Callback* c = bone->getUpdateCallback(); c; c = c->getNestedCallback())
            if (auto* found = dynamic_cast<Callback*>(c)) return found;
    return nullptr;
}

/// Adds a callback that acts after all others of the bones, in place of one of its class.
/// \return false where the skeleton has no bone
template <typename Callback>
bool addLast(Callback& callback, osgAnimation::Skeleton& skeleton) {
    const osg::ref_ptr<Callback> other = callbackOf<Callback>(skeleton);
    osgAnimation::Bone* last = nullptr; // of the topmost bones: all others are posed before it
    for (const auto& [name, bone] : bonesOf(skeleton)) {
        if (other) bone->removeUpdateCallback(other);
        if (bone->getBoneParent()) continue;
        if (!last || skeleton.getChildIndex(bone) > skeleton.getChildIndex(last)) last = bone;
    }
    if (!last) return false;
    // The first callback is the last to act, because each calls the next one before.
    callback.setNestedCallback(last->getUpdateCallback());
    last->setUpdateCallback(&callback);
    return true;
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
