// SPDX-License-Identifier: MIT
#include <osgSkin/RigidPart>

#include "nodes/OtherFormats.h"

namespace osgSkin {

RigidPart::RigidPart(osg::Drawable* drawable, osgAnimation::Bone& bone)
    : osg::MatrixTransform(bone.getInvBindMatrixInSkeletonSpace()) {
    setName(bone.getName());
    // STATIC would invite the Optimizer to bake the matrix into geometry that other skins share.
    setDataVariance(osg::Object::DYNAMIC);
    addChild(drawable);
    bone.addChild(this);
}

void RigidPart::traverse(osg::NodeVisitor& nv) {
    if (!writesOtherFormat(nv)) {
        osg::MatrixTransform::traverse(nv);
        return;
    }
    for (unsigned int c = 0; c < getNumChildren(); ++c)
        if (const osg::Geometry* const geometry = getChild(c)->asGeometry())
            writeGeometry(*geometry, *geometry, nv);
        else
            getChild(c)->accept(nv);
}

} // namespace osgSkin
