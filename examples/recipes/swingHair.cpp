// SPDX-License-Identifier: MIT
#include <osgSkin/GlmOsg>
#include <osgSkinCharacter/LoadCharacter>
#include <osgSkinMotion/SpringBones>
#include <osgSkinRig/ReadSkeleton>

#include <osg/ShapeDrawable>
#include <osgAnimation/StackedMatrixElement>
#include <osgAnimation/UpdateBone>

/// A figure with a pony tail that swings: bones below the head, and springs for them.
osg::ref_ptr<osg::Node> swingHair(const std::string& file) {
    osgSkin::Character character = osgSkin::loadCharacter(file);
    osg::ref_ptr<osgAnimation::Bone> above = character.boneByRole("Head");
    const osg::Matrixd toRest = osg::Matrixd::inverse(character.toWorld);
    const osg::Vec3d step(0, 0.03, -0.05), root(0, 0.06, 0.13); // metres, Z up
    osg::Vec3d joint = character.restPosition("Head") + root;
    for (const char* name : {"hair1", "hair2", "hair3", "hair4", "hair5", "hair6", "hair7"}) {
        const osg::Matrixd place = osg::Matrixd::translate(joint) * toRest;
        const osg::ref_ptr<osgAnimation::UpdateBone> update = new osgAnimation::UpdateBone(name);
        update->getStackedTransforms().push_back(new osgAnimation::StackedMatrixElement(
            "matrix", place * osg::Matrixd(above->getInvBindMatrixInSkeletonSpace())));
        const osg::ref_ptr<osgAnimation::Bone> bone = new osgAnimation::Bone(name);
        bone->setUpdateCallback(update);
        bone->setInvBindMatrixInSkeletonSpace(osg::Matrixd::inverse(place));
        bone->addChild(new osg::ShapeDrawable(new osg::Sphere(step / 2, 0.045f)));
        above->insertChild(0, bone); // osgAnimation wants bones before other children
        above = bone;
        joint += step;
    }
    osgSkin::SpringSettings::Joint hair;
    hair.stiffness = 0.2;
    hair.gravity = {0.0, character.isZUp() ? 0.0 : -0.5, character.isZUp() ? -0.5 : 0.0};
    osgSkin::SpringSettings springs;
    springs.chains.push_back(
        osgSkin::springsBelow(osgSkin::readSkeleton(*character.skeleton), {"hair1"}, hair));
    osgSkin::attach<osgSkin::SpringBones>(*character.root, springs);
    return character.root;
}
