// SPDX-License-Identifier: MIT
#include "bones/HoldInCallback.h"

namespace osgSkin {
namespace {

constexpr double kSameScale = 1e-4;

/// False where there is another before it, or one that goes after it.
bool take(HoldingElements& found, osgAnimation::StackedTransformElement* element) {
    if (found.matrix) return false;
    const bool first = !found.translate && !found.rotate && !found.scale;
    if (auto* matrix = dynamic_cast<osgAnimation::StackedMatrixElement*>(element))
        return first && (found.matrix = matrix);
    if (auto* translate = dynamic_cast<osgAnimation::StackedTranslateElement*>(element))
        return first && (found.translate = translate);
    if (auto* rotate = dynamic_cast<osgAnimation::StackedQuaternionElement*>(element))
        return !found.rotate && !found.scale && (found.rotate = rotate);
    if (auto* scale = dynamic_cast<osgAnimation::StackedScaleElement*>(element))
        return !found.scale && (found.scale = scale);
    return false;
}

} // namespace

bool HoldingElements::find(osgAnimation::UpdateBone& update) {
    for (const auto& element : update.getStackedTransforms())
        if (!take(*this, element.get())) return false;
    return matrix || (translate && rotate);
}

osgAnimation::UpdateBone* updateOf(osgAnimation::Bone& bone) {
    for (osg::Callback* callback = bone.getUpdateCallback(); callback != nullptr;
         callback = callback->getNestedCallback())
        if (auto* update = dynamic_cast<osgAnimation::UpdateBone*>(callback)) return update;
    return nullptr;
}

bool isScaled(const osg::Vec3d& scale) {
    return (scale - osg::Vec3d(1.0, 1.0, 1.0)).length() > kSameScale;
}

bool holdInCallback(osgAnimation::Bone& bone, const osg::Matrixd& local) {
    osgAnimation::UpdateBone* update = updateOf(bone);
    if (!update) return true;
    HoldingElements held;
    if (!held.find(*update)) return false;
    if (held.matrix) {
        held.matrix->setMatrix(local);
        return true;
    }
    osg::Vec3d translation, scale;
    osg::Quat rotation, scaleAxes;
    local.decompose(translation, rotation, scale, scaleAxes);
    if (!held.scale && isScaled(scale)) return false;
    held.translate->setTranslate(translation);
    held.rotate->setQuaternion(rotation);
    if (held.scale) held.scale->setScale(scale);
    return true;
}

} // namespace osgSkin
