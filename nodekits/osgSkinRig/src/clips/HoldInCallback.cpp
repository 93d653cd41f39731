// SPDX-License-Identifier: MIT
#include "clips/HoldInCallback.h"

#include <osgAnimation/StackedMatrixElement>
#include <osgAnimation/StackedQuaternionElement>
#include <osgAnimation/StackedScaleElement>
#include <osgAnimation/StackedTranslateElement>
#include <osgAnimation/UpdateBone>

namespace osgSkin {
namespace {

constexpr double kSameScale = 1e-4;

/// A stack's elements of the kinds that can hold any pose, in the order in which they are applied.
struct Elements {
    osgAnimation::StackedTranslateElement* translate = nullptr;
    osgAnimation::StackedQuaternionElement* rotate = nullptr;
    osgAnimation::StackedScaleElement* scale = nullptr;
    osgAnimation::StackedMatrixElement* matrix = nullptr;

    /// False where there is another before it, or one that goes after it.
    bool take(osgAnimation::StackedTransformElement* element) {
        if (matrix) return false;
        const bool first = !translate && !rotate && !scale;
        if (auto* m = dynamic_cast<osgAnimation::StackedMatrixElement*>(element))
            return first && (matrix = m);
        if (auto* t = dynamic_cast<osgAnimation::StackedTranslateElement*>(element))
            return first && (translate = t);
        if (auto* q = dynamic_cast<osgAnimation::StackedQuaternionElement*>(element))
            return !rotate && !scale && (rotate = q);
        if (auto* s = dynamic_cast<osgAnimation::StackedScaleElement*>(element))
            return !scale && (scale = s);
        return false;
    }
};

osgAnimation::UpdateBone* updateOf(osgAnimation::Bone& bone) {
    for (osg::Callback* callback = bone.getUpdateCallback(); callback != nullptr;
         callback = callback->getNestedCallback())
        if (auto* update = dynamic_cast<osgAnimation::UpdateBone*>(callback)) return update;
    return nullptr;
}

} // namespace

bool holdInCallback(osgAnimation::Bone& bone, const osg::Matrixd& local) {
    osgAnimation::UpdateBone* update = updateOf(bone);
    if (!update) return true;
    Elements found;
    for (const auto& element : update->getStackedTransforms())
        if (!found.take(element.get())) return false;
    if (found.matrix) {
        found.matrix->setMatrix(local);
        return true;
    }
    if (!found.translate || !found.rotate) return false;
    osg::Vec3d translation, scale;
    osg::Quat rotation, scaleAxes;
    local.decompose(translation, rotation, scale, scaleAxes);
    if (!found.scale && (scale - osg::Vec3d(1.0, 1.0, 1.0)).length() > kSameScale) return false;
    found.translate->setTranslate(translation);
    found.rotate->setQuaternion(rotation);
    if (found.scale) found.scale->setScale(scale);
    return true;
}

} // namespace osgSkin
