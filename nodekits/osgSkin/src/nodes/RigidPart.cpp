// SPDX-License-Identifier: MIT
#include <osgSkin/RigidPart>

namespace osgSkin {

RigidPart::RigidPart(osg::Drawable* drawable, osgAnimation::Bone& bone)
    : osg::MatrixTransform(bone.getInvBindMatrixInSkeletonSpace()) {
    setName(bone.getName());
    // STATIC would invite the Optimizer to bake the matrix into geometry that other skins share.
    setDataVariance(osg::Object::DYNAMIC);
    addChild(drawable);
    bone.addChild(this);
}

} // namespace osgSkin
