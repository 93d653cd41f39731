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

void RigidPart::place(const osg::Matrixd* toBone) {
    if (!toBone && !_isPlaced) return;
    _isPlaced = toBone != nullptr;
    if (toBone && !_placed) _placed = std::make_unique<osg::Matrixd>();
    if (toBone) *_placed = *toBone;
    dirtyBound();
}

bool RigidPart::computeLocalToWorldMatrix(osg::Matrix& matrix, osg::NodeVisitor* nv) const {
    if (!_isPlaced || _referenceFrame != RELATIVE_RF)
        return osg::MatrixTransform::computeLocalToWorldMatrix(matrix, nv);
    matrix.preMult(*_placed);
    return true;
}

bool RigidPart::computeWorldToLocalMatrix(osg::Matrix& matrix, osg::NodeVisitor* nv) const {
    if (!_isPlaced || _referenceFrame != RELATIVE_RF)
        return osg::MatrixTransform::computeWorldToLocalMatrix(matrix, nv);
    matrix.postMult(osg::Matrixd::inverse(*_placed));
    return true;
}

} // namespace osgSkin
