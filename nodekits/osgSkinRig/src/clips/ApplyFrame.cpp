// SPDX-License-Identifier: MIT
#include <osgSkinRig/ApplyFrame>

#include "clips/ClipCheck.h"

#include <osgSkin/BoneReader>
#include <osgSkin/Error>
#include <osgSkin/GlmOsg>

#include <osgAnimation/Bone>
#include <osgAnimation/StackedQuaternionElement>
#include <osgAnimation/StackedTranslateElement>
#include <osgAnimation/UpdateBone>

#include <vector>

namespace osgSkin {
namespace {

/// Keeps the pose in the bone's update callback too: an update traversal sets the bone from there.
void storeInCallback(osgAnimation::Bone& bone, const glm::dvec3& offset,
                     const glm::dquat& rotation) {
    auto* update = dynamic_cast<osgAnimation::UpdateBone*>(bone.getUpdateCallback());
    if (update == nullptr) return;
    for (osg::ref_ptr<osgAnimation::StackedTransformElement>& element :
         update->getStackedTransforms()) {
        if (auto* q = dynamic_cast<osgAnimation::StackedQuaternionElement*>(element.get()))
            q->setQuaternion(toOsg(rotation));
        else if (auto* t = dynamic_cast<osgAnimation::StackedTranslateElement*>(element.get()))
            t->setTranslate(toOsg(offset));
    }
}

} // namespace

void applyFrame(const Clip& clip, const RestSkeleton& rig, std::size_t frame,
                osgAnimation::Skeleton& skeleton) {
    requireFits(clip, rig);
    if (frame >= clip.frames)
        throw Error("clip \"" + clip.name + "\": no frame " + std::to_string(frame) +
                    ", expected less than " + std::to_string(clip.frames));
    const osgAnimation::BoneMap bones = bonesOf(skeleton);

    std::vector<osg::Matrixd> inSkeleton(rig.joints.size());
    for (std::size_t j = 0; j < rig.joints.size(); ++j) {
        const RestJoint& joint = rig.joints[j];
        const auto parent = static_cast<std::size_t>(joint.parent);
        const glm::dvec3 offset =
            joint.parent < 0 ? clip.rootPositions[frame] : joint.centre - rig.joints[parent].centre;
        const glm::dquat& rotation = clip.rotations[frame * clip.joints + j];
        const osg::Matrixd local =
            osg::Matrixd::rotate(toOsg(rotation)) * osg::Matrixd::translate(toOsg(offset));
        inSkeleton[j] = joint.parent < 0 ? local : local * inSkeleton[parent];

        const auto bone = bones.find(joint.name);
        if (bone == bones.end()) continue;
        bone->second->setMatrix(local);
        bone->second->setMatrixInSkeletonSpace(inSkeleton[j]);
        storeInCallback(*bone->second, offset, rotation);
    }
}

} // namespace osgSkin
