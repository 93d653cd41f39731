// SPDX-License-Identifier: MIT
#include <osgSkinRig/MakeSkeleton>

#include <osgSkin/GlmOsg>

#include <osgAnimation/Bone>
#include <osgAnimation/StackedQuaternionElement>
#include <osgAnimation/StackedTranslateElement>
#include <osgAnimation/UpdateBone>

#include <vector>

namespace osgSkin {

osg::ref_ptr<osgAnimation::Skeleton> makeSkeleton(const RestSkeleton& rig) {
    rig.validate();
    osg::ref_ptr<osgAnimation::Skeleton> skeleton = new osgAnimation::Skeleton;
    skeleton->setName("skeleton");
    skeleton->setDefaultUpdateCallback();

    std::vector<osgAnimation::Bone*> bones;
    for (const RestJoint& joint : rig.joints) {
        osg::ref_ptr<osgAnimation::Bone> bone = new osgAnimation::Bone(joint.name);
        const auto parent = static_cast<std::size_t>(joint.parent);
        const glm::dvec3 offset =
            joint.parent < 0 ? joint.centre : joint.centre - rig.joints[parent].centre;

        osg::ref_ptr<osgAnimation::UpdateBone> update = new osgAnimation::UpdateBone(joint.name);
        osgAnimation::StackedTransform& stack = update->getStackedTransforms();
        stack.push_back(new osgAnimation::StackedTranslateElement("translate", toOsg(offset)));
        stack.push_back(new osgAnimation::StackedQuaternionElement("quaternion", osg::Quat()));
        bone->setUpdateCallback(update);

        // The rest pose holds before the first update too.
        const osg::Matrixd toSkeleton = osg::Matrixd::translate(toOsg(joint.centre));
        bone->setMatrix(osg::Matrixd::translate(toOsg(offset)));
        bone->setMatrixInSkeletonSpace(toSkeleton);
        bone->setInvBindMatrixInSkeletonSpace(osg::Matrixd::inverse(toSkeleton));

        osg::Group* above = skeleton.get();
        if (joint.parent >= 0) above = bones[parent];
        above->addChild(bone);
        bones.push_back(bone);
    }
    return skeleton;
}

} // namespace osgSkin
